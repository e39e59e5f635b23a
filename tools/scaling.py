#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooths boxes of tetrahedra in parts, on several processes, and writes times, memory and what the processes exchange.

    scaling.py SOURCE PROGRAM OUT.md [--huge]

PROGRAM: bin/smoothfem, built from SOURCE. Takes ten minutes, 4 GiB of memory and 2 GB of disk in TMPDIR. --huge: also 2e8 cells on two
processes, which takes another ten minutes, 21 GiB of memory and 27 GB of disk. A run that was killed goes on: what it has measured is in
scaling.json next to bin until the end."""

import json
import os
import re
import subprocess
import sys
import tempfile
from datetime import date
from pathlib import Path
from statistics import median

from speed import commit_of, cpu

HEADER = """# Scaling

Output of `./run bench scaling` on {date}, commit {commit}: {cpu}, {cores} cores. Boxes of tetrahedra, whose nodes inside are displaced by up to 0.15
edges, smoothed by `getme-simultaneous` in parts. It ends after {iterations} iterations on all of them.

## Times and memory

Medians of {repetitions} runs, in turn. The time of an iteration is that of the whole loop, divided by iterations and cells. Memory is that of the
process that needs most. Its limit: 1.3 times the memory of one process, divided by the processes, and 200 MB.

| cells | processes | threads each | read, s | distribute, s | iteration, ns a cell | GiB a process | limit, GiB |
|--:|--:|--:|--:|--:|--:|--:|--:|
"""
METHODS = """
## Methods

{cells:,.0f} cells, one thread for each process, medians of {repetitions} runs in turn. Seconds are those of the method's loop. Each method gives
the same mesh on one and on two processes.

| method | 1 process, s | 2 processes, s | ratio | q_min | q_mean |
|:--|--:|--:|--:|--:|--:|
"""
WEAK = """
## Exchange

About {cells:,} cells a process, on more processes than cores, so that only counts have a meaning. An iteration sends 24 bytes for each copied
node, in three messages for each neighbour.

| processes | cells | largest share | copied nodes, most | neighbours, most | kB an iteration, most |
|--:|--:|--:|--:|--:|--:|
"""
MODEL = """
## Model

An iteration takes a seconds for each cell of a process and b seconds for each copied node. More processes than cores share these. With {cells:,.0f}
cells, one process gives a = {a:.2f} ns. The first design took b from two processes: {by_two:.1f} ns. The copies of two processes cost less than
runs differ, so that this b may even be negative. Since 2026-11-30, b is also taken from eight processes: {by_eight:.1f} ns. The other numbers of
processes test both:

| processes | measured, ns a cell | predicted, b of two | predicted, b of eight |
|--:|--:|--:|--:|
"""
LARGE = """
With b of eight processes, 10^9 cells on 10^4 processes, each with a core of its own, would take {total:.2f} ms an iteration: {compute:.2f} ms for {cells:,.0f} cells a process,
and {exchange:.2f} ms for {copies:,.0f} copied nodes (those of {processes} processes above, in proportion to the surface). The model knows no
network: its latency, for {neighbours:.0f} neighbours with three messages each and five sums over all processes, comes on top.
"""
REPETITIONS = 3
EDGE = 119  # cubes along an edge, with six tetrahedra each: 1.0e7 cells
HUGE_EDGE = 322  # 2.0e8 cells
OTHER_METHODS = ("laplace", "weighted-laplace", "smart-laplace", "getme-simultaneous", "getme", "getme-adaptive", "global-optimization")
SMALLER_EDGE = 55  # of the boxes for these: 1.0e6 cells
CASES = ((1, 1), (1, 2), (2, 1), (4, 1), (8, 1))  # processes, threads of each
CELLS_A_PROCESS = 20000
PROCESSES = (1, 2, 4, 8, 16, 32, 64)
NUMBERS = re.compile(
    r"and (?P<cells>\d+) cells on .* has (?P<share>[\d.e+]+) times .* at most (?P<copies>\d+) copied nodes, of (?P<neighbours>\d+) "
    r".*after +(?P<q_min>[\d.]+) +[\d.]+ +(?P<q_mean>[\d.]+) .*: (?P<iterations>\d+)[\d/]* iterations in (?P<loop>[\d.e+-]+) s "
    r".*seconds: (?P<read>[\d.e+-]+) to read, (?P<distribute>[\d.e+-]+) to distribute, .* at most (?P<gib>[\d.e+-]+) GiB", re.DOTALL)


def run(program, processes, *words):
    """Runs a command on some processes; returns its output."""
    environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_WAIT_POLICY": "passive"}
    command = ["mpirun", "--quiet", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-np", str(processes), program]
    return subprocess.run([*command, *map(str, words)], env=environment, capture_output=True, text=True, check=True).stdout


class Boxes:
    """Smooths boxes. Numbers that are measured are kept in a file until forget()."""

    def __init__(self, program, folder, commit):
        self.program, self.box, self.commit, self.edge = program, folder / "box.pvtu", commit, None
        self.kept = program.parent.parent / "scaling.json"
        self.known = json.loads(self.kept.read_text(encoding="utf-8")) if self.kept.exists() else {}

    def smoothed(self, edge, pieces, processes, threads, number=0, method="getme-simultaneous"):
        """Smooths a box of edge^3 cubes; returns the numbers that the program prints, by name."""
        key = f"{self.commit} {edge} {pieces} {processes} {threads} {number} {method}"
        if key not in self.known:
            if self.edge != edge:
                run(self.program, 2, "generate", "box", "--cells", f"{edge},{edge},{edge}", "--displacement", 0.15, "--pieces", pieces, "-o", self.box)
                self.edge = edge
            text = run(self.program, processes, "smooth", self.box, "-m", method, "--threads", threads, "-o",
                       self.box.with_name("smoothed.pvtu"))
            self.known[key] = {name: float(value) for name, value in NUMBERS.search(text).groupdict().items()}
            self.kept.write_text(json.dumps(self.known), encoding="utf-8")
        return self.known[key]

    def forget(self):
        """Call it when all is written."""
        self.kept.unlink(missing_ok=True)


def time_row(runs, processes, threads, whole_gib):
    """A line of the table of times."""
    def middle(name):
        return median(one[name] for one in runs)
    cells, gib = middle("cells"), middle("gib")
    limit = 1.3 * whole_gib / processes + 0.2e9 / 2**30 if whole_gib else float("nan")
    return (f"| {cells:,.0f} | {processes} | {threads} | {middle('read'):.1f} | {middle('distribute'):.1f} | "
            f"{1e9 * middle('loop') / middle('iterations') / cells:.1f} | {gib:.2f} | {limit:.2f} |\n").replace("nan", "–")


def pages(boxes, is_huge):
    """Yields the parts of the text as they are measured."""
    runs = {case: [] for case in CASES}
    for number in range(REPETITIONS):
        for case in CASES:
            runs[case].append(boxes.smoothed(EDGE, 16, *case, number))
    whole_gib = median(one["gib"] for one in runs[CASES[0]])
    yield HEADER.format(date=date.today(), commit=boxes.commit, cpu=cpu(), cores=os.cpu_count(), repetitions=REPETITIONS,
                        iterations=f"{runs[CASES[0]][0]['iterations']:.0f}")
    for case in CASES:
        yield time_row(runs[case], *case, whole_gib)
    if is_huge:
        yield time_row([boxes.smoothed(HUGE_EDGE, 64, 2, 1)], 2, 1, None)
    yield from methods(boxes)
    yield WEAK.format(cells=CELLS_A_PROCESS)
    found = None
    for processes in PROCESSES:
        edge = round((CELLS_A_PROCESS * processes / 6) ** (1 / 3))
        found = boxes.smoothed(edge, min(edge, processes), processes, 1)
        yield (f"| {processes} | {found['cells']:,.0f} | {found['share']:.2f} | {found['copies']:,.0f} | {found['neighbours']:.0f} | "
               f"{24 * found['copies'] / 1000:.0f} |\n")
    yield from model({case: runs[case] for case in CASES if case[1] == 1}, PROCESSES[-1], found)


def methods(boxes):
    """Yields the section on all methods that work in parts."""
    cases = [(method, processes) for method in OTHER_METHODS for processes in (1, 2)]
    runs = {case: [] for case in cases}
    for number in range(REPETITIONS):
        for method, processes in cases:
            runs[method, processes].append(boxes.smoothed(SMALLER_EDGE, 4, processes, 1, number, method))
    yield METHODS.format(cells=runs[cases[0]][0]["cells"], repetitions=REPETITIONS)
    for method in OTHER_METHODS:
        one, two = (median(run["loop"] for run in runs[method, processes]) for processes in (1, 2))
        first = runs[method, 1][0]
        yield f"| {method} | {one:.2f} | {two:.2f} | {one / two:.2f} | {first['q_min']:.4f} | {first['q_mean']:.4f} |\n"


def model(runs, processes, found):
    """Yields the section on the model. found: the numbers of many processes."""
    def middle(case, name):
        return median(one[name] for one in runs[case])

    def seconds(case):
        return middle(case, "loop") / middle(case, "iterations")

    def cores(case):
        return min(case[0], os.cpu_count())

    def copies(case):
        return case[0] * middle(case, "copies")
    cells = middle((1, 1), "cells")
    a = seconds((1, 1)) / cells
    b = {case: (cores(case) * seconds(case) - a * cells) / copies(case) for case in ((2, 1), (8, 1))}
    yield MODEL.format(cells=cells, a=1e9 * a, by_two=1e9 * b[2, 1], by_eight=1e9 * b[8, 1])
    for case in runs:
        if case[0] > 1:
            predicted = ("–" if case == fitted else f"{1e9 * (a + b[fitted] * copies(case) / cells) / cores(case):.2f}" for fitted in b)
            yield f"| {case[0]} | {1e9 * seconds(case) / cells:.2f} | {' | '.join(predicted)} |\n"
    share = 1e9 / 1e4
    most_copies = found["copies"] * (share * processes / found["cells"]) ** (2 / 3)
    yield LARGE.format(total=1e3 * (a * share + b[8, 1] * most_copies), compute=1e3 * a * share, exchange=1e3 * b[8, 1] * most_copies,
                       cells=share, copies=most_copies, processes=processes, neighbours=found["neighbours"])


def main():
    """Writes the text."""
    words = [word for word in sys.argv[1:] if word != "--huge"]
    if len(words) != 3:
        sys.exit(__doc__)
    source, program, out = (Path(word) for word in words)
    with tempfile.TemporaryDirectory() as folder:
        try:
            boxes = Boxes(program, Path(folder), commit_of(source))
            text = "".join(pages(boxes, "--huge" in sys.argv))
        except (OSError, subprocess.CalledProcessError) as error:
            sys.exit(f"scaling: {error} {getattr(error, 'stderr', '')}")
    out.write_text(text, encoding="utf-8")
    boxes.forget()
    print(text)


if __name__ == "__main__":
    main()
