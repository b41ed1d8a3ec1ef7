# Headers of a DDS implementation occur in its back end only (and in the tests that forge its samples).
cmake_minimum_required(VERSION 3.25)
file(GLOB_RECURSE sources
  ${SOURCE_DIRECTORY}/libs/*.[ch]pp ${SOURCE_DIRECTORY}/plant/*.[ch]pp ${SOURCE_DIRECTORY}/services/*.[ch]pp
  ${SOURCE_DIRECTORY}/supervisor/*.[ch]pp ${SOURCE_DIRECTORY}/hardware_bridge/*.[ch]pp)
set(problems "")
foreach(source IN LISTS sources)
  if(source MATCHES "libs/bus/src/(cyclone|fastdds)/")
    continue()
  endif()
  file(STRINGS ${source} lines REGEX "#include [<\"](dds/dds\\.h|fastdds|fastrtps|fastcdr)")
  foreach(line IN LISTS lines)
    string(APPEND problems "${source}: ${line}\n")
  endforeach()
endforeach()
if(problems)
  message(FATAL_ERROR "a vendor header outside its back end:\n${problems}")
endif()
