# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT with one digest of all sources that results depend on: those listed in LIST, one path below SOURCE_DIR
# a line. An OUTPUT that is up to date is not rewritten, so that nothing is recompiled without need.
file(STRINGS ${LIST} sources)
set(digests "")
foreach(source IN LISTS sources)
  file(SHA256 ${SOURCE_DIR}/${source} digest)
  string(APPEND digests "${source} ${digest}\n")
endforeach()
string(SHA256 version "${digests}")
set(text "#pragma once\n\n#define SMOOTHFEM_RESULTS_VERSION \"${version}\"\n")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}" @ONLY)
