# Install tree: headers, libraries, and the package files for find_package(pcl_floam).
include(CMakePackageConfigHelpers)

set(PCL_FLOAM_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/pcl_floam)

install(DIRECTORY include/pcl_floam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS pcl_floam EXPORT pcl_floamTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS pcl_floam_io EXPORT pcl_floamIoTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT pcl_floamTargets NAMESPACE pcl_floam:: DESTINATION ${PCL_FLOAM_PACKAGE_DIR})
install(EXPORT pcl_floamIoTargets NAMESPACE pcl_floam:: DESTINATION ${PCL_FLOAM_PACKAGE_DIR})

get_target_property(PCL_FLOAM_LIBRARY_TYPE pcl_floam TYPE)
configure_package_config_file(cmake/pcl_floamConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamConfig.cmake
                              INSTALL_DESTINATION ${PCL_FLOAM_PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/pcl_floamConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
configure_file(cmake/eigen_alignment.cmake ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamEigenAlignment.cmake COPYONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamConfigVersion.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamEigenAlignment.cmake
        DESTINATION ${PCL_FLOAM_PACKAGE_DIR})
include(cmake/pkg_config.cmake)

# The build tree is a package, too: find_package(pcl_floam) with pcl_floam_DIR set to it.
export(EXPORT pcl_floamTargets NAMESPACE pcl_floam:: FILE ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamTargets.cmake)
export(EXPORT pcl_floamIoTargets NAMESPACE pcl_floam:: FILE ${CMAKE_CURRENT_BINARY_DIR}/pcl_floamIoTargets.cmake)

if(PCL_FLOAM_TOP_LEVEL)
  include(cmake/debian_package.cmake)
endif()
