# Provenance of the program: version, commit, compiler and flags, in a generated header.
#
# Included, this file adds the target plumb_build_info, which runs the same file as a script at every build: the commit is
# the one that is built, not the one at which CMake configured. The header is touched only when something in it
# changed, so nothing is recompiled for nothing.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  string(JOIN " " code_flags ${PLUMB_CODE_FLAGS})
  set(flags "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${OpenMP_CXX_FLAGS} ${code_flags}")
  set(header "${CMAKE_CURRENT_BINARY_DIR}/generated/run/build_info.hpp")
  add_custom_target(
    plumb_refresh_build_info
    COMMAND
      "${CMAKE_COMMAND}" "-DPLUMB_SOURCE_DIR=${PROJECT_SOURCE_DIR}" "-DPLUMB_VERSION=${PROJECT_VERSION}"
      "-DPLUMB_COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
      "-DPLUMB_FLAGS=${flags}"
      "-DPLUMB_INPUT=${CMAKE_CURRENT_LIST_DIR}/build_info.hpp.in" "-DPLUMB_OUTPUT=${header}"
      -P "${CMAKE_CURRENT_LIST_FILE}"
    BYPRODUCTS "${header}"
    COMMENT "Noting the commit"
    VERBATIM)
  add_library(plumb_build_info INTERFACE)
  target_include_directories(plumb_build_info INTERFACE "$<BUILD_INTERFACE:${CMAKE_CURRENT_BINARY_DIR}/generated>")
  add_dependencies(plumb_build_info plumb_refresh_build_info)
  return()
endif()

set(PLUMB_COMMIT "")
set(PLUMB_DIRTY "false")
find_program(PLUMB_GIT git)
if(PLUMB_GIT)
  execute_process(
    COMMAND "${PLUMB_GIT}" rev-parse HEAD
    WORKING_DIRECTORY "${PLUMB_SOURCE_DIR}"
    OUTPUT_VARIABLE PLUMB_HEAD OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE PLUMB_FAILED)
  if(NOT PLUMB_FAILED)
    set(PLUMB_COMMIT "${PLUMB_HEAD}")
    execute_process(
      COMMAND "${PLUMB_GIT}" --no-optional-locks status --porcelain
      WORKING_DIRECTORY "${PLUMB_SOURCE_DIR}"
      OUTPUT_VARIABLE PLUMB_CHANGES ERROR_QUIET)
    if(NOT PLUMB_CHANGES STREQUAL "")
      set(PLUMB_DIRTY "true")
    endif()
  endif()
endif()
string(REGEX REPLACE "[ \t\r\n]+" " " PLUMB_FLAGS "${PLUMB_FLAGS}")
string(STRIP "${PLUMB_FLAGS}" PLUMB_FLAGS)
foreach(text PLUMB_VERSION PLUMB_COMMIT PLUMB_COMPILER PLUMB_FLAGS)
  string(REPLACE "\\" "\\\\" ${text} "${${text}}")
  string(REPLACE "\"" "\\\"" ${text} "${${text}}")
endforeach()
configure_file("${PLUMB_INPUT}" "${PLUMB_OUTPUT}" @ONLY)
