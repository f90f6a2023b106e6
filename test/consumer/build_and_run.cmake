# Configures, builds and runs a user's project, and looks at the flags that it was compiled with.
#   SOURCE, BINARY  the project and its build folder
#   OPTIONS         of CMake, with | between them
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

string(REPLACE "|" ";" OPTIONS "${OPTIONS}")
run_step(${CONFIGURE} -S ${SOURCE} -B ${BINARY} ${OPTIONS})
run_step(${CMAKE_COMMAND} --build ${BINARY} --parallel 2)
run_step(${BINARY}/consumer)
message("${STEP_OUTPUT}")

# Nothing may be added to the user's flags but places of headers, the C++ standard, and what PCL's own targets bring
# along, by way of Boost, VTK and Qt.
list(FILTER OPTIONS INCLUDE REGEX "^-DCMAKE_CXX_FLAGS=")
string(REPLACE "-DCMAKE_CXX_FLAGS=" "" own_flags "${OPTIONS}")
separate_arguments(own_flags UNIX_COMMAND "${own_flags}")
file(STRINGS ${BINARY}/compile_commands.json command REGEX "\"command\": .* -c [^ ]*consumer[.]cpp")
if(NOT command MATCHES "\"command\": \"(.*)\"")
  message(FATAL_ERROR "no command compiles consumer.cpp")
endif()
separate_arguments(arguments UNIX_COMMAND "${CMAKE_MATCH_1}")
list(FILTER arguments INCLUDE REGEX "^-")
list(FILTER arguments EXCLUDE REGEX "^-(I.*|isystem|o|c|std=.*|O3|DNDEBUG|g)$")
list(FILTER arguments EXCLUDE REGEX "^-(D(BOOST|QT|TBB)_.*|Dkiss_fft_scalar=double|fPIC)$")
if(own_flags)
  list(REMOVE_ITEM arguments ${own_flags})
endif()
if(arguments)
  message(FATAL_ERROR "flags that the user did not ask for: ${arguments}")
endif()
