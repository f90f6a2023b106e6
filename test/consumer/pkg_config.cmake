# Compiles and runs the consumer with what pkg-config says, no CMake.
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

file(GLOB_RECURSE found ${TREE}/*/pcl_floam.pc)
get_filename_component(folder ${found} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${folder})
run_step(${PKG_CONFIG} --cflags --libs pcl_floam)
separate_arguments(flags UNIX_COMMAND "${STEP_OUTPUT}")
file(MAKE_DIRECTORY ${BINARY})
run_step(${COMPILER} -std=c++17 -O1 ${SOURCE}/consumer.cpp -o ${BINARY}/consumer ${flags})
run_step(${BINARY}/consumer)
message("${STEP_OUTPUT}")
run_step(${PKG_CONFIG} --libs pcl_floam_io)
