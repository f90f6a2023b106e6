# Installs a build and moves the tree, so that nothing in it may depend on where it was.
#   BUILD  build folder
#   TREE   where the installed tree ends up
include(${CMAKE_CURRENT_LIST_DIR}/run_step.cmake)

get_filename_component(parent ${TREE} DIRECTORY)
get_filename_component(name ${TREE} NAME)
file(REMOVE_RECURSE ${TREE} ${parent}/first_place/${name})
run_step(${CMAKE_COMMAND} --install ${BUILD} --prefix ${parent}/first_place/${name})
file(RENAME ${parent}/first_place/${name} ${TREE})

file(GLOB_RECURSE texts ${TREE}/*.cmake ${TREE}/*.pc)
foreach(text IN LISTS texts)
  file(READ ${text} content)
  foreach(place IN ITEMS ${BUILD} first_place)
    string(FIND "${content}" ${place} position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${text} names ${place}, where it cannot stay")
    endif()
  endforeach()
endforeach()

# Shared libraries find each other where they are now.
file(GLOB_RECURSE libraries ${TREE}/*.so)
foreach(library IN LISTS libraries)
  run_step(ldd ${library})
  if(STEP_OUTPUT MATCHES "[^\n]*not found")
    message(FATAL_ERROR "${library}: ${CMAKE_MATCH_0}")
  endif()
endforeach()
