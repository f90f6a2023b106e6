# pkg-config files, for builds without CMake.
file(RELATIVE_PATH PCL_FLOAM_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
# Removes the slash that RELATIVE_PATH leaves at the end.
string(REGEX REPLACE "/$" "" PCL_FLOAM_PC_PREFIX "${PCL_FLOAM_PC_PREFIX}")

# What a static library was built with has to be named by whoever links it.
set(PCL_FLOAM_PC_LIBRARIES "")
set(PCL_FLOAM_PC_IO_LIBRARIES "")
if(PCL_FLOAM_LIBRARY_TYPE STREQUAL "STATIC_LIBRARY")
  set(PCL_FLOAM_PC_LIBRARIES " -lceres -lglog ${OpenMP_CXX_FLAGS}")
  get_target_property(libraries pcl_floam_io PCL_FLOAM_RECORDING_LIBRARIES)
  list(TRANSFORM libraries PREPEND " -l")
  list(JOIN libraries "" PCL_FLOAM_PC_IO_LIBRARIES)
endif()

foreach(module pcl_floam pcl_floam_io)
  configure_file(cmake/${module}.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${module}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${module}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
