# Makes the Debian package and unpacks it as dpkg would, but into a folder.
#   BUILD     build folder
#   PACKAGES  where the package goes
#   TREE      the root that it is unpacked into
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

file(REMOVE_RECURSE ${PACKAGES} ${TREE})
get_filename_component(programs ${CMAKE_COMMAND} DIRECTORY)
run_step(${programs}/cpack --config ${BUILD}/CPackConfig.cmake -G DEB -B ${PACKAGES})
file(GLOB package ${PACKAGES}/libpcl-floam-dev_*.deb)
run_step(dpkg-deb --extract ${package} ${TREE})
run_step(dpkg-deb --field ${package} Depends)
message("Depends: ${STEP_OUTPUT}")
foreach(needed IN ITEMS libpcl-dev libeigen3-dev libceres-dev libpcl-common libc6)
  if(NOT STEP_OUTPUT MATCHES ${needed})
    message(FATAL_ERROR "the package does not depend on ${needed}")
  endif()
endforeach()
