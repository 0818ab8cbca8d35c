# Installs into a folder that was not configured, links the example against it by CMake and by
# pkg-config, and runs both and the installed program with the data that were installed.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(prefix ${WORK}/prefix)
run(said ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})

link_example(${prefix} ${WORK})

run(said ${CMAKE_COMMAND} -E env --unset=RERADIANT_DATA ${prefix}/bin/reradiant validate
    ${prefix}/share/reradiant/spectra/reradiation/synthetic-orange.csv)
expect("${said}" "valid")
