# Control laws, analysis, the plant model and the supervisor's logic are pure: they include no DDS, no log, no clock, no files, and
# nothing of the rooms above them.
cmake_minimum_required(VERSION 3.25)
set(forbidden "#include [<\"](dds/|fastdds|fastrtps|spdlog|fstream|filesystem|iostream|chrono|thread|mutex|ctime|time\\.h|unistd|crane/(topics|bus|runtime|recording|experiment|bridge))")
file(GLOB_RECURSE sources
  ${SOURCE_DIRECTORY}/libs/analysis/*.[ch]pp
  ${SOURCE_DIRECTORY}/libs/control/*.[ch]pp ${SOURCE_DIRECTORY}/plant/model/*.[ch]pp
  ${SOURCE_DIRECTORY}/plant/identification/*.[ch]pp
  ${SOURCE_DIRECTORY}/supervisor/include/*.[ch]pp ${SOURCE_DIRECTORY}/supervisor/src/*.[ch]pp)
list(LENGTH sources count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} sources found in the pure rooms: has one of them moved?")
endif()
set(problems "")
foreach(source IN LISTS sources)
  file(STRINGS ${source} lines REGEX "${forbidden}")
  foreach(line IN LISTS lines)
    string(APPEND problems "${source}: ${line}\n")
  endforeach()
endforeach()
if(problems)
  message(FATAL_ERROR "a pure room includes what it must not:\n${problems}")
endif()
