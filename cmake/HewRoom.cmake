# hew_room(<library> <room> HEADERS ... SOURCES ... ROOMS ... LIBRARIES ...)
#
# Makes one room: target <library>_<room> (alias <library>::<room>), sources and headers side by side in
# lib<library>/<library>/<room>/. ROOMS are other rooms, seen by whoever includes this room's headers;
# LIBRARIES are third parties, hidden in its .cpp files. SEEN_LIBRARIES are third parties that its headers
# may name (std, Eigen and tl::expected only; the include test enforces it).
function(hew_room library room)
  cmake_parse_arguments(ROOM "" "" "HEADERS;SOURCES;ROOMS;LIBRARIES;SEEN_LIBRARIES" ${ARGN})
  set(target ${library}_${room})
  set(kind PUBLIC)
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      # g++ 12 warns of std::string's own copies (GCC bug 105651).
      target_compile_options(${target} PRIVATE -Wno-restrict)
    endif()
    if(HEW_WERROR)
      target_compile_options(${target} PRIVATE -Werror)
    endif()
    target_link_libraries(${target} PRIVATE ${ROOM_LIBRARIES})
  else()
    set(kind INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  add_library(${library}::${room} ALIAS ${target})
  target_sources(${target} ${kind} FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}/lib${library}"
                 FILES ${ROOM_HEADERS})
  target_link_libraries(${target} ${kind} ${ROOM_ROOMS} ${ROOM_SEEN_LIBRARIES})
  target_compile_features(${target} ${kind} cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY HEW_ROOMS ${target})
endfunction()

set(HEW_TEST_PATIENCE 1 CACHE STRING "Factor on the time limits of tests, for slow builds")

# hew_room_test(<library> <room> SOURCES ... [ROOMS ...] [LIBRARIES ...] [LABEL unit])
#
# The test suite of a room, in tests/<label>/<library>/<room>/. HEW_MODELS reaches the tests through the environment.
function(hew_room_test library room)
  cmake_parse_arguments(SUITE "" "LABEL;TIMEOUT" "SOURCES;ROOMS;LIBRARIES" ${ARGN})
  if(NOT SUITE_LABEL)
    set(SUITE_LABEL unit)
  endif()
  if(NOT SUITE_TIMEOUT)
    set(SUITE_TIMEOUT 120)
  endif()
  math(EXPR SUITE_TIMEOUT "${SUITE_TIMEOUT} * ${HEW_TEST_PATIENCE}")
  set(target ${library}_${room}_${SUITE_LABEL}_test)
  add_executable(${target} ${SUITE_SOURCES})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -ffp-contract=off)
  target_compile_definitions(${target} PRIVATE HEW_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_link_libraries(${target} PRIVATE ${library}::${room} ${SUITE_ROOMS} ${SUITE_LIBRARIES} GTest::gtest_main)
  gtest_discover_tests(${target} TEST_PREFIX "${library}/${room}/" NO_PRETTY_VALUES DISCOVERY_MODE PRE_TEST
                       DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${SUITE_LABEL}" TIMEOUT ${SUITE_TIMEOUT})
endfunction()
