# The test shows that what pip installs, laid out as `pip install --target` does, works from where it
# lies: the program, found by PATH, and the module both take the data that came with them, not those of
# the source tree.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(said ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component python)
file(COPY ${BUILD}/python/reradiant DESTINATION ${prefix} PATTERN "_library*" EXCLUDE)
set(presets ${prefix}/share/reradiant/spectra/materials)
file(COPY_FILE ${presets}/latex.toml ${presets}/only-here.toml)

# The working folder holds another `reradiant`, the package.
run(said ${CMAKE_COMMAND} -E env --unset=RERADIANT_DATA PATH=${prefix}/bin:$ENV{PATH}
    ${CMAKE_COMMAND} -E chdir ${prefix} reradiant measure --preset only-here -o ${WORK}/measured.csv
    --theta-i 0 --theta-o 45)

set(presets_of_module "import reradiant\nprint(reradiant.__file__, *reradiant.presets())")
foreach(folder ${prefix} ${prefix}/lib/python3/site-packages) # of --target, of an environment
  if(NOT EXISTS ${folder}/reradiant)
    file(MAKE_DIRECTORY ${folder})
    file(RENAME ${prefix}/reradiant ${folder}/reradiant)
  endif()
  run(said ${CMAKE_COMMAND} -E env --unset=RERADIANT_DATA PYTHONPATH=${folder}
      ${PYTHON} -B -c "${presets_of_module}")
  expect("${said}" "^${folder}/reradiant/.* only-here")
endforeach()
