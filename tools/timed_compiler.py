#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a compiler as a compiler launcher of CMake. Appends its cost to SMOOTHFEM_TIMING_LOG: seconds, CPU seconds, peak
memory in MB, and the output file."""

import os
import resource
import subprocess
import sys
import time

start = time.monotonic()
code = subprocess.call(sys.argv[1:])
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
made = sys.argv[sys.argv.index("-o") + 1] if "-o" in sys.argv else "?"
with open(os.environ["SMOOTHFEM_TIMING_LOG"], "a", encoding="utf-8") as log:
    log.write(f"{time.monotonic() - start:.2f}\t{usage.ru_utime + usage.ru_stime:.2f}\t"
              f"{usage.ru_maxrss / 1024:.0f}\t{made}\n")
sys.exit(code)
