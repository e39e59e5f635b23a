# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests smoothers written in Python in the program and in studies, and refused smoothers."""

import hashlib
import json
import os
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from .built import EXAMPLES, MESHES, PROGRAM, distorted, grid, run, smoothfem
from .smoother_files import CHEATS, SMOOTHERS, InAFolder

NO_SMOOTHERS = {"NoStep": "not a smoother: it has no step", "Text": "parameter flag has the default True", "Mime": "has no class 'Mime'",
                "Leaves": "Leaves: step failed: mine.py:.*SystemExit", "Interrupts": "has raised KeyboardInterrupt"}
STUDY = """set title     = Python smoothers
set dimension = {dim}
set meshes    = mesh
set methods   = laplace, mine
set degrees   = 1
set timing runs = 1
subsection mesh mesh
  set domain     = {domain}
  set elements   = {elements}
  set edge scale = {edge_scale}
  set distort to = {q_mean}
end
subsection method mine
  set type     = python:smoothers/mine.py:Laplace
  set fraction = 0.5
end
subsection method laplace
  set tolerance      = 0
  set max_iterations = 4
end
subsection solution
  set name = {solution}
end
"""


class InTheProgram(InAFolder):
    def refused(self, *words, **more):
        """Returns the message of a refused command."""
        outcome = run(PROGRAM, *words, folder=self.folder, check=False, **more)
        self.assertEqual((outcome.returncode, outcome.stderr.count("\n")), (2, 1), outcome.stderr)
        return outcome.stderr.strip()

    def test_laplace_is_that_of_the_program(self):
        for elements in MESHES:
            with self.subTest(elements):
                mesh = grid(elements)
                smoothfem.write(mesh, "in.vtu")
                run(PROGRAM, "smooth", "in.vtu", "-m", "python:mine.py:Laplace", "-o", "mine.vtu", "--set", "max_iterations=2",
                    folder=self.folder)
                run(PROGRAM, "smooth", "in.vtu", "-m", "laplace", "--set", "tolerance=0", "--set", "max_iterations=2", "-o",
                    "theirs.vtu", folder=self.folder)
                mine, theirs = smoothfem.read("mine.vtu"), smoothfem.read("theirs.vtu")
                self.assertGreater(abs(mine.points - mesh.points).max(), 1e-3)
                np.testing.assert_allclose(mine.points, theirs.points, rtol=0, atol=1e-12 * abs(mesh.points).max())

    def test_points_are_the_memory_that_is_smoothed(self):
        for elements in ("triangles", "tetrahedra"):
            mesh = distorted(elements)
            smoothfem.write(mesh, "in.vtu")
            run(PROGRAM, "smooth", "in.vtu", "-m", "python:mine.py:Addresses", "-o", "out.vtu", folder=self.folder)
            seen = json.loads(Path("addresses.json").read_text())
            self.assertEqual(len(seen), 5)
            self.assertEqual(len({place for row in seen for place in row[:2]}), 1, seen)
            self.assertEqual({row[2] for row in seen}, {len(mesh.free)})

    def test_parameters_and_returned_points(self):
        smoothfem.write(distorted("triangles"), "in.vtu")
        told = run(PROGRAM, "smooth", "in.vtu", "-m", "python:mine.py:Returning", "-o", "out.vtu", folder=self.folder).stdout
        self.assertIn("Returned points: 3 iterations", told)
        self.assertIn("has no parameter 'fractoin'; did you mean 'fraction'?", self.refused(
            "smooth", "in.vtu", "-m", "python:mine.py:Laplace", "-o", "out.vtu", "--set", "fractoin=1"))
        self.assertIn("whole number", self.refused(
            "smooth", "in.vtu", "-m", "python:mine.py:Laplace", "-o", "out.vtu", "--set", "unused=1.5"))

    def test_cheats_are_refused(self):
        smoothfem.write(distorted("triangles"), "in.vtu")
        for name, sentence in {**CHEATS, **NO_SMOOTHERS}.items():
            with self.subTest(name):
                self.assertRegex(self.refused("smooth", "in.vtu", "-m", f"python:mine.py:{name}", "-o", "out.vtu"), sentence)
                self.assertFalse(Path("out.vtu").exists())

    def test_current_folder_and_process_stay(self):
        mesh = distorted("triangles")
        for name in ("GoesElsewhere", "Forks"):
            smoothfem.write(mesh, "in.vtu")
            outcome = run(PROGRAM, "smooth", "in.vtu", "-m", f"python:mine.py:{name}", "-o", "out.vtu", folder=self.folder)
            self.assertEqual(outcome.stdout.count("written to"), 1, outcome.stdout)
            np.testing.assert_array_equal(smoothfem.read("out.vtu").points, mesh.points)
            Path("out.vtu").unlink()

    def test_interrupted_in_a_step(self):
        smoothfem.write(distorted("triangles"), "in.vtu")
        with subprocess.Popen([PROGRAM, "smooth", "in.vtu", "-m", "python:mine.py:Sleeps", "-o", "out.vtu", "--log", "rows.csv"],
                              stderr=subprocess.PIPE, text=True) as process:
            while not Path("asleep").exists() and process.poll() is None:
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
            began = time.monotonic()
            errors = process.communicate(timeout=60)[1]
        self.assertLess(time.monotonic() - began, 5.0)
        self.assertEqual(process.returncode, 130, errors)
        self.assertRegex(errors, "^Interrupted: no mesh is written; the rows so far are in rows.csv")
        self.assertEqual(len(Path("rows.csv").read_text().splitlines()), 4)  # headings, the initial mesh, two steps
        self.assertFalse(Path("out.vtu").exists())

    def test_files_that_are_none(self):
        smoothfem.write(distorted("triangles"), "in.vtu")
        Path("broken.py").write_text("class Mine:\n    def step(self, mesh:\n")
        for method, sentence in (("python:broken.py:Mine", r"broken.py:2: SyntaxError"), ("python:other.py:Mine", "No such file"),
                                 ("python:mine.py", "write python:FILE:NAME"), ("pyhton:mine.py:Mine", "there is no method")):
            with self.subTest(method):
                self.assertRegex(self.refused("smooth", "in.vtu", "-m", method, "-o", "out.vtu"), sentence)

    def test_what_python_needs(self):
        smoothfem.write(distorted("triangles"), "in.vtu")
        words = ("smooth", "in.vtu", "-m", "python:mine.py:Laplace", "-o", "out.vtu")
        (self.folder / "other").mkdir()
        (self.folder / "other" / "numpy.py").write_text("raise ImportError('this one is broken')\n")
        self.assertRegex(self.refused(*words, PYTHONPATH=self.folder / "other"), "this one is broken.*python3-numpy")
        # The interpreter prints its report before the message.
        outcome = run(PROGRAM, *words, folder=self.folder, check=False, PYTHONHOME="/nonexistent")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("smoothfem: Python cannot be started", outcome.stderr.splitlines()[-1])

    def test_only_who_asks_for_it_loads_python(self):
        smoothfem.write(distorted("triangles"), "in.vtu")

        def libraries(method):
            return run(PROGRAM, "smooth", "in.vtu", "-m", method, "-o", "out.vtu", folder=self.folder, LD_DEBUG="files").stderr

        self.assertNotIn("libpython", libraries("smart-laplace"))
        self.assertIn("libpython", libraries("python:mine.py:Returning"))

    def test_odt_raises_quality(self):
        for elements in ("triangles", "tetrahedra"):
            mesh = distorted(elements)
            smoothfem.write(mesh, "in.vtu")
            run(PROGRAM, "smooth", "in.vtu", "-m", f"python:{EXAMPLES / 'odt.py'}:OptimalDelaunay", "-o", "out.vtu",
                folder=self.folder)
            self.assertGreater(smoothfem.summary(smoothfem.read("out.vtu")).q_mean, smoothfem.summary(mesh).q_mean + 0.05)
        smoothfem.write(distorted("hexahedra"), "in.vtu")
        self.assertRegex(self.refused("smooth", "in.vtu", "-m", f"python:{EXAMPLES / 'odt.py'}:OptimalDelaunay", "-o", "o.vtu"),
                         r"odt.py:\d+: ValueError: meshes of triangles or tetrahedra only, but there is a hexahedron")


class InStudies(InAFolder):
    def setUp(self):
        super().setUp()
        (self.folder / "smoothers").mkdir()
        (self.folder / "mine.py").rename(self.folder / "smoothers" / "mine.py")

    def test_in_the_plane_and_in_space(self):
        for dim, elements, solution in ((2, "quadrilaterals", "gear"), (3, "tetrahedra", next(iter(smoothfem.problems(3))))):
            with self.subTest(elements):
                domain, edge_scale, q_mean = MESHES[elements]
                (self.folder / "my.prm").write_text(STUDY.format(**locals()))
                (self.folder / "elsewhere").mkdir(exist_ok=True)
                os.chdir(self.folder / "elsewhere")
                results = smoothfem.Study(self.folder / "my.prm").run(self.folder / f"results{dim}")
                os.chdir(self.folder)
                self.assertEqual(sorted(set(results.summary.method.dropna())), ["initial", "laplace", "mine"])
                rows = results.iterations.query("method == 'mine'")
                self.assertEqual(list(rows.iteration), list(range(len(rows))))
                self.assertTrue((rows.status == "ok").all() and (rows.stage[1:] == "Laplace").all())
                self.assertGreater(rows.q_mean.iloc[-1], rows.q_mean.iloc[0])
                self.assertTrue((rows.cg_iterations > 0).all())

    def test_several_processes(self):
        """The root process smooths, and all processes solve."""
        domain, edge_scale, q_mean = MESHES["tetrahedra"]
        (self.folder / "my.prm").write_text(STUDY.format(
            dim=3, domain=domain, elements="tetrahedra", edge_scale=edge_scale, q_mean=q_mean,
            solution=next(iter(smoothfem.problems(3)))))
        alone = smoothfem.Study("my.prm").run("alone")
        run("mpirun", "--quiet", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1", "-np", 2, PROGRAM,
            "study", "my.prm", "--out", "together", "--quiet", folder=self.folder, OMPI_ALLOW_RUN_AS_ROOT=1,
            OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1)
        together = smoothfem.Results("together")
        self.assertEqual(together.provenance["machine"]["ranks"], 2)
        for column in ("method", "q_min", "q_mean", "n_dofs"):
            self.assertTrue(together.iterations[column].equals(alone.iterations[column]), column)

    def test_provenance(self):
        domain, edge_scale, q_mean = MESHES["triangles"]
        text = STUDY.format(dim=2, domain=domain, elements="triangles", edge_scale=edge_scale, q_mean=q_mean, solution="gear")
        (self.folder / "my.prm").write_text(text)
        results = smoothfem.Study("my.prm").run("out")
        method = next(entry for entry in results.provenance["methods"] if entry["name"] == "mine")
        self.assertEqual(method["type"], "python:mine.py:Laplace")
        content = (self.folder / "smoothers" / "mine.py").read_bytes()
        self.assertEqual(method["files"], [{"name": "mine.py", "sha256": hashlib.sha256(content).hexdigest()}])
        self.assertEqual(method["parameters"]["fraction"], 0.5)
        self.assertNotIn(str(self.folder), (self.folder / "out" / "provenance.json").read_text())
        (self.folder / "smoothers" / "mine.py").write_text(SMOOTHERS + "\n# changed\n")
        again = smoothfem.Study("my.prm").run("out")
        method = next(entry for entry in again.provenance["methods"] if entry["name"] == "mine")
        self.assertNotEqual(method["files"][0]["sha256"], hashlib.sha256(content).hexdigest())

    def test_refused_with_the_file_of_the_study(self):
        domain, edge_scale, q_mean = MESHES["triangles"]
        text = STUDY.format(dim=2, domain=domain, elements="triangles", edge_scale=edge_scale, q_mean=q_mean, solution="gear")
        for old, new, sentence in (("mine.py:Laplace", "mine.py:Laplac", "my.prm: smoothers/mine.py has no class 'Laplac'"),
                                   ("set fraction = 0.5", "set fractoin = 0.5", "did you mean 'fraction'"),
                                   ("mine.py:Laplace", "mine.py:Raises", "has no entry|fraction")):
            (self.folder / "my.prm").write_text(text.replace(old, new))
            with self.subTest(new), self.assertRaisesRegex(smoothfem.InputError, sentence):
                smoothfem.Study("my.prm").run("out")


if __name__ == "__main__":
    unittest.main()
