# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command line that README.md shows is run, in the order of the text, in a folder that has the
files it names. What takes longer than a test may take is run at a small size, or seen to begin."""

import collections
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from .build_folder import BUILD, COMMANDS, DRAWING, SMOOTHFEM, SOURCE, environment, run
from .test_fetch_published import Server

SHARED = Path(os.environ.get("SMOOTHFEM_MESHES", SOURCE.parent / "shared" / "meshes"))
SECONDS_TO_BEGIN = 8

# Studies that take minutes are run at their small size.
SMALLER = {("study", "gear"), ("study", "my.prm"), ("study", "subdivision"), ("study", "polygons")}
# What is only seen to begin, and to end at Ctrl-C: it takes longer at any size.
ONLY_BEGUN = {("study", "all"), ("study", "volume")}


def command_lines():
    """The lines of README's fenced blocks that are commands, without their comments."""
    lines, fence = [], None
    for line in (SOURCE / "README.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("```"):
            fence = None if fence is not None else line[3:]
        elif fence == "":  # a block without a language
            lines.append(line.split(" #")[0].strip())
    return lines


class ReadmeCommands(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        run(SMOOTHFEM, "generate", "ring", "-o", "in.vtu", "--distort-to", "0.6", folder=cls.folder)
        run(SMOOTHFEM, "generate", "gear", "-o", "in.msh", "--edge-scale", "3", "--distort-to", "0.45", folder=cls.folder)
        for name in ("volume.msh", "volume.inp"):
            run(SMOOTHFEM, "generate", "sweep", "-o", name, "--distort-to", "0.6", folder=cls.folder)
        cls.write_files_of_users()

    @classmethod
    def write_files_of_users(cls):
        """A study and a smoother of one's own; a tangled mesh; groups of nodes for --fix."""
        shutil.copy(SOURCE / "studies" / "gear.prm", cls.folder / "my.prm")
        text = (SOURCE / "README.md").read_text(encoding="utf-8")
        smoother = next(code for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "class Mine" in code)
        (cls.folder / "mine.py").write_text(smoother)
        # Four quadrilaterals around a node that lies outside of them.
        points = [(x, y) for y in range(3) for x in range(3)]
        points[4] = (2.5, 1.0)
        cells = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
        lines = ["# vtk DataFile Version 3.0", "tangled", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 9 double"]
        lines += [f"{x} {y} 0" for x, y in points]
        lines += ["CELLS 4 20"] + ["4 " + " ".join(map(str, cell)) for cell in cells]
        lines += ["CELL_TYPES 4"] + ["9"] * 4
        (cls.folder / "tangled.vtk").write_text("\n".join(lines) + "\n")
        cls.label_facets(cls.folder / "volume.inp")

    @staticmethod
    def label_facets(path):
        """Names two boundary facets of hexahedra in an Abaqus file: wall and inlet."""
        text = path.read_text()
        rows = re.search(r"TYPE=C3D8\n(.*?)\n\*", text, re.DOTALL).group(1).splitlines()
        corners = [list(map(int, row.split(",")))[1:] for row in rows]
        faces = [tuple(cell[k] for k in face) for cell in corners
                 for face in ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
        count = collections.Counter(tuple(sorted(face)) for face in faces)
        boundary = [face for face in faces if count[tuple(sorted(face))] == 1]
        added = "".join(f"*ELEMENT, TYPE=S4, ELSET={name}\n{len(rows) + 1 + i}, {', '.join(map(str, boundary[i]))}\n"
                        for i, name in enumerate(("wall", "inlet")))
        head, star, tail = text.partition("*NSET, NSET=SMOOTHFEM_FIXED")
        path.write_text(head + added + star + tail)

    def test_there_are_commands(self):
        lines = command_lines()
        self.assertGreater(len(lines), 25)
        for line in lines:
            self.assertRegex(line, r"^\./run [a-z]+", line)

    def test_each_runs(self):
        for line in command_lines():
            with self.subTest(line):
                self.run_line(line)

    def run_line(self, line):
        """Runs one line of README."""
        command, *words = line.removeprefix("./run ").split()
        if command in (*COMMANDS, *DRAWING):
            self.run_program([command, *words])
        else:
            self.run_by_script(command, words)

    def run_program(self, words):
        """A command of the program; `./run` passes it on as it is."""
        more = {}
        key = tuple(words[:2])
        if key in ONLY_BEGUN:
            self.begins([SMOOTHFEM, *words])
            return
        if key in SMALLER and "--list" not in words:
            words = [*words, "--quick", "--quiet"]
            self.set_up_published(words, more)
        if words[0] in DRAWING:  # what there is to draw
            run(SMOOTHFEM, "study", Path(words[1]).name, "--quick", "--quiet", "--out", words[1], folder=self.folder)
        if "--against" in words:
            shutil.copytree(self.folder / words[1], self.folder / words[words.index("--against") + 1])
        outcome = run(SMOOTHFEM, *words, folder=self.folder, check=False, **more)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        if words[0] in DRAWING:
            shutil.rmtree(self.folder / "results")
        for i, word in enumerate(words):
            if word in ("-o", "--log", "--series", "--histogram"):
                self.assertTrue((self.folder / words[i + 1]).is_file(), words[i + 1])
        if words[0] == "study" and len(words) > 1 and not words[1].startswith("-") and "--dry-run" not in words:
            results = self.folder / "results" / words[1].removesuffix(".prm")
            self.assertTrue(list((results / "tables").iterdir()))
            shutil.rmtree(results)  # the next line may run the same study on other meshes

    def set_up_published(self, words, more):
        """Where the published meshes are, for a line that needs them."""
        if "--mesh-dir" not in words and "--published" not in words:
            return
        names = ("gear_tri_initial.mesh", "gear_quad_initial.mesh")
        if not all((SHARED / name).is_file() for name in names):
            self.skipTest(f"SKIPPED: the published meshes are not in {SHARED}; SMOOTHFEM_MESHES names their folder")
        if "--mesh-dir" in words:
            words[words.index("--mesh-dir") + 1] = SHARED
        else:
            server = Server({name: (SHARED / name).read_bytes() for name in names})
            self.addCleanup(server.close)
            more.update(SMOOTHFEM_PUBLISHED_URL=server.url, XDG_CACHE_HOME=self.folder / "cache", no_proxy="*")

    def run_by_script(self, command, words):
        """A command of the script ./run itself."""
        if BUILD != SOURCE / "build" / "release":
            self.skipTest("SKIPPED: ./run works in build/release only")
        if command == "test":  # this test is one of them: only named
            listed = run("ctest", "-N", *words, folder=BUILD).stdout
            self.assertGreater(int(re.search(r"Total Tests: (\d+)", listed).group(1)), 100)
        elif command == "bench":
            self.assertIn("bench", {path.name for path in BUILD.iterdir()})
            for program in sorted((BUILD / "bench").glob("*_bench")):
                if program.name == "fairness_bench":  # takes other options, and minutes
                    continue
                self.assertTrue(run(program, "--benchmark_list_tests", folder=self.folder).stdout)
        elif command == "install":
            run(SOURCE / "run", "install", "--prefix", self.folder / "prefix", folder=self.folder)
            self.assertTrue((self.folder / "prefix" / "bin" / "smoothfem").is_file())
        elif command == "package":  # compiles the program anew; shown to exist only
            self.assertIn("  package)", (SOURCE / "run").read_text(encoding="utf-8"))
        else:
            self.fail(f"./run {command}: this test does not know how to run it")

    def begins(self, words):
        """Starts a long command; it has to live, or to have ended well, and to end when interrupted."""
        with subprocess.Popen([str(word) for word in words], cwd=self.folder, env=environment(), text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              start_new_session=True) as process:
            try:
                code = process.wait(SECONDS_TO_BEGIN)
                self.assertEqual(code, 0, process.stderr.read())
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGINT)
                started = time.monotonic()
                _, told = process.communicate(timeout=120)
                self.assertLess(time.monotonic() - started, 120)
                self.assertNotIn("internal error", told)
        shutil.rmtree(self.folder / "results", ignore_errors=True)


if __name__ == "__main__":
    unittest.main()
