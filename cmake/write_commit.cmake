# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT with the commit of SOURCE_DIR and whether it has uncommitted changes. An OUTPUT that is
# up to date is not rewritten, so that nothing is recompiled without need.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse HEAD
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
                RESULT_VARIABLE failed)
set(dirty false)
if(failed)
  set(commit "unknown")
else()
  # Results of the program are not its sources: they change while the program writes them.
  execute_process(COMMAND git -C ${SOURCE_DIR} status --porcelain --untracked-files=no -- . ":!results/reference"
                  OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    set(dirty true)
  endif()
endif()
set(text "#pragma once\n\n#define SMOOTHFEM_COMMIT \"${commit}\"\n#define SMOOTHFEM_DIRTY ${dirty}\n")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)
