#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""against_program.py BUILD MESH [--pairs 10] [--method getme]: measures the cost of smoothing in memory from Python,
compared with the same call in C++ (BUILD/bench/smooth_call) and with the program, on the same mesh. Every run is a new
process on one thread. The runs alternate, and so does the first of them.

loops: time of the methods' main loops, as all three report it. call: wall-clock time of smooth() in Python and in C++;
the program does not report it. Both times exclude reading and writing."""

import argparse
import json
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

CALL = """
import json, sys, time
import smoothfem
mesh = smoothfem.read(sys.argv[1])
start = time.perf_counter()
result = smoothfem.smooth(mesh, sys.argv[2], threads=1)
seconds = time.perf_counter() - start
print(json.dumps({"loops": result.smoothing_seconds, "call": seconds, "iterations": result.iterations,
                  "q_mean": f"{result.quality.q_mean:.4f}"}))
"""


def python_run(build, mesh, method):
    """Returns times in seconds, and the result."""
    package = next(build.glob("lib/python3/*/smoothfem")).parent
    text = subprocess.run([sys.executable, "-c", CALL, mesh, method], env={"PYTHONPATH": str(package)}, check=True,
                          capture_output=True, text=True).stdout
    return json.loads(text)


def call_run(build, mesh, method):
    """Returns times in seconds, and the result."""
    return json.loads(subprocess.run([build / "bench" / "smooth_call", mesh, method], check=True, capture_output=True,
                                     text=True).stdout)


def program_run(build, mesh, method):
    """Returns the time of the loops in seconds, and the result."""
    with tempfile.TemporaryDirectory() as folder:
        text = subprocess.run([build / "bin" / "smoothfem", "smooth", mesh, "-m", method, "--threads", "1",
                               "-o", Path(folder) / "out.vtu"], check=True, capture_output=True, text=True).stdout
    iterations, loops = re.search(r": (\S+) iterations in (\S+) s, and \S+ s of preparation", text).groups()
    return {"loops": float(loops), "iterations": iterations,
            "q_mean": re.search(r"^after +\S+ +\S+ +(\S+)", text, re.MULTILINE)[1]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--pairs", type=int, default=10)
    parser.add_argument("--method", default="getme")
    arguments = parser.parse_args()
    build, mesh = arguments.build.resolve(), arguments.mesh.resolve()
    kinds = {"Python": python_run, "C++": call_run, "program": program_run}
    runs = {name: [] for name in kinds}
    for pair in range(arguments.pairs):
        for name in sorted(kinds, reverse=pair % 2 == 1):
            runs[name].append(kinds[name](build, mesh, arguments.method))
        print(f"pair {pair + 1}: " + ", ".join(f"{name} {runs[name][-1]}" for name in kinds), flush=True)
    results = {(run["iterations"], run["q_mean"]) for name in kinds for run in runs[name]}
    if len(results) > 1:
        sys.exit(f"the results differ: {sorted(results)}")
    for what, other in (("loops", "program"), ("loops", "C++"), ("call", "C++")):
        seconds = {name: [run[what] for run in runs[name]] for name in ("Python", other)}
        ratios = sorted(a / b for a, b in zip(seconds["Python"], seconds[other], strict=True))
        medians = ", ".join(f"{name} {statistics.median(times):.3f} s" for name, times in seconds.items())
        print(f"{what}: medians {medians}; ratio in pairs: median {statistics.median(ratios):.4f}, "
              f"from {ratios[0]:.4f} to {ratios[-1]:.4f}")


main()
