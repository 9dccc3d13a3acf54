# SPDX-License-Identifier: Apache-2.0
# Run at every build as `cmake -DSOURCE_DIR=... -DOUTPUT=... -P`: writes the git commit into a header, and touches
# the header only where the commit changed, so that nothing else is compiled again.
set(commit "unknown")
# A release unpacked inside somebody's repository must not take that repository's commit: .git has to be here.
if(EXISTS "${SOURCE_DIR}/.git")
  find_package(Git QUIET)
  if(GIT_FOUND)
    execute_process(COMMAND "${GIT_EXECUTABLE}" -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 --exclude=*
                    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
      set(commit "${described}")
    endif()
  endif()
endif()
set(text "// SPDX-License-Identifier: Apache-2.0\n// Written by cmake/SpectraceCommit.cmake.\n#pragma once\n#define SPECTRACE_COMMIT \"${commit}\"\n")
set(old "")
if(EXISTS "${OUTPUT}")
  file(READ "${OUTPUT}" old)
endif()
if(NOT old STREQUAL text)
  file(WRITE "${OUTPUT}" "${text}")
endif()
