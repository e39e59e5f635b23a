#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the benchmarks that the manual quotes, and writes their output with commit and machine.

    speed.py SOURCE BENCHMARKS OUT.md

BENCHMARKS: the folder of the programs, built from SOURCE. Takes a quarter of an hour on an idle machine."""

import json
import os
import subprocess
import sys
from datetime import date
from pathlib import Path

from make_reference import git, has_changes

HEADER = """# Speed

Output of `./run bench speed` on {date}, commit {commit}: {cpu}, {cores} cores. Times depend on the machine; compare ratios.

## Methods on volume meshes

Whole runs of the methods' main loops, medians of {repetitions}, and their preparation, on randomly distorted tetrahedra and hexahedra
(`meshes/bench/volume_bench.cc`). The section on equal care has their counts.

| method | cells | threads | seconds | preparation, s | q_min | q_mean |
|:--|:--|--:|--:|--:|--:|--:|
"""
ITERATIONS = """
Time of one iteration of the first stage, and its ratio to the time for moving the necessary bytes at the memory bandwidth:

| method | cells | threads | ms | times the bandwidth's |
|:--|:--|--:|--:|--:|
"""
GRADIENT = """
## The energy's gradient

Time of the gradient in a descent step of the energy, compared with its solve by CG with algebraic multigrid, on the flange of
Section 6.3 at the size of the thesis (`studies/bench/fem_bench.cc`), {cores} threads:

| cells | degree | solve, s | gradient, s | gradient / solve |
|:--|--:|--:|--:|--:|
"""
FAIRNESS = """
## Equal care

Nanoseconds per visited node or element, compared with the least that each method must compute and read (`./run bench fairness`,
`meshes/bench/fairness_bench.cc`):

```
"""
REPETITIONS = 3


def printed(*command):
    """Returns the output of a command."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


def benchmarks(program, chosen, repetitions):
    """Returns results of the benchmarks with matching names: the medians, or the runs if there is one repetition."""
    found = json.loads(printed(program, f"--benchmark_filter={chosen}", "--benchmark_format=json",
                               f"--benchmark_repetitions={repetitions}"))["benchmarks"]
    return [one for one in found if repetitions == 1 or one.get("aggregate_name") == "median"]


def cpu():
    """Returns the name of the processor."""
    lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    return next((line.partition(": ")[2] for line in lines if line.startswith("model name")), "unknown processor")


def commit_of(source):
    """Returns the short commit of the sources, marked if there are uncommitted changes."""
    return git(source, "rev-parse", "--short=7", "HEAD") + (" with changes" if has_changes(source) else "")


def pages(source, folder):
    """Yields the parts of the text as they are measured."""
    cores = os.cpu_count()
    yield HEADER.format(date=date.today(), commit=commit_of(source), cpu=cpu(), cores=cores, repetitions=REPETITIONS)
    for one in benchmarks(folder / "volume_bench", "^run/", REPETITIONS):
        _, method, cells, threads = one["run_name"].split("/")[:4]
        yield (f"| {method} | {cells} | {threads} | {one['real_time'] / 1000:.3g} | {one['preparation_ms'] / 1000:.3f} | "
               f"{one['q_min']:.4f} | {one['q_mean']:.4f} |\n")
    yield ITERATIONS
    for one in benchmarks(folder / "volume_bench", "^iteration/", REPETITIONS):
        _, method, cells, threads = one["run_name"].split("/")[:4]
        yield f"| {method} | {cells} | {threads} | {one['real_time']:.1f} | {one['to_bandwidth']:.2f} |\n"
    yield GRADIENT.format(cores=cores)
    for one in benchmarks(folder / "fem_bench", "^energy_gradient", 1):
        _, cells, degree = one["run_name"].split("/")[:3]
        yield (f"| {cells} | {degree} | {one['solve_s']:.2f} | {one['solve_s'] * one['over_solve']:.3f} | "
               f"{one['over_solve']:.3f} |\n")
    yield FAIRNESS + printed(folder / "fairness_bench") + "```\n"


def main():
    """Writes the text; returns the exit code."""
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    source, folder, out = (Path(word) for word in sys.argv[1:])
    try:
        text = "".join(pages(source, folder))
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"speed: {error}: build the benchmarks first (./run bench speed does)")
    out.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
