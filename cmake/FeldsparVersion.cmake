# feldspar_version.h: the version of the project and the commit it was built from.
#   feldspar_version   link it to #include "feldspar_version.h"
#
# Every build asks git again (a few milliseconds), but the header is touched only when its text changes. Without git, in
# an unpacked archive or before the first commit, the commit is empty and the version is the project's alone.

# This file is also the script that the build runs.
function(feldspar_write_version_header source_dir header version)
  set(commit "")
  find_program(GIT_EXECUTABLE git)
  if(GIT_EXECUTABLE)
    # An archive unpacked inside somebody else's checkout must not take that one's commit.
    execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --show-cdup --short=7 --verify HEAD
      WORKING_DIRECTORY ${source_dir} OUTPUT_VARIABLE answer RESULT_VARIABLE failed ERROR_QUIET)
    if(NOT failed AND answer MATCHES "^\n([0-9a-f]+)\n$")
      set(commit ${CMAKE_MATCH_1})
      execute_process(COMMAND ${GIT_EXECUTABLE} diff --quiet HEAD --
        WORKING_DIRECTORY ${source_dir} RESULT_VARIABLE modified OUTPUT_QUIET ERROR_QUIET)
    endif()
  endif()

  set(full_version ${version})
  if(commit)
    string(APPEND full_version "+g${commit}")
    if(modified)
      string(APPEND full_version ".modified")
    endif()
  endif()

  set(text "// Written by cmake/FeldsparVersion.cmake.
#pragma once

#include <string_view>

namespace feldspar
{
/// The project's version, and the commit where it is known: 0.2.0+g1a2b3c4, with .modified for a changed work tree.
inline constexpr std::string_view version = \"${full_version}\";

/// The commit alone, seven or more digits; empty where it is not known.
inline constexpr std::string_view commit = \"${commit}\";
} // namespace feldspar
")
  set(old_text "")
  if(EXISTS ${header})
    file(READ ${header} old_text)
  endif()
  if(NOT old_text STREQUAL text)
    file(WRITE ${header} "${text}")
  endif()
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  feldspar_write_version_header(${SOURCE_DIR} ${HEADER} ${VERSION})
  return()
endif()

set(feldspar_version_header ${PROJECT_BINARY_DIR}/generated/feldspar_version.h)
feldspar_write_version_header(${PROJECT_SOURCE_DIR} ${feldspar_version_header} ${PROJECT_VERSION})
add_custom_target(feldspar_version_header
  COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DHEADER=${feldspar_version_header}
    -DVERSION=${PROJECT_VERSION} -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${feldspar_version_header}
  COMMENT "Version" VERBATIM)
add_library(feldspar_version INTERFACE)
target_include_directories(feldspar_version INTERFACE ${PROJECT_BINARY_DIR}/generated)
add_dependencies(feldspar_version feldspar_version_header)
