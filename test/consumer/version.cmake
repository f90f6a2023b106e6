# find_package takes this version for any with the same major and minor number that is not newer, and for no other.
#   VERSION  of the library
#   TREE     where it is installed
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

string(REPLACE "." ";" numbers ${VERSION})
list(GET numbers 0 major)
list(GET numbers 1 minor)
list(GET numbers 2 patch)
math(EXPR next_minor "${minor} + 1")
math(EXPR next_patch "${patch} + 1")

file(GLOB_RECURSE version_file ${TREE}/*/pcl_floamConfigVersion.cmake)
function(expect_compatible expected PACKAGE_FIND_VERSION)
  string(REPLACE "." ";" wanted ${PACKAGE_FIND_VERSION})
  list(GET wanted 0 PACKAGE_FIND_VERSION_MAJOR)
  list(GET wanted 1 PACKAGE_FIND_VERSION_MINOR)
  set(CMAKE_SIZEOF_VOID_P "")  # a script has no compiler to compare with
  include(${version_file})
  if(NOT PACKAGE_VERSION STREQUAL VERSION OR (expected AND NOT PACKAGE_VERSION_COMPATIBLE) OR
     (PACKAGE_VERSION_COMPATIBLE AND NOT expected))
    message(FATAL_ERROR "${PACKAGE_VERSION} for ${PACKAGE_FIND_VERSION}: \"${PACKAGE_VERSION_COMPATIBLE}\"")
  endif()
endfunction()

expect_compatible(YES ${VERSION})
expect_compatible(YES ${major}.${minor})
expect_compatible(NO ${major}.${minor}.${next_patch})
expect_compatible(NO ${major}.${next_minor})
