# Warns when this project's flags give Eigen another alignment than PCL was built with. Also installed, for find_package.
#
# Classes of PCL that hold Eigen matrices are then laid out differently in PCL's libraries and in the code that includes
# its headers, and memory that one side allocates cannot be freed by the other: such programs crash. This library's own
# interface does not depend on it.

# Eigen's alignments, in bytes, when the compiler is given these flags; empty if they cannot be told.
function(pcl_floam_eigen_alignment flags result)
  string(MD5 key "${CMAKE_CXX_COMPILER} ${flags}")
  if(NOT DEFINED PCL_FLOAM_ALIGNMENT_${key})
    get_target_property(include_dirs Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
    list(TRANSFORM include_dirs PREPEND "-I")
    set(source ${CMAKE_BINARY_DIR}/CMakeFiles/pcl_floam_eigen_alignment.cpp)
    file(WRITE ${source}
      "#include <Eigen/Core>\npcl_floam_alignment EIGEN_MAX_STATIC_ALIGN_BYTES EIGEN_DEFAULT_ALIGN_BYTES\n")
    separate_arguments(arguments UNIX_COMMAND "${flags}")
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} ${arguments} ${include_dirs} -E -P ${source}
                    OUTPUT_VARIABLE preprocessed ERROR_QUIET)
    string(REGEX MATCH "pcl_floam_alignment ([0-9]+ [0-9]+)" found "${preprocessed}")
    set(PCL_FLOAM_ALIGNMENT_${key} "${CMAKE_MATCH_1}" CACHE INTERNAL "Eigen's alignment by compiler and flags")
  endif()
  set(${result} "${PCL_FLOAM_ALIGNMENT_${key}}" PARENT_SCOPE)
endfunction()

# What the project has asked for so far: variables, and the options and definitions of the directory that calls.
function(pcl_floam_user_flags result)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  get_directory_property(options COMPILE_OPTIONS)
  get_directory_property(definitions COMPILE_DEFINITIONS)
  list(TRANSFORM definitions PREPEND "-D")
  set(all ${options} ${definitions})
  list(FILTER all EXCLUDE REGEX "[$]<")  # generator expressions have no value yet
  list(JOIN all " " all)
  set(${result} "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${all}" PARENT_SCOPE)
endfunction()

function(pcl_floam_check_eigen_alignment)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    return()
  endif()
  # A PCL that was built with -march or -mavx says so, and gives its users the same flags.
  get_target_property(options pcl_common INTERFACE_COMPILE_OPTIONS)
  string(REGEX MATCHALL "-m[a-z0-9.=_-]+" pcl_flags "${options}")
  list(JOIN pcl_flags " " pcl_flags)
  pcl_floam_user_flags(user_flags)
  pcl_floam_eigen_alignment("${pcl_flags}" pcl_alignment)
  pcl_floam_eigen_alignment("${pcl_flags} ${user_flags}" user_alignment)
  if(pcl_alignment AND user_alignment AND NOT pcl_alignment STREQUAL user_alignment)
    string(REGEX REPLACE " .*" "" pcl_alignment ${pcl_alignment})
    string(REGEX REPLACE " .*" "" user_alignment ${user_alignment})
    string(STRIP "${user_flags}" user_flags)
    message(WARNING
      "pcl_floam: with this project's compile flags (${user_flags}) Eigen aligns to ${user_alignment} bytes, but PCL was "
      "built with ${pcl_alignment}. PCL's own classes then differ between its libraries and your code, and programs "
      "that use both crash. Leave -march and -mavx out, add -mno-avx, or build PCL with the same flags.")
  endif()
endfunction()
