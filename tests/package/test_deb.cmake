# The Debian package holds program, library, headers and data, and names what it depends on; the example
# links against what it unpacks to, by CMake and by pkg-config.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
run(said cpack --config ${BUILD}/CPackConfig.cmake -B ${WORK})
file(GLOB package ${WORK}/*.deb)
run(fields dpkg-deb --field ${package})
expect("${fields}" "Package: reradiant\n")
expect("${fields}" "Depends: [^\n]*opencl-icd")
run(files dpkg-deb --contents ${package})
foreach(file /usr/bin/reradiant libreradiant.so. /usr/include/reradiant/error.h
             /reradiantConfig.cmake /reradiant.pc /usr/share/reradiant/kernels/gather.cl
             /usr/share/reradiant/spectra/illuminants/D65.csv)
  expect("${files}" "${file}")
endforeach()
if(files MATCHES "/debian/|_library|include/[^\n]*(host|kernels)/")
  message(FATAL_ERROR "the package holds what it should not:\n${files}")
endif()

run(said dpkg-deb --extract ${package} ${WORK}/root)
link_example(${WORK}/root/usr ${WORK})
