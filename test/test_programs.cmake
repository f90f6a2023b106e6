# How test programs are built and their tests listed.

# What most tests include of others, compiled once. None of our own headers: a compiler cache that overlooks a changed
# comment would give them precompiled as they were, and the compiler would not know them again.
add_library(pcl_floam_test_headers OBJECT support/test_headers.cpp)
target_precompile_headers(pcl_floam_test_headers PRIVATE
  <gtest/gtest.h> <pcl/registration/registration.h>)

# What every test program is compiled with.
function(pcl_floam_set_up_test name)
  target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name} PRIVATE
    pcl_floam::pcl_floam pcl_floam::io pcl_io pcl_floam_build_flags GTest::gtest OpenMP::OpenMP_CXX)
  # PCL's registrations, which tests compare with, compile in half the time; the library keeps its own flags.
  target_compile_options(${name} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:-O1>)
  # Headers precompiled for a library, which this would tell from programs, could not be used for these.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
endfunction()
pcl_floam_set_up_test(pcl_floam_test_headers)

# A test program of the library.
function(pcl_floam_add_test_program name)
  add_executable(${name} ${ARGN})
  pcl_floam_set_up_test(${name})
  target_link_libraries(${name} PRIVATE GTest::gtest_main)
  if(NOT name MATCHES "own_point_types|other_alignment|test_filters")  # with PCL_NO_PRECOMPILE or flags of their own
    target_precompile_headers(${name} REUSE_FROM pcl_floam_test_headers)
  endif()
endfunction()

# Its tests, by names that begin with a prefix, with some variables in their environment.
function(pcl_floam_list_tests name prefix)
  # Listed when CTest runs, not when linking: a sanitizer's options are not known to the build.
  set(list ${name}_${prefix}list)
  gtest_discover_tests(${name} TEST_PREFIX "${prefix}" TEST_LIST ${list} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60)
  # Among its PROPERTIES, of several variables the first would be set and the others lost.
  # Idle threads give way: tests run side by side, some with more threads than there are cores.
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${list}.cmake)
  file(WRITE ${file} "if(${list})
  set_tests_properties(\${${list}} PROPERTIES ENVIRONMENT \"OMP_WAIT_POLICY=passive;${ARGN}\")
endif()
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file})
endfunction()

# One test program of the library and its tests: pcl_floam_add_test(name source...).
function(pcl_floam_add_test name)
  pcl_floam_add_test_program(${name} ${ARGN})
  pcl_floam_list_tests(${name} "")
endfunction()

# Long tests, and programs that are no tests, are built by the target `long_tests` and run by `ctest -C Long -L long`.
add_custom_target(long_tests)

# pcl_floam_set_long(test...): of tests that were added with CONFIGURATIONS Long.
function(pcl_floam_set_long)
  set_tests_properties(${ARGN} PROPERTIES LABELS long TIMEOUT 1500 ENVIRONMENT OMP_WAIT_POLICY=passive)
endfunction()

# The same of a program of tests that take minutes to run or to compile.
function(pcl_floam_add_long_test name)
  pcl_floam_add_test_program(${name} ${ARGN})
  set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  add_dependencies(long_tests ${name})
  add_test(NAME long.${name} COMMAND ${name} CONFIGURATIONS Long)
  pcl_floam_set_long(long.${name})
endfunction()

# A program's tests once more with all objects far from the origin, where another frame than the right one makes a
# difference.
set(far_off PCL_FLOAM_TEST_FAR_OFF=1)
function(pcl_floam_run_far_off name)
  # GCC 12 takes what PCL's SVD does with Eigen's products for a use after free.
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-use-after-free>)
  get_target_property(is_long ${name} EXCLUDE_FROM_ALL)
  if(is_long)
    add_test(NAME long.far_off.${name} COMMAND ${name} CONFIGURATIONS Long)
    pcl_floam_set_long(long.far_off.${name})
    set_tests_properties(long.far_off.${name} PROPERTIES ENVIRONMENT "OMP_WAIT_POLICY=passive;${far_off}")
  else()
    pcl_floam_list_tests(${name} far_off. ${far_off})
  endif()
endfunction()
