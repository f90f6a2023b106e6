# Runs a command and ends the script with its output if it fails; the output is left in STEP_OUTPUT.
function(run_step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(failed)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${output}${errors}\nFailed (${failed}): ${command}")
  endif()
  set(STEP_OUTPUT "${output}${errors}" PARENT_SCOPE)
endfunction()

# A launcher in the environment (ccache) reaches CMake by itself. Another generator does not matter to what is tested.
set(CONFIGURE ${CMAKE_COMMAND} -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
