# FLANN as Debian ships it, and lz4, which FLANN's headers call when they are compiled.
find_path(PCL_FLOAM_FLANN_INCLUDE_DIR flann/flann.hpp REQUIRED)
find_library(PCL_FLOAM_LZ4_LIBRARY lz4 REQUIRED)
