# Installs into a folder that was not configured, links the example against it by CMake and by
# pkg-config, and runs both and the installed program with the data that were installed.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(said ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

set(example ${SOURCE}/tools/examples/link-library)
run(said ${CMAKE_COMMAND} -S ${example} -B ${WORK}/cmake -DCMAKE_PREFIX_PATH=${prefix})
run(said ${CMAKE_COMMAND} --build ${WORK}/cmake)
run(said ${WORK}/cmake/link-library)
# T = 4 n / (n + 1)^2 at n = 1.5; r as README has it.
expect("${said}" "T 0.960000, r 0.596346\nXYZ [0-9.]+ [0-9.]+ [0-9.]+")

file(GLOB_RECURSE description ${prefix}/*/reradiant.pc)
get_filename_component(folder ${description} DIRECTORY)
run(flags pkg-config --with-path=${folder} --cflags --libs reradiant)
separate_arguments(flags UNIX_COMMAND "${flags}")
get_filename_component(library ${folder} DIRECTORY)
run(said c++ ${example}/main.cpp -o ${WORK}/by-pkg-config ${flags} -Wl,-rpath,${library})
run(said ${WORK}/by-pkg-config)
expect("${said}" "T 0.960000, r 0.596346\n")

run(said ${CMAKE_COMMAND} -E env --unset=RERADIANT_DATA ${prefix}/bin/reradiant validate
    ${prefix}/share/reradiant/spectra/reradiation/synthetic-orange.csv)
expect("${said}" "valid")
