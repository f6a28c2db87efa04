# A room is a folder of host/ that is a library with an include root of its own: build/.../roots/ROOM holds the room's
# headers under the room's path and nothing else. `#include "plan/rule.hpp"` compiles only where room plan is among what
# a target needs. host/README.md is the map of the rooms.

# A link of an earlier configuration may lead to where this one wants a folder.
file(REMOVE_RECURSE ${CMAKE_BINARY_DIR}/roots)

# dolp_root(TARGET PATH NAME...) gives a target an include root in which each file or folder NAME of the calling folder
# is PATH/NAME; NAME "." is the calling folder itself.
function(dolp_root target path)
  string(REGEX REPLACE "^dolp_" "" name ${target})
  set(root ${CMAKE_BINARY_DIR}/roots/${name})
  foreach(name ${ARGN})
    cmake_path(SET link NORMALIZE ${root}/${path}/${name})
    cmake_path(SET source NORMALIZE ${CMAKE_CURRENT_SOURCE_DIR}/${name})
    string(REGEX REPLACE "/$" "" link ${link})
    string(REGEX REPLACE "/$" "" source ${source})
    cmake_path(GET link PARENT_PATH folder)
    file(MAKE_DIRECTORY ${folder})
    file(CREATE_LINK ${source} ${link} SYMBOLIC)
  endforeach()
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    target_include_directories(${target} INTERFACE ${root})
  else()
    target_include_directories(${target} PUBLIC ${root})
  endif()
endfunction()

# Room names and libraries as targets. A room may need only rooms that are there already, so that there are no circles.
function(dolp_targets result user)
  set(targets)
  foreach(name ${ARGN})
    string(REPLACE "/" "_" room dolp_${name})
    if(TARGET ${room})
      list(APPEND targets ${room})
    elseif(TARGET ${name} OR IS_ABSOLUTE ${name})
      list(APPEND targets ${name})
    else()
      message(FATAL_ERROR "${user} needs ${name}, which is no room below it")
    endif()
  endforeach()
  set(${result} ${targets} PARENT_SCOPE)
endfunction()

# dolp_needs(TARGET NAME...): rooms and libraries that a program or test uses.
function(dolp_needs target)
  dolp_targets(targets ${target} ${ARGN})
  target_link_libraries(${target} PRIVATE dolp_options ${targets})
endfunction()

# dolp_room(PATH SOURCES ... HEADERS_NEED ... NEEDS ...) makes the room in the calling folder. HEADERS_NEED: rooms and
# libraries that its headers include, which its users then see too; NEEDS: those of its sources alone.
function(dolp_room path)
  cmake_parse_arguments(PARSE_ARGV 1 room "" "" "SOURCES;HEADERS_NEED;NEEDS")
  string(REPLACE "/" "_" target dolp_${path})
  dolp_targets(public ${path} ${room_HEADERS_NEED})
  dolp_targets(private ${path} ${room_NEEDS})
  if(room_SOURCES)
    add_library(${target} STATIC ${room_SOURCES})
    target_link_libraries(${target} PUBLIC ${public} PRIVATE dolp_options ${private})
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE ${public})
  endif()
  # A folder with a room in it gives its own headers one by one.
  file(GLOB inner_rooms ${CMAKE_CURRENT_SOURCE_DIR}/*/CMakeLists.txt)
  set(shown .)
  if(inner_rooms)
    file(GLOB shown RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp)
  endif()
  dolp_root(${target} ${path} ${shown})
endfunction()
