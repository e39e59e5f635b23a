# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT with the commit that SOURCE_DIR is at and whether it has uncommitted changes; leaves the
# file alone if it says so already, so that nothing is compiled again without need.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
set(dirty false)
if(failed)
  set(commit "unknown")
else()
  # Results of the program are none of its sources: they change while it makes them one after the other.
  execute_process(COMMAND git -C ${SOURCE_DIR} status --porcelain --untracked-files=no -- . ":!results/reference"
                  OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    set(dirty true)
  endif()
endif()
set(text "#pragma once\n\n#define SMOOTHFEM_COMMIT \"${commit}\"\n#define SMOOTHFEM_DIRTY ${dirty}\n")
set(present "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} present)
endif()
if(NOT present STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
