# Target doc: the API documentation in <build>/doc/html, where Doxygen is found.
find_package(Doxygen QUIET OPTIONAL_COMPONENTS dot)
if(NOT DOXYGEN_FOUND)
  message(STATUS "pcl_floam: Doxygen not found; there is no target doc")
  return()
endif()

set(DOXYGEN_OUTPUT_DIRECTORY doc)
set(DOXYGEN_PROJECT_BRIEF "Lidar odometry, mapping and registration for PCL")
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
set(DOXYGEN_STRIP_FROM_INC_PATH ${PROJECT_SOURCE_DIR}/include)
set(DOXYGEN_EXCLUDE_PATTERNS */impl/*)
set(DOXYGEN_EXAMPLE_PATH ${PROJECT_SOURCE_DIR}/examples)
set(DOXYGEN_EXAMPLE_PATTERNS *.cpp)
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_SORT_MEMBER_DOCS NO)
set(DOXYGEN_GENERATE_TREEVIEW YES)
if(DOXYGEN_DOT_FOUND)
  set(DOXYGEN_ENABLED_SECTIONS dot)
endif()
set(DOXYGEN_QUIET YES)
# What a docstring says must be right; a member or parameter whose name says all needs none.
set(DOXYGEN_WARN_IF_UNDOCUMENTED NO)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)
# The registration of a point type is PCL's macro, not a function of ours.
set(DOXYGEN_ENABLE_PREPROCESSING YES)
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_PREDEFINED "POINT_CLOUD_REGISTER_POINT_STRUCT(...)=" EIGEN_ALIGN16= PCL_ADD_POINT4D= PCL_MAKE_ALIGNED_OPERATOR_NEW=)
if(PCL_FLOAM_WARNINGS_AS_ERRORS)
  set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
endif()

doxygen_add_docs(doc include/pcl_floam cmake/main_page.dox cmake/doc/tuning.md cmake/doc/adding_a_sensor.md
                 cmake/doc/adding_a_residual.md WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                 COMMENT "API documentation in doc/html")
