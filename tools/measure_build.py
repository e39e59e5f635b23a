#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures build times in a separate folder (build/timing): a fresh build of the program and of the
tests, the largest translation units, and builds after two typical changes. Prints the tables of
docs/how-to/develop.md. Usage: measure_build.py SOURCE [CMAKE_OPTION...]; run it on a quiet machine."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

SMOOTHER = "half_laplace"
LARGEST = 8  # translation units in the table


def timed(*command):
    """Returns the seconds that a command takes; ends the program if it fails."""
    start = time.monotonic()
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False)
    if result.returncode != 0:
        sys.exit(f"measure_build: '{' '.join(map(str, command))}' failed:\n{result.stdout[-3000:]}")
    return time.monotonic() - start


def documented_smoother(source):
    """Returns the smoother in docs/how-to/smoother-in-cpp.md."""
    page = source / "docs" / "how-to" / "smoother-in-cpp.md"
    return page.read_text(encoding="utf-8").split("```cpp\n")[1].split("```")[0]


def after_change(build, path, text):
    """Returns the seconds to build the program after a change of a file; restores the file."""
    old = path.read_text(encoding="utf-8") if path.exists() else None
    try:
        path.write_text(text, encoding="utf-8")
        return timed("cmake", "--build", build, "--target", "smoothfem")
    finally:
        if old is None:
            path.unlink()
        else:
            path.write_text(old, encoding="utf-8")
        timed("cmake", "--build", build, "--target", "smoothfem")


def units(log):
    """Returns (CPU seconds, MB, name) of the compiled files, largest first."""
    rows = []
    for line in log.read_text(encoding="utf-8").splitlines():
        _, processor, memory, made = line.split("\t")
        rows.append((float(processor), int(memory), made.split(".dir/")[-1].removesuffix(".o")))
    return sorted(rows, reverse=True)


def main(source, options):
    build = source / "build" / "timing"
    log = build / "compiler.tsv"
    shutil.rmtree(build, ignore_errors=True)
    build.mkdir(parents=True)
    os.environ["SMOOTHFEM_TIMING_LOG"] = str(log)
    launcher = source / "tools" / "timed_compiler.py"
    rows = []
    configured = timed("cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                       f"-DCMAKE_CXX_COMPILER_LAUNCHER={sys.executable};{launcher}", *options)
    rows.append(("fresh clone to the program (configure and build)",
                 configured + timed("cmake", "--build", build, "--target", "smoothfem")))
    rows.append(("the tests, after that", timed("cmake", "--build", build, "--target", "smoothfem_tests")))
    all_units = units(log)
    mean_ratio = source / "smoothing" / "quality" / "mean_ratio.h"
    rows.append(("a new smoother to the program",
                 after_change(build, source / "smoothing" / "smoothers" / f"{SMOOTHER}.cc",
                              documented_smoother(source))))
    rows.append(("a change in `mean_ratio.h` to the program",
                 after_change(build, mean_ratio,
                              mean_ratio.read_text(encoding="utf-8") + "\n// changed\n")))
    print("| step | seconds |\n|---|---|")
    for name, seconds in rows:
        print(f"| {name} | {seconds:.0f} |")
    print("\n| largest translation units | CPU seconds | MB |\n|---|---|---|")
    for processor, memory, name in all_units[:LARGEST]:
        print(f"| `{name}` | {processor:.0f} | {memory} |")
    most = max(all_units, key=lambda unit: unit[1])
    print(f"\nThe build has {len(all_units)} translation units and takes {sum(u[0] for u in all_units):.0f} CPU seconds. "
          f"`{most[2]}` needs the most memory, {most[1]} MB.")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2:])
