# The README's own project, of its CMake block and its two C++ blocks: configured, built and run.
#   README  the file
#   BINARY  folder of the project and of its build
#   OPTIONS of CMake, with | between them
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

file(READ ${README} text)
function(take_block language result)
  if(NOT text MATCHES "```${language}\n([^`]*)```")
    message(FATAL_ERROR "${README}: a block ```${language} is missing")
  endif()
  set(${result} "${CMAKE_MATCH_1}" PARENT_SCOPE)
  string(REPLACE "${CMAKE_MATCH_0}" "" text "${text}")
  set(text "${text}" PARENT_SCOPE)
endfunction()
take_block(cmake project)
take_block(cpp program)
take_block(cpp fragment)
if(text MATCHES "```(cmake|cpp)")
  message(FATAL_ERROR "${README}: a block that is not tried")
endif()

# The fragment is given what it names.
string(REGEX MATCH "#include [^\n]*\n" include "${fragment}")
string(REPLACE "${include}" "" fragment "${fragment}")
set(parameters "pcl::PointCloud<pcl::PointXYZI>::Ptr scan, pcl::PointCloud<pcl::PointXYZI>::Ptr target,
          pcl::PointCloud<pcl::PointXYZI>& aligned, const Eigen::Matrix4f& guess")
file(WRITE ${BINARY}/source/CMakeLists.txt "${project}")
file(WRITE ${BINARY}/source/my_robot.cpp "${program}\n${include}\nvoid swapIcp(${parameters})\n{\n${fragment}}\n")

string(REPLACE "|" ";" OPTIONS "${OPTIONS}")
run_step(${CONFIGURE} -S ${BINARY}/source -B ${BINARY} ${OPTIONS})
run_step(${CMAKE_COMMAND} --build ${BINARY})
run_step(${BINARY}/my_robot)
