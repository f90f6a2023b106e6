# Options of this build. Nothing here reaches a project that uses the library.
if(CMAKE_SOURCE_DIR STREQUAL CMAKE_CURRENT_SOURCE_DIR)
  set(PCL_FLOAM_TOP_LEVEL ON)
else()
  set(PCL_FLOAM_TOP_LEVEL OFF)
endif()

option(PCL_FLOAM_BUILD_EXAMPLES "Build the examples, the tools and the simulator" ${PCL_FLOAM_TOP_LEVEL})
option(PCL_FLOAM_BUILD_TESTS "Build the tests" ${PCL_FLOAM_TOP_LEVEL})
option(PCL_FLOAM_INSTALL "Create the install target" ${PCL_FLOAM_TOP_LEVEL})
option(PCL_FLOAM_WARNINGS_AS_ERRORS "Treat warnings of this project's own code as errors" OFF)
set(PCL_FLOAM_SANITIZER "" CACHE STRING "Sanitizers for this project's own targets, e.g. address,undefined or thread")
option(PCL_FLOAM_FUZZ "Build the fuzzers (clang only), with the address and undefined-behaviour sanitizers" OFF)
set(PCL_FLOAM_FUZZ_SECONDS 300 CACHE STRING "How long ctest -L fuzz runs each fuzzer")
if(PCL_FLOAM_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "PCL_FLOAM_FUZZ needs clang's libFuzzer: -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++")
  endif()
  # Numbers from files are cast to integers in places: a cast that is out of range counts as a fault, too.
  set(PCL_FLOAM_SANITIZER "address,undefined,float-cast-overflow,fuzzer-no-link")
endif()

# With -DCMAKE_UNITY_BUILD=ON everything is compiled in a third of the time; most targets then are one or two files.
if(NOT DEFINED CMAKE_UNITY_BUILD_BATCH_SIZE)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 14)
endif()

# With no build type at all an odometry is ten times too slow: say so, but leave the choice to the user.
if(PCL_FLOAM_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  message(STATUS "pcl_floam: no CMAKE_BUILD_TYPE given; -DCMAKE_BUILD_TYPE=Release makes it about ten times faster")
endif()

# Flags of this project's own targets; linked PRIVATE, never installed.
add_library(pcl_floam_build_flags INTERFACE)
target_compile_options(pcl_floam_build_flags INTERFACE
  # Multiplications fused into additions, as by GCC on arm64, would round what is worked out in two places differently:
  # a squared distance, and the limit that it is compared with.
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-ffp-contract=off>
  $<$<CXX_COMPILER_ID:GNU,Clang,AppleClang>:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-qual>
  # GCC 12 takes Eigen's partial vector loads, inlined from PCL's headers, for overruns.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>
  $<$<AND:$<BOOL:${PCL_FLOAM_WARNINGS_AS_ERRORS}>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:-Werror>)
if(PCL_FLOAM_SANITIZER)
  target_compile_options(pcl_floam_build_flags INTERFACE -fsanitize=${PCL_FLOAM_SANITIZER} -fno-omit-frame-pointer)
  target_link_options(pcl_floam_build_flags INTERFACE -fsanitize=${PCL_FLOAM_SANITIZER})
  # Under the address sanitizer Eigen pads each allocation by itself, PCL's own libraries were built without it, and
  # what one allocates the other frees.
  target_compile_definitions(pcl_floam_build_flags INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
if(PCL_FLOAM_FUZZ)
  target_compile_options(pcl_floam_build_flags INTERFACE -fno-sanitize-recover=all)
endif()

# For libraries: the same flags without linking to the target, which an exported library must not mention.
function(pcl_floam_use_build_flags target)
  target_compile_options(${target} PRIVATE $<TARGET_PROPERTY:pcl_floam_build_flags,INTERFACE_COMPILE_OPTIONS>)
  target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:pcl_floam_build_flags,INTERFACE_COMPILE_DEFINITIONS>)
  target_link_options(${target} PRIVATE $<TARGET_PROPERTY:pcl_floam_build_flags,INTERFACE_LINK_OPTIONS>)
endfunction()
