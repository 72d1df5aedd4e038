# cupola_room(NAME SOURCES file... [LINKS target...] [PRIVATE_LINKS target...])
# A room's library. NAME is its folder with underscores: renderer/plan -> renderer_plan.
function(cupola_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(${name} STATIC ${ROOM_SOURCES})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${ROOM_LINKS} PRIVATE ${ROOM_PRIVATE_LINKS})
endfunction()

# cupola_test(NAME SOURCES file... LINKS target... [SLOW] [TIMEOUT seconds])
# A doctest program and its CTest entry. SLOW ones carry the label "slow": `./dev test --fast` leaves them out.
function(cupola_test name)
  cmake_parse_arguments(TEST "SLOW" "TIMEOUT" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE ${TEST_LINKS} tests_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_compile_definitions(${name} PRIVATE CUPOLA_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                             CUPOLA_BINARY_DIR="${PROJECT_BINARY_DIR}")
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT})
  if(TEST_SLOW)
    set_tests_properties(${name} PROPERTIES LABELS slow)
  endif()
endfunction()

# cupola_script_test(NAME SCRIPT file [ARGUMENTS word...] [SLOW] [TIMEOUT seconds] [ALONE])
# A test run by python3 (.py) or node (.mjs). Exit status 77 skips it whole; a line "SKIP NAME: REASON" says why, and
# also reports a single case as skipped. What else tests/support/tally.py counts stands in its header. ALONE: no
# other test runs meanwhile.
function(cupola_script_test name)
  cmake_parse_arguments(TEST "SLOW;ALONE" "SCRIPT;TIMEOUT" "ARGUMENTS" ${ARGN})
  if(TEST_SCRIPT MATCHES "\\.mjs$")
    set(interpreter node)
  else()
    set(interpreter python3)
  endif()
  add_test(NAME ${name}
    COMMAND env PYTHONDONTWRITEBYTECODE=1 ${interpreter} ${CMAKE_CURRENT_SOURCE_DIR}/${TEST_SCRIPT} ${TEST_ARGUMENTS}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${TEST_TIMEOUT} SKIP_RETURN_CODE 77)
  if(TEST_SLOW)
    set_tests_properties(${name} PROPERTIES LABELS slow)
  endif()
  if(TEST_ALONE)
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif()
endfunction()
