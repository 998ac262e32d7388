# Writes the tests of PROGRAM that FILTER lets through as CTest tests into LIST, up to `most` neighbours of a suite as one: they
# share a device and with it the pipelines that it keeps (support/gpu_fixture.h). A test is called AREA.SUITE, with .LABEL
# where the suite has tests of several labels, and .NUMBER where it has more.
set(most 16)
# CTest runs as many tests side by side as there are processors, so lavapipe's own threads would mostly wake each other: its
# work stays on the thread that asks for it. The command, and groups with a test of what may not depend on threads, keep them.
set(threaded "[Ss]ame(Bits|Hash|Picture)|TwiceTheSame")

# list_tests(PREFIX FILTER): the suites, and in PREFIX_SUITE the tests of each.
macro(list_tests prefix filter)
  execute_process(COMMAND ${PROGRAM} --gtest_list_tests "--gtest_filter=${filter}" OUTPUT_VARIABLE listed
    TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
  # What parameters look like may hold anything.
  string(REGEX REPLACE "[ ]*#[^\n]*" "" listed "${listed}")
  string(REPLACE "\n" ";" listed "${listed}")
  set(${prefix}_suites)
  foreach(line IN LISTS listed)
    if(line MATCHES "^  (.+)$")
      list(APPEND ${prefix}_${suite} "${suite}.${CMAKE_MATCH_1}")
    elseif(line MATCHES "^([^ ]+)\\.$")
      set(suite ${CMAKE_MATCH_1})
      list(APPEND ${prefix}_suites ${suite})
    endif()
  endforeach()
endmacro()
list_tests(all "*")
list_tests(chosen "${FILTER}")

set(content)
get_filename_component(folder ${LIST} DIRECTORY)
foreach(suite IN LISTS chosen_suites)
  list(LENGTH chosen_${suite} count)
  list(LENGTH all_${suite} of)
  set(first 0)
  set(number 1)
  while(first LESS count)
    list(SUBLIST chosen_${suite} ${first} ${most} group)
    list(JOIN group ":" filter)
    set(name ${AREA}.${suite})
    if(count LESS of)
      string(APPEND name .${LABEL})
    endif()
    if(count GREATER most)
      string(APPEND name .${number})
    endif()
    set(environment "ENVIRONMENT LP_NUM_THREADS=0")
    if(AREA STREQUAL app OR filter MATCHES "${threaded}")
      set(environment)
    endif()
    string(APPEND content "add_test([==[${name}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${filter}]==])\n"
      "set_tests_properties([==[${name}]==] PROPERTIES WORKING_DIRECTORY [==[${folder}]==] LABELS ${LABEL} TIMEOUT ${TIMEOUT} ${environment})\n")
    math(EXPR first "${first} + ${most}")
    math(EXPR number "${number} + 1")
  endwhile()
endforeach()
file(WRITE ${LIST} "${content}")
