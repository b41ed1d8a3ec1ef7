# Functions that declare every target of the project, so that language level, warnings and sanitizers are the same everywhere.

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

add_library(crane_build_flags INTERFACE)
target_compile_features(crane_build_flags INTERFACE cxx_std_20)
target_compile_options(crane_build_flags INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 reports both for the standard library at -O2 and above (bugs 105329 and 105562).
  target_compile_options(crane_build_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict -Wno-maybe-uninitialized>)
endif()

if(CRANE_SANITIZE)
  add_compile_options(-fsanitize=${CRANE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  if(CRANE_SANITIZE MATCHES undefined)
    # The address sanitizer detects the same errors; these checks double the compile time.
    add_compile_options(-fno-sanitize=null,alignment,vptr)
  endif()
  add_link_options(-fsanitize=${CRANE_SANITIZE})
endif()

# crane_library(NAME [SOURCES ...] [LINK ...] [PRIVATE_LINK ...])
#   Library target crane_NAME with alias crane::NAME and public headers in include/.
#   LINK is public, PRIVATE_LINK stays inside. The target libraries builds all of them.
add_custom_target(libraries)
function(crane_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  if(ARG_SOURCES)
    add_library(crane_${name} STATIC ${ARG_SOURCES})
    target_include_directories(crane_${name} PUBLIC include PRIVATE src)
    target_link_libraries(crane_${name} PUBLIC ${ARG_LINK} PRIVATE crane_build_flags ${ARG_PRIVATE_LINK})
    target_compile_features(crane_${name} PUBLIC cxx_std_20)
    add_dependencies(libraries crane_${name})
  else()
    add_library(crane_${name} INTERFACE)
    target_include_directories(crane_${name} INTERFACE include)
    target_link_libraries(crane_${name} INTERFACE ${ARG_LINK})
    target_compile_features(crane_${name} INTERFACE cxx_std_20)
  endif()
  add_library(crane::${name} ALIAS crane_${name})
  set_property(GLOBAL APPEND PROPERTY CRANE_LIBRARIES crane_${name})  # for tests/structure
endfunction()

# crane_executable(NAME SOURCES ... LINK ...): program NAME in bin/.
function(crane_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE crane_build_flags ${ARG_LINK})
endfunction()

# crane_test(NAME SOURCES ... LINK ... [LABELS ...] [TIMEOUT seconds] [SERIAL [QUIET | ALONE] | LOOP])
# GoogleTest program; each TEST becomes one CTest test. SERIAL: the tests of this program run one after the other (real time, real
# DDS), beside tests of other programs, each of which has DDS domains of its own. The program with the longest TIMEOUT begins first,
# because its tests form the longest chain. QUIET (label "quiet"): nothing computes at the same time, and at most one other program
# runs. Tests are QUIET when they require that the loop loses no tick or judge reactions to the millisecond. ALONE (label "alone"): no
# other test runs at the same time, because a flood occupies the real-time scheduling of all stacks, or because a handshake of DDS
# Security must end in time. SERIAL tests have the main() of tests/real_time: a failure is final unless a bare timer proves that the
# computer paused. All other programs carry the label "unit", unless LABELS are given, and are built by the target unit_tests. LOOP:
# tests of code that runs while a crane moves; they carry the label "unit-loop" (CTest discovers tests with one label only) and are
# built by loop_tests, too. TIMEOUT ends a test that hangs; it limits no computation, because tests that compute get only the time
# that the stacks leave (deploy/test).
add_custom_target(unit_tests)
add_custom_target(loop_tests)
function(crane_test name)
  cmake_parse_arguments(ARG "SERIAL;QUIET;ALONE;LOOP" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 60)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  set(main GTest::gtest_main)
  if(ARG_SERIAL)
    set(main crane_real_time_main)
  endif()
  target_link_libraries(${name} PRIVATE crane_build_flags ${ARG_LINK} ${main} GTest::gmock GTest::gtest)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)  # more optimisation costs more time than it saves
  target_precompile_headers(${name} REUSE_FROM crane_test_headers)
  # ccache requires -fpch-preprocess. GCC 12 reports false overflows for a precompiled <string>.
  target_compile_options(${name} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess -Wno-array-bounds -Wno-stringop-overflow>)
  if(ARG_SERIAL)
    set(properties RESOURCE_LOCK ${name} COST ${ARG_TIMEOUT})
    if(ARG_ALONE)
      set(properties RUN_SERIAL TRUE)
      set(ARG_LABELS alone)
    elseif(ARG_QUIET)
      set(ARG_LABELS quiet)
    endif()
  else()
    set(properties "")
    if(NOT ARG_LABELS)
      set(ARG_LABELS unit)
      add_dependencies(unit_tests ${name})
      if(ARG_LOOP)
        set(ARG_LABELS unit-loop)
        add_dependencies(loop_tests ${name})
      endif()
    endif()
  endif()
  if(ARG_LABELS)
    list(APPEND properties LABELS "${ARG_LABELS}")
  endif()
  if(ARG_SERIAL)
    math(EXPR ARG_TIMEOUT "3 * ${ARG_TIMEOUT}")  # tests/real_time runs a test up to three times
  endif()
  # Black-box recordings of tests go to a directory of their own.
  list(APPEND properties TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT XDG_STATE_HOME=${CMAKE_BINARY_DIR}/state)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
endfunction()

# crane_benchmark(NAME [OWN_MAIN] SOURCES ... LINK ...): program in bin/ that measures and is no test. The target benchmarks
# builds all of them. Google Benchmark provides main(), unless OWN_MAIN is given.
add_custom_target(benchmarks)
function(crane_benchmark name)
  cmake_parse_arguments(ARG "OWN_MAIN" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} EXCLUDE_FROM_ALL ${ARG_SOURCES})
  add_dependencies(benchmarks ${name})
  target_link_libraries(${name} PRIVATE crane_build_flags ${ARG_LINK})
  if(NOT ARG_OWN_MAIN)
    target_link_libraries(${name} PRIVATE benchmark::benchmark benchmark::benchmark_main)
  endif()
endfunction()
