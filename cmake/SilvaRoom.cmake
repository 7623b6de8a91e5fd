get_filename_component(SILVA_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

# silva_room(NAME SOURCES ... [DEPENDS ...] [LIBRARIES ...])
#
# A room is one folder, one static library and one namespace. DEPENDS are the rooms it may look down into (seen by its
# users too); LIBRARIES are foreign libraries, which stay inside: no header of the room includes them.
function(silva_room name)
  cmake_parse_arguments(room "" "" "SOURCES;DEPENDS;LIBRARIES" ${ARGN})
  add_library(${name} STATIC ${room_SOURCES})
  target_include_directories(${name} PUBLIC ${SILVA_ROOT})
  target_link_libraries(${name} PUBLIC ${room_DEPENDS} PRIVATE ${room_LIBRARIES})
endfunction()

# silva_test(NAME SOURCES ... DEPENDS ... [LABELS ...]): one GoogleTest program, one CTest entry a test case.
function(silva_test name)
  cmake_parse_arguments(test "" "TIMEOUT" "SOURCES;DEPENDS;LABELS" ${ARGN})
  if(NOT test_TIMEOUT)
    set(test_TIMEOUT 300)
  endif()
  add_executable(${name} ${test_SOURCES})
  target_include_directories(${name} PRIVATE ${SILVA_ROOT})
  target_link_libraries(${name} PRIVATE ${test_DEPENDS} GTest::gtest_main GTest::gmock)
  target_compile_definitions(${name} PRIVATE
    SILVA_SOURCE_DIR="${SILVA_ROOT}"
    SILVA_SHARED_DIR="${SILVA_ROOT}/../shared"
    SILVA_BINARY_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT ${test_TIMEOUT} LABELS "${test_LABELS}")
endfunction()
