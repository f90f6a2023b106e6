# The user is warned of flags that change Eigen's alignment, and of no others.
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

function(expect_warning expected flags)
  run_step(${CONFIGURE} -S ${SOURCE} -B ${BINARY} -DCMAKE_PREFIX_PATH=${TREE} -DCMAKE_CXX_FLAGS=${flags})
  string(REGEX MATCH "Eigen[ \n]+aligns" warned "${STEP_OUTPUT}")
  if((expected AND NOT warned) OR (warned AND NOT expected))
    message(FATAL_ERROR "with \"${flags}\": ${STEP_OUTPUT}")
  endif()
endfunction()

expect_warning(NO "-O2 -Wall -g")
run_step(${COMPILER} -dumpmachine)
if(STEP_OUTPUT MATCHES "x86_64")
  expect_warning(YES "-mavx2")
  expect_warning(YES "-march=skylake-avx512")
  # Eigen's objects would have PCL's layout again, but memory would still be freed in another way than it was allocated.
  expect_warning(YES "-mavx2 -DEIGEN_MAX_ALIGN_BYTES=16")
  expect_warning(NO "-march=skylake-avx512 -mno-avx")
  expect_warning(NO "-msse4.2")
endif()
