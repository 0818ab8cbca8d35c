# run(OUTPUT_VARIABLE COMMAND...): fails the test with all that the command said when it fails.
function(run output)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE said ERROR_VARIABLE complained RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "${command}: ${code}\n${said}${complained}")
  endif()
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

# expect(TEXT PATTERN)
function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "expected '${pattern}' in:\n${text}")
  endif()
endfunction()

# link_example(PREFIX FOLDER): builds and runs the example against what lies under PREFIX, by CMake and
# by pkg-config; works in FOLDER.
function(link_example prefix folder)
  set(example ${SOURCE}/tools/examples/link-library)
  # T = 4 n / (n + 1)^2 at n = 1.5; r is known in closed form.
  set(expected "T 0.960000, r 0.596346\nXYZ [0-9.]+ [0-9.]+ [0-9.]+")
  run(said ${CMAKE_COMMAND} -G Ninja -S ${example} -B ${folder}/cmake -DCMAKE_PREFIX_PATH=${prefix})
  run(said ${CMAKE_COMMAND} --build ${folder}/cmake)
  run(said ${folder}/cmake/link-library)
  expect("${said}" "${expected}")

  file(GLOB_RECURSE description ${prefix}/*/reradiant.pc)
  get_filename_component(description_folder ${description} DIRECTORY)
  run(flags pkg-config --with-path=${description_folder} --cflags --libs reradiant)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  get_filename_component(library ${description_folder} DIRECTORY)
  run(said c++ ${example}/main.cpp -o ${folder}/by-pkg-config ${flags} -Wl,-rpath,${library})
  run(said ${folder}/by-pkg-config)
  expect("${said}" "${expected}")
endfunction()
