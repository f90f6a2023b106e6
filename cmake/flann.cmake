# FLANN as Debian ships it: the library, and lz4, which FLANN's headers call when they are compiled.
find_path(PCL_FLOAM_FLANN_INCLUDE_DIR flann/flann.hpp REQUIRED)
find_library(PCL_FLOAM_LZ4_LIBRARY lz4 REQUIRED)
add_library(pcl_floam_flann INTERFACE)
target_include_directories(pcl_floam_flann SYSTEM INTERFACE ${PCL_FLOAM_FLANN_INCLUDE_DIR})
target_link_libraries(pcl_floam_flann INTERFACE ${PCL_FLOAM_LZ4_LIBRARY})
