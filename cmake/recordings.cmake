# Libraries that read recordings: each is used if it is found. A format without its library is left out, and says so when
# it is met. They are linked by name, so that the installed package names no path of this machine.
set(PCL_FLOAM_RECORDING_LIBRARIES "")

# pcl_floam_add_recording_library(NAME library header what): defines PCL_FLOAM_WITH_NAME for the library's sources.
function(pcl_floam_add_recording_library name library header what)
  find_path(PCL_FLOAM_${name}_INCLUDE_DIR ${header})
  find_library(PCL_FLOAM_${name}_LIBRARY ${library})
  mark_as_advanced(PCL_FLOAM_${name}_INCLUDE_DIR PCL_FLOAM_${name}_LIBRARY)
  if(NOT PCL_FLOAM_${name}_INCLUDE_DIR OR NOT PCL_FLOAM_${name}_LIBRARY)
    message(STATUS "pcl_floam: lib${library} not found; ${what} are not read")
    return()
  endif()
  target_compile_definitions(pcl_floam_io PRIVATE PCL_FLOAM_WITH_${name})
  target_include_directories(pcl_floam_io SYSTEM PRIVATE ${PCL_FLOAM_${name}_INCLUDE_DIR})
  target_link_libraries(pcl_floam_io PRIVATE ${library})
  set(PCL_FLOAM_RECORDING_LIBRARIES ${PCL_FLOAM_RECORDING_LIBRARIES} ${library} PARENT_SCOPE)
endfunction()

pcl_floam_add_recording_library(LZ4 lz4 lz4frame.h "recordings compressed with lz4")
pcl_floam_add_recording_library(ZSTD zstd zstd.h "recordings compressed with zstd")
pcl_floam_add_recording_library(BZ2 bz2 bzlib.h "recordings compressed with bz2")
pcl_floam_add_recording_library(SQLITE sqlite3 sqlite3.h "rosbag2's .db3 files")
pcl_floam_add_recording_library(PCAP pcap pcap/pcap.h "captures of Velodyne packets")
pcl_floam_add_recording_library(XML tinyxml2 tinyxml2.h "an HDL-64's calibrations in XML")
pcl_floam_add_recording_library(YAML yaml-cpp yaml-cpp/yaml.h "an HDL-64's calibrations in YAML")
# For what is linked with the library when that is static.
set_property(TARGET pcl_floam_io PROPERTY PCL_FLOAM_RECORDING_LIBRARIES "${PCL_FLOAM_RECORDING_LIBRARIES}")
