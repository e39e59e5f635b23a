#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares smoothing in parts with other programs that move nodes on several processes, and writes a page of tables.

    parallel_tools.py SOURCE PROGRAM OUT.md [--edges 40,60] [--parmmg PROGRAM] [--mesquite PROGRAM]

PROGRAM: bin/smoothfem, built from SOURCE. The other programs are yours; a program that is not given has no rows.
--parmmg: parmmg_O3 of ParMmg. --mesquite: a program that runs Mesquite's LaplaceWrapper in parallel, called as PROGRAM IN.vtk OUT.vtk laplace N, which
prints "smoothed in S s"; N: limit of iterations, 0 for the wrapper's own end. PROGRAM --version prints Mesquite's version.

The rules of the comparison were fixed before it began:

- Meshes: boxes of tetrahedra, of `generate box` with --displacement 0.15; the same coordinates for all programs. Nodes of the boundary stay.
- Work: cells and their nodes stay (ParMmg with -noinsert -noswap -nosurf). Numbers of nodes and cells are compared with those of the box.
- Time: that of smoothing alone, as the programs print it, without reading and writing. Whole smoothing: with the defaults of the program, until it
  ends itself. One pass: the least that its options allow. Cells a second: cells of the mesh divided by that time. Seconds of the whole command
  are given, too.
- Quality: least and mean of the mean ratio, which `smoothfem quality` prints for the written mesh.
- Same result on one and two processes: nodes as a set of coordinates, without an order. Numbers count only if all nodes are the same to the digits in
  the files; otherwise the number of nodes without an equal one and the largest distance to the nearest node of the other result are given.
- Mesquite: LaplaceWrapper with culling and ShapeImprovementWrapper were to be compared, too. In parallel they end with "Inner termination criterion
  satisfied for all patches without meeting outer termination criterion" on one process; with culling, two processes do not end within a minute.
- Medians of three runs. The programs and numbers of processes take turns, so that a slow minute of the machine hits all."""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from datetime import date
from pathlib import Path
from statistics import median

import numpy as np
from scipy.spatial import cKDTree

from scaling import REPETITIONS, run
from speed import commit_of, cpu

HEADER = """# Other parallel programs

Output of `./run bench parallel-tools --edges {edges}` on {date}, commit {commit}: {cpu}, {cores} cores. `tools/parallel_tools.py` has the rules, which were fixed before: boxes
of tetrahedra, whose nodes inside are displaced by up to 0.15 edges; medians of {repetitions} runs in turn. The programs do different work, so a time alone
says little:

{programs}

{box}
"""
TABLE = """
## {cells:,} cells

| program | processes | smoothing, s | cells a second | one pass, s | whole command, s | q_min | q_mean |
|:--|--:|--:|--:|--:|--:|--:|--:|
"""
PROCESSES = (1, 2)


class Tool:
    """A program that smooths. name: in the table; work: a sentence."""

    extension, name, work = ".vtu", "", ""

    def __init__(self, program):
        self.program = program

    def version(self):
        """Returns a text."""
        raise NotImplementedError

    def words(self, given, written, is_pass):
        """Returns the arguments for a smoothing, or for one pass."""
        raise NotImplementedError

    def seconds(self, text, is_pass):
        """Returns the time of smoothing from what the program prints."""
        raise NotImplementedError

    def command(self, is_pass):
        """Returns the command as text."""
        return " ".join([Path(self.program).name, *map(str, self.words("in" + self.extension, "out" + self.extension, is_pass))])


class Smoothfem(Tool):
    """This program; a pass is one of the iterations of a smoothing."""

    extension, name = ".pvtu", "smoothfem, getme-simultaneous"
    work = ("moves each node to the mean of the places that the regularized cells around it have for it; ends when the "
            "mean quality rises by at most 1e-4; one pass is an iteration")

    def version(self):
        return ""

    def words(self, given, written, is_pass):
        return ["smooth", given, "-m", "getme-simultaneous", "--threads", 1, "-o", written]

    def seconds(self, text, is_pass):
        found = re.search(r": (\d+) iterations in ([\d.e+-]+) s", text)
        return float(found[2]) / (int(found[1]) if is_pass else 1)


class ParMmg(Tool):
    """ParMmg, node movement only; a pass is one of its iterations, each of which moves nodes several times."""

    extension, name = ".mesh", "ParMmg"
    work = ("moves nodes one after the other to the centre of volume of the cells around them if the worst of these improves, mostly by at least 2 %; nodes "
            "between processes stay until the next of three iterations, which divides the mesh otherwise; one pass is an iteration, in which Mmg "
            "visits the nodes several times")

    def version(self):
        text = subprocess.run([self.program, "-h"], capture_output=True, text=True, check=False).stdout
        return " ".join(re.search(r"PARMMG, Release ([\d.]+)", text).groups()) + ", Mmg " + re.search(r"MMG3D, +Release ([\d.]+)", text)[1]

    def words(self, given, written, is_pass):
        return ["-noinsert", "-noswap", "-nosurf", *(["-niter", 1] if is_pass else []), "-v", 5, given, written]

    def seconds(self, text, is_pass):
        return float(re.search(r"PHASE 2 COMPLETED\. +([\d.]+)s", text)[1])


class Mesquite(Tool):
    """Mesquite's parallel Laplace smoothing; a pass is one of its iterations."""

    extension, name = ".vtk", "Mesquite, Laplace"
    work = ("moves each node to the mean of its neighbours, one after the other; nodes between processes in turns of independent sets (LaplaceWrapper "
            "without culling, until nodes move by less than 0.001 edges); one pass is an iteration")

    def version(self):
        text = subprocess.run([self.program, "--version"], capture_output=True, text=True, check=True).stdout
        return re.search(r"\d+(\.\d+)+", text)[0]

    def words(self, given, written, is_pass):
        return [given, written, "laplace", 1 if is_pass else 0]

    def seconds(self, text, is_pass):
        return float(re.search(r"smoothed in ([\d.e+-]+) s", text)[1])


def quality(program, path):
    """Returns the numbers of `smoothfem quality`. In parts, nodes on the seams of pieces count once."""
    return json.loads(run(program, 1, "quality", path, "--json"))


def coordinates(program, path, folder):
    """Returns the coordinates of the nodes, as n different rows of 3, in the order of rows."""
    if path.suffix != ".mesh":
        text = folder / "nodes.mesh"
        subprocess.run([program, "convert", path, text], capture_output=True, check=True)
        path = text
    words = path.read_text(encoding="utf-8").split("Vertices", 1)[1].split()
    n = int(words[0])
    return np.unique(np.array(words[1:1 + 4 * n], dtype=float).reshape(n, 4)[:, :3] + 0.0, axis=0)


def difference(one, two):
    """Says whether two sets of nodes are the same."""
    if one.shape == two.shape and (one == two).all():
        return "the same nodes on one process and on two"
    distances = cKDTree(one).query(two)[0]
    return (f"on two processes, {np.count_nonzero(distances):,} of {len(two):,} nodes lie elsewhere than on one, by up to {distances.max():.2g} of the "
            "box's edge")


def boxes(program, folder, edge):
    """Makes the box in all formats; returns its path without extension."""
    path = folder / f"box{edge}"
    for name, pieces in ((path, 2), (whole := folder / "whole", 1)):
        run(program, 1, "generate", "box", "--cells", f"{edge},{edge},{edge}", "--displacement", 0.15, "--pieces", pieces, "-o",
            name.with_suffix(".pvtu"))
    # Mesquite reads neither binary files nor global numbers, which .mesh leaves out.
    for given, written, form in ((whole.with_suffix(".pvtu"), path.with_suffix(".mesh"), ".mesh"),
                                 (path.with_suffix(".mesh"), path.with_suffix(".vtk"), "vtk-text")):
        subprocess.run([program, "convert", given, written, "--to", form], capture_output=True, check=True)
    return path


def measured(tools, path, folder):
    """Smooths in turn; returns (seconds of smoothing, of a pass, of the command) and the written file by (tool, processes)."""
    times = {(tool, processes): ([], [], []) for tool in tools for processes in PROCESSES}
    written = {}
    for _ in range(REPETITIONS):
        for (tool, processes), (smoothing, one_pass, command) in times.items():
            out = written[tool, processes] = folder / f"out{tools.index(tool)}-{processes}{tool.extension}"
            begin = time.monotonic()
            text = run(tool.program, processes, *tool.words(path.with_suffix(tool.extension), out, False))
            command.append(time.monotonic() - begin)
            smoothing.append(tool.seconds(text, False))
            if not isinstance(tool, Smoothfem):
                text = run(tool.program, processes, *tool.words(path.with_suffix(tool.extension), folder / f"pass{tool.extension}", True))
            one_pass.append(tool.seconds(text, True))
    return times, written


def pages(program, source, tools, edges, folder):
    """Yields the parts of the text."""
    yield HEADER.format(date=date.today(), commit=commit_of(source), cpu=cpu(), cores=os.cpu_count(), repetitions=REPETITIONS,
                        edges=",".join(map(str, edges)),
                        programs="\n".join(f"- {tool.name}{' (' + tool.version() + ')' if tool.version() else ''} {tool.work}: "
                                           f"`{tool.command(False)}`." for tool in tools),
                        box="`mpirun -np N` starts each. Each process has one thread.")
    for edge in edges:
        path = boxes(program, folder, edge)
        before = quality(program, path.with_suffix(".mesh"))
        yield TABLE.format(cells=before["n_cells"])
        yield f"| none | – | – | – | – | – | {before['q_min']:.4f} | {before['q_mean']:.4f} |\n"
        times, written = measured(tools, path, folder)
        for (tool, processes), runs in times.items():
            after = quality(program, written[tool, processes])
            if (after["n_nodes"], after["n_cells"]) != (before["n_nodes"], before["n_cells"]):
                sys.exit(f"parallel_tools: {tool.name} returned {after['n_nodes']} nodes and {after['n_cells']} cells")
            smoothing, one_pass, command = map(median, runs)
            yield (f"| {tool.name} | {processes} | {smoothing:.3g} | {before['n_cells'] / smoothing:,.0f} | {one_pass:.3g} | {command:.3g} | "
                   f"{after['q_min']:.4f} | {after['q_mean']:.4f} |\n")
        yield "\nThe results have the nodes and cells of the box, counted. Compared as sets of coordinates:\n\n"
        for tool in tools:
            yield f"- {tool.name}: {difference(*(coordinates(program, written[tool, n], folder) for n in PROCESSES))}.\n"


def main():
    """Writes the text."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("source", "program", "out"):
        parser.add_argument(name, type=Path)
    parser.add_argument("--edges", default="40,60")
    parser.add_argument("--parmmg", type=Path)
    parser.add_argument("--mesquite", type=Path)
    a = parser.parse_args()
    tools = [Smoothfem(a.program)] + ([ParMmg(a.parmmg)] if a.parmmg else [])
    if a.mesquite:
        tools.append(Mesquite(a.mesquite))
    with tempfile.TemporaryDirectory() as folder:
        try:
            text = "".join(pages(a.program, a.source, tools, [int(edge) for edge in a.edges.split(",")], Path(folder)))
        except (OSError, subprocess.CalledProcessError) as error:
            sys.exit(f"parallel_tools: {error} {getattr(error, 'stderr', '')} {getattr(error, 'stdout', '')}")
    a.out.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
