#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Injects faults that happen to programs: kills the program at random moments, fills its disk, damages its
kept results, starts it twice, and gives it unwritable paths. Prints a table of tries and
findings; the exit code is 1 if there are findings.

    torture.py PROGRAM [--scale F] [--seed N] [--out FILE.md]

PROGRAM: libexec/smoothfem/smoothfem of a build. --scale 0.05 takes half a minute, 1 ten minutes."""

import argparse
import csv
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

MESH_FORMATS = (".vtu", ".vtk", ".msh", ".mesh", ".inp")
TIMES = {"smoothing_seconds", "preparation_seconds", "wall_seconds", "reference_preparation_seconds",
         "method_preparation_seconds", "assembly_seconds", "cg_seconds", "jacobi_cg_seconds", "amg_setup_seconds",
         "amg_cg_seconds", "reference_seconds", "method_seconds", "speedup", "peak_memory_gib"}

PLANAR_STUDY = """set meshes = grid
set methods = laplace, getme
set timing runs = 1
set write series = true
subsection mesh grid
  set file = grid.msh
end
subsection method getme
  set sequential.max_cycles = 40
end
"""
VOLUME_STUDY = """set dimension = 3
set meshes = tet
set methods = smart-laplace, getme
set timing runs = 1
set record stages every = sequential: 20
set degrees = 1
subsection solution
  set name = volume
end
subsection mesh tet
  set domain = flange
  set edge scale = 4
  set distort to = 0.5
end
"""


class Torture:
    """Runs kinds of experiments one after the other in a temporary folder, and collects the table."""

    def __init__(self, program, folder, scale, seed):
        self.program, self.folder, self.scale = program, folder, scale
        self.random = random.Random(seed)
        self.rows, self.findings = [], []

    def tries(self, at_full_scale):
        return max(3, round(self.scale * at_full_scale))

    def start(self, *words, limit=None):
        """Starts the program. limit: largest size of a file in bytes, which simulates a full disk."""
        def before():
            os.setsid()
            if limit is not None:
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        return subprocess.Popen([self.program, *map(str, words)], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=before)

    def run(self, *words, limit=None):
        process = self.start(*words, limit=limit)
        try:
            out, err = process.communicate(timeout=120)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return None, "", "it did not end within two minutes"
        return process.returncode, out, err

    def found(self, what):
        self.findings.append(what)

    def experiment(self, name, function):
        started, before = time.monotonic(), len(self.findings)
        n, outcome = function()
        self.rows.append((name, n, outcome, len(self.findings) - before, time.monotonic() - started))
        print(f"{name}: {n} tries, {outcome}, {len(self.findings) - before} findings", flush=True)

    def leftovers(self, folder):
        return [p for p in folder.rglob(".*") if p.is_file()]

    def expect_refusal(self, what, outcome, *words):
        """Asserts exit code 2 and one sentence with these words."""
        code, _, err = outcome
        lines = err.strip().splitlines()
        if code != 2 or len(lines) != 1 or not all(word in err for word in words):
            self.found(f"{what}: exit code {code}, '{err.strip()[:300]}'")

    # Experiments.

    def kill_smooth(self):
        """The output is complete or missing; the input does not change."""
        mesh, out = self.folder / "solid.vtu", self.folder / "out.vtu"
        content = mesh.read_bytes()
        started = time.monotonic()
        code, _, err = self.run("smooth", mesh, "-m", "getme-simultaneous", "-o", out)
        seconds = time.monotonic() - started
        if code != 0:
            self.found(f"smooth: {err}")
        whole = out.read_bytes()
        n, complete = self.tries(100), 0
        for _ in range(n):
            out.unlink(missing_ok=True)
            process = self.start("smooth", mesh, "-m", "getme-simultaneous", "-o", out)
            time.sleep(1.1 * seconds * self.random.random())
            process.kill()
            process.communicate()
            if out.exists():
                complete += 1
                if out.read_bytes() != whole:
                    self.found("smooth, killed: the output is incomplete")
        if mesh.read_bytes() != content:
            self.found("smooth, killed: the input has changed")
        for path in self.leftovers(self.folder):
            path.unlink()
        return n, f"{complete} outputs exist and are complete"

    def rows_of(self, folder):
        result = {}
        for name in ("iterations.csv", "summary.csv", "thresholds.csv"):
            with open(folder / name, encoding="utf-8", newline="") as stream:
                result[name] = [{k: v for k, v in row.items() if k not in TIMES}
                                for row in csv.DictReader(stream)]
        return result

    def kill_study(self, study):
        """A repeatedly killed study ends with the rows of an uninterrupted run."""
        unbroken, killed = self.folder / f"{study}_unbroken", self.folder / f"{study}_killed"
        started = time.monotonic()
        code, _, err = self.run("study", f"{study}.prm", "--out", unbroken, "--quiet")
        if code != 0:
            sys.exit(f"torture: study {study}: {err}")
        seconds = time.monotonic() - started
        expected = self.rows_of(unbroken)
        n, n_ends = self.tries(50), 0
        for _ in range(n):
            process = self.start("study", f"{study}.prm", "--out", killed, "--quiet")
            time.sleep(0.4 * seconds * self.random.random())
            done = process.poll() is not None
            os.killpg(process.pid, signal.SIGKILL) if not done else None
            _, err = process.communicate()
            if done and process.returncode != 0:
                self.found(f"study {study}, resuming: exit code {process.returncode}, {err.strip()}")
                shutil.rmtree(killed, ignore_errors=True)
            elif done:
                n_ends += 1
                if self.rows_of(killed) != expected:
                    self.found(f"study {study}, killed: rows differ from an uninterrupted run")
                shutil.rmtree(killed)
        code, _, err = self.run("study", f"{study}.prm", "--out", killed, "--quiet")
        if code != 0 or self.rows_of(killed) != expected:
            self.found(f"study {study}, killed: exit code {code}, {err.strip()}")
        if self.leftovers(killed):
            self.found(f"study {study}, killed: remaining files {self.leftovers(killed)}")
        return n, f"{n_ends + 1} completed, with the rows of an uninterrupted run"

    def full_disk(self):
        """Every writer reports the full disk and leaves no file."""
        n, written = 0, 0
        disk = self.folder / "disk"
        commands = [(ext, ["smooth", "grid.msh", "-m", "smart-laplace", "-o", disk / f"o{ext}"])
                    for ext in MESH_FORMATS]
        commands += [
            ("--log", ["smooth", "grid.msh", "-m", "smart-laplace", "-o", "o.msh", "--log", disk / "l.csv"]),
            ("--series", ["smooth", "grid.msh", "-m", "smart-laplace", "-o", "o.msh", "--series",
                          disk / "s.pvd"]),
            ("--mark", ["quality", "grid.msh", "--mark", disk / "m.vtu"]),
            ("--histogram", ["quality", "grid.msh", "--histogram", disk / "h.csv"]),
            ("generate", ["generate", "gear", "-o", disk / "g.msh", "--edge-scale", "4"]),
            ("study", ["study", "planar.prm", "--out", disk / "study", "--quiet"]),
        ]
        for name, words in commands:
            for limit in [0, 1, 4096] + [round(10 ** self.random.uniform(0.0, 5.0))
                                         for _ in range(self.tries(15))]:
                shutil.rmtree(disk, ignore_errors=True)
                disk.mkdir()
                n += 1
                outcome = self.run(*words, limit=limit)
                if outcome[0] == 0:  # its output is smaller than the limit
                    written += 1
                    continue
                self.expect_refusal(f"full disk, {name}, {limit} bytes", outcome, "cannot write")
                if self.leftovers(disk):
                    self.found(f"full disk, {name}, {limit} bytes: {self.leftovers(disk)} remain")
        for words in (["list"], ["quality", "grid.msh"], ["smooth", "grid.msh", "-m", "smart-laplace", "-o",
                                                          "o.msh"]):
            n += 1
            with open("/dev/full", "w", encoding="utf-8") as full:
                result = subprocess.run([self.program, *words], cwd=self.folder, stdout=full,
                                        stderr=subprocess.PIPE, text=True, check=False)
            self.expect_refusal(f"{words[0]} > /dev/full", (result.returncode, "", result.stderr),
                                "standard output")
        return n, f"{n - written} refused in a sentence, {written} small enough to fit"

    def damaged_results(self):
        """Damaged kept results are refused, or does not change a row."""
        half, out = self.folder / "half", self.folder / "damaged"
        process = self.start("study", "planar.prm", "--out", half, "--quiet")
        while not any((half / "kept").glob("*.solved")) and process.poll() is None:
            time.sleep(0.001)
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        expected = self.rows_of(self.folder / "planar_unbroken")
        damages = {"cut off": lambda b: b[:self.random.randrange(len(b))],
                   "one bit flipped": self.flip,
                   "emptied": lambda b: b"",
                   "random bytes behind": lambda b: b + self.random.randbytes(8),
                   "exchanged": None, "removed": None}
        n, refused = self.tries(150), 0
        for i in range(n):
            shutil.rmtree(out, ignore_errors=True)
            shutil.copytree(half, out)
            files = sorted(p for p in (out / "kept").rglob("*") if p.is_file())
            kind = list(damages)[i % len(damages)]
            path = self.random.choice(files)
            if kind == "exchanged":
                other = self.random.choice([p for p in files if p != path])
                path.rename(out / "aside")
                other.rename(path)
                (out / "aside").rename(other)
            elif kind == "removed":
                path.unlink()
            else:
                path.write_bytes(damages[kind](path.read_bytes()))
            outcome = self.run("study", "planar.prm", "--out", out, "--quiet")
            if outcome[0] == 0:
                if self.rows_of(out) != expected:
                    self.found(f"kept, {path.name} {kind}: accepted, but the rows differ")
            else:
                refused += 1
                self.expect_refusal(f"kept, {path.name} {kind}", outcome, "is damaged")
        return n, f"{refused} refused in a sentence, {n - refused} ended with the right rows"

    def flip(self, content):
        damaged = bytearray(content)
        bit = self.random.randrange(8 * len(damaged))
        damaged[bit // 8] ^= 1 << bit % 8
        return bytes(damaged)

    def two_at_once(self):
        """One of two runs on a folder ends, the other reports the process that is writing."""
        n = self.tries(20)
        expected = self.rows_of(self.folder / "planar_unbroken")
        for i in range(n):
            out = self.folder / "both"
            shutil.rmtree(out, ignore_errors=True)
            first = self.start("study", "planar.prm", "--out", out, "--quiet")
            time.sleep(0.3 * self.random.random())
            second = self.start("study", "planar.prm", "--out", out, "--quiet",
                                *(["--force"] if i % 2 else []))
            ends = [(p, p.communicate()[1]) for p in (first, second)]
            codes = sorted(p.returncode for p, _ in ends)
            messages = [err for p, err in ends if p.returncode == 2]
            if codes != [0, 2] or not all("is writing" in m or "another run" in m for m in messages):
                self.found(f"two at once: exit codes {codes}, {messages}")
            elif self.rows_of(out) != expected:
                self.found("two at once: the rows differ")
        return n, "one ends, the other is refused"

    def unwritable(self):
        """If nothing can be written, nothing is computed."""
        (self.folder / "file").write_text("a file, not a folder", encoding="utf-8")
        places = [self.folder / "file", Path("/proc/smoothfem"), Path("/dev/null/x")]
        if os.geteuid() != 0:
            locked = self.folder / "locked"
            locked.mkdir(mode=0o555)
            places.append(locked)
        n = 0
        for place in places:
            for words in (["smooth", "grid.msh", "-m", "smart-laplace", "-o", place / "o.vtu"],
                          ["smooth", "grid.msh", "-m", "smart-laplace", "-o", "o.msh", "--log",
                           place / "l.csv"],
                          ["smooth", "grid.msh", "-m", "smart-laplace", "-o", "o.msh", "--series",
                           place / "s.pvd"],
                          ["generate", "gear", "-o", place / "g.msh"],
                          ["quality", "grid.msh", "--mark", place / "m.vtu"],
                          ["study", "planar.prm", "--out", place / "results", "--quiet"]):
                n += 1
                self.expect_refusal(f"{words[0]} into {place}", self.run(*words), "cannot")
        return n, "all refused in a sentence"

    def table(self):
        lines = ["| what | tries | outcome | findings | seconds |", "|---|---|---|---|---|"]
        lines += [f"| {name} | {n} | {outcome} | {found} | {seconds:.0f} |"
                  for name, n, outcome, found, seconds in self.rows]
        return "\n".join(lines + [""] + [f"- {finding}" for finding in self.findings])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--scale", type=float, default=1.0, help="number of tries, as a fraction of the full number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="also write the table to this file")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="smoothfem-torture-") as folder:
        torture = Torture(arguments.program.resolve(), Path(folder), arguments.scale, arguments.seed)
        for study, text in (("planar", PLANAR_STUDY), ("volume", VOLUME_STUDY)):
            (torture.folder / f"{study}.prm").write_text(text, encoding="utf-8")
        for words in (["generate", "gear", "-o", "grid.msh", "--edge-scale", "4", "--distort-to", "0.5"],
                      ["generate", "flange", "-o", "solid.vtu", "--elements", "hexahedra",
                       "--edge-scale", "2", "--distort-to", "0.7"]):
            code, _, err = torture.run(*words)
            if code != 0:
                sys.exit(f"torture: {' '.join(words)}: {err}")
        torture.experiment("SIGKILL, smooth", torture.kill_smooth)
        torture.experiment("SIGKILL, planar study", lambda: torture.kill_study("planar"))
        torture.experiment("SIGKILL, volume study", lambda: torture.kill_study("volume"))
        torture.experiment("full disk, every writer", torture.full_disk)
        torture.experiment("damaged kept results", torture.damaged_results)
        torture.experiment("two runs, one folder", torture.two_at_once)
        torture.experiment("unwritable paths", torture.unwritable)
        table = torture.table()
    print(table)
    if arguments.out:
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        arguments.out.write_text(f"Tries and findings of the last run of `./run torture`.\n\n{table}\n",
                                 encoding="utf-8")
    sys.exit(1 if torture.findings else 0)


if __name__ == "__main__":
    main()
