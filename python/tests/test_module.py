# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the Python module: quality, smoothing, finite elements, lists of available names, and the code of the manual."""

import contextlib
import io
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import xml.etree.ElementTree
from pathlib import Path

import numpy as np

from .built import MESHES, PROGRAM, QUADRILATERALS, SOURCE, SQUARE, address, distorted, run, smoothfem


class QualityAndDistortion(unittest.TestCase):
    def test_quality_of_cells_and_meshes(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        np.testing.assert_allclose(smoothfem.quality(mesh), 1.0)
        np.testing.assert_allclose(smoothfem.quality(mesh, "size"), 1.0)
        mesh.points[4] = 2.5, 2.5
        summary, cells = smoothfem.summary(mesh), smoothfem.quality(mesh)
        self.assertEqual((summary.q_min, summary.n_invalid), (0.0, np.count_nonzero(cells <= 0)))
        self.assertAlmostEqual(summary.q_mean, cells.mean(), 15)
        self.assertRegex(repr(summary), r"^Quality\(q_min=0, ")
        with self.assertRaisesRegex(smoothfem.InputError, "did you mean 'mean_ratio'"):
            smoothfem.quality(mesh, "mean_rato")
        with self.assertRaisesRegex(smoothfem.InputError, "one metric"):
            smoothfem.quality(mesh, "all")

    def test_every_metric(self):
        mesh = smoothfem.Mesh([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0]], [[0, 1, 2, 3], [1, 4, 2]])
        for name, facts in smoothfem.metrics().items():
            with self.subTest(name):
                values = smoothfem.quality(mesh, name)
                self.assertEqual(values.shape, (2,))
                if facts["ideal"] is not None and not name.endswith(("size_squared", "gradation")):
                    self.assertAlmostEqual(values[0], facts["ideal"])
        np.testing.assert_array_equal(smoothfem.quality(mesh, "size_gradation"), 2.0)
        self.assertTrue(np.isnan(smoothfem.quality(mesh, "stretch")[1]))  # quadrilaterals and hexahedra only
        self.assertFalse(smoothfem.metrics()["edge_ratio"]["larger_is_better"])

    def test_distortion(self):
        mesh = smoothfem.generate("gear", elements="triangles", edge_scale=4)
        where, before = address(mesh), mesh.points.copy()
        self.assertAlmostEqual(smoothfem.distort(mesh, 0.5), 0.5, 3)
        self.assertAlmostEqual(smoothfem.summary(mesh).q_mean, 0.5, 3)
        self.assertEqual(address(mesh), where)
        np.testing.assert_array_equal(mesh.points[mesh.fixed], before[mesh.fixed])
        after = mesh.points.copy()
        for refused in ({"q_mean": 2.0}, {}, {"q_mean": 0.5, "radius": 0.1}, {"q_mean": 0.4, "kind": "none"}):
            with self.subTest(refused), self.assertRaises(smoothfem.InputError):
                smoothfem.distort(mesh, **refused)
        np.testing.assert_array_equal(mesh.points, after)
        reached = smoothfem.distort(mesh, radius=0.9, sweeps=3)
        self.assertLess(reached, 0.45)
        self.assertEqual(smoothfem.summary(mesh).q_mean, reached)

    def test_generated_as_by_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            run(PROGRAM, "generate", "gear", "-o", "g.vtu", "--elements", "quadrilaterals", "--edge-scale", "3",
                "--distort-to", "0.5", folder=folder)
            theirs = smoothfem.read(Path(folder) / "g.vtu")
        np.testing.assert_array_equal(theirs.points, distorted("quadrilaterals").points)
        with self.assertRaisesRegex(smoothfem.InputError, "did you mean 'gear'"):
            smoothfem.generate("gaer")


class StudiesAsDicts(unittest.TestCase):
    def test_are_files_of_the_program(self):
        keys = {"meshes": "m", "methods": ["laplace", "getme"], "degrees": [1], "mesh m": {"file": Path("m.vtu")}, "solution": {"u": "x*y"},
                "record initial": None}
        self.addCleanup(os.chdir, os.getcwd())
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            smoothfem.write(distorted("triangles"), "m.vtu")
            study = smoothfem.Study(keys, name="mine")
            self.assertEqual((repr(study), study.name), ("<smoothfem.Study: mine.prm>", "mine"))
            study.write()
            self.assertEqual(Path("mine.prm").read_text().splitlines()[1:4], ["set meshes = m", "set methods = laplace, getme", "set degrees = 1"])
            self.assertEqual(smoothfem.Study(keys, name="mine").run().summary["method"].tolist(), ["initial", "laplace", "getme"])
            with self.assertRaisesRegex(smoothfem.InputError, r"bad\.prm:3: there is no key 'methodz' here; did you mean 'methods'"):
                smoothfem.Study({"meshes": "m", "methodz": "getme"}, name="bad").run()
            Path("own.prm").write_text("set meshes = m\n")
            with self.assertRaisesRegex(smoothfem.InputError, "was not written by smoothfem.Study"):
                smoothfem.Study(keys, name="own").write()

    def test_refusals_are_sentences(self):
        for sentence, call in (("the study is 3", lambda: smoothfem.Study(3)), ("name is 'a b'", lambda: smoothfem.Study({}, name="a b")),
                               ("is not a key", lambda: smoothfem.Study({1: 2})), ("'solution / u' has a line break", lambda: smoothfem.Study(
                                   {"solution": {"u": "x\ny"}})), ("scale is 3", lambda: smoothfem.Study("gear", 3)),
                               ("'solution / u' is 1j, but has to be a text, a number", lambda: smoothfem.Study({"solution": {"u": 1j}})),
                               ("'solution' is {'u': 'x'}, but has to be a text", lambda: smoothfem.Study({"solution": [{"u": "x"}]})),
                               ("'degrees' is b'12', but", lambda: smoothfem.Study({"degrees": [1, b"12"]}))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                call()


class WhatThereIs(unittest.TestCase):
    def test_version(self):
        self.assertIn(smoothfem.__version__, run(PROGRAM, "--version", folder=".").stdout)

    def test_arguments_of_wrong_types_are_sentences(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        for sentence, call in (
                ("edge_scale is 'x', but has to be a number", lambda: smoothfem.generate("gear", edge_scale="x")),
                ("seed is -1", lambda: smoothfem.generate("gear", seed=-1)), ("domain is None", lambda: smoothfem.generate(None)),
                ("path is 3", lambda: smoothfem.read(3)), ("metric is 3", lambda: smoothfem.quality(mesh, 3)),
                ("mesh is 'm', but has to be a smoothfem.Mesh", lambda: smoothfem.summary("m")),
                ("q_mean is 'x'", lambda: smoothfem.distort(mesh, "x")), ("threads is 1.5", lambda: smoothfem.smooth(mesh, "getme", threads=1.5)),
                (r"cell\['q'\] has the shape \(1,\)", lambda: smoothfem.write(mesh, "m.vtu", cell={"q": [1.0]})),
                ("cell is 3", lambda: smoothfem.write(mesh, "m.vtu", cell=3)), ("dim is 'x'", lambda: smoothfem.problems("x"))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                call()

    def test_unknown_arguments_of_smooth_have_the_nearest_name(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        for sentence, call in (
                ("^smooth needs a method: a name of methods", lambda: smoothfem.smooth(mesh)),
                (r"^smooth\(\) has no argument 'the_method'; did you mean 'method'\?$", lambda: smoothfem.smooth(mesh, the_method="getme")),
                (r"^smooth\(\) has no argument 'boundaryy', .* did you mean 'boundary'\?$", lambda: smoothfem.smooth(mesh, "getme", boundaryy="slide")),
                ("did you mean 'tolerance'", lambda: smoothfem.smooth(mesh, "laplace", tolerence=0.1)),
                ("did you mean 'sequential.patience'", lambda: smoothfem.smooth(mesh, "getme", sequential={"patence": 3})),
                ("no parameter 'quux'; it has ", lambda: smoothfem.smooth(mesh, "laplace", quux=1)),
                ("the parameter tolerance is None", lambda: smoothfem.smooth(mesh, "laplace", tolerance=None)),
                (r"generate\(\) has no argument 'sed'", lambda: smoothfem.generate("gear", sed=1))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                call()

    def test_methods_and_their_parameters(self):
        methods = smoothfem.methods()
        self.assertIn("planar", methods["getme"]["meshes"])
        for name, about in methods.items():
            for kind in ("planar", "volume"):
                if kind in about["meshes"]:
                    self.assertIn("description", next(iter(smoothfem.parameters(name, kind).values())))
        self.assertEqual(smoothfem.parameters("laplace")["tolerance"]["default"], 0.01)
        with self.assertRaisesRegex(smoothfem.InputError, "choose one of planar"):
            smoothfem.parameters("laplace", "flat")

    def test_domains_and_problems(self):
        self.assertIn("hexahedra", smoothfem.domains()["flange"])
        self.assertIn("gear", smoothfem.problems(2))
        self.assertTrue(smoothfem.problems(3))


class Smoothing(unittest.TestCase):
    def test_same_bits_as_the_program(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for elements in MESHES:
                mesh = distorted(elements)
                smoothfem.write(mesh, folder / "in.vtu")
                for method in ("getme", "smart-laplace"):
                    with self.subTest(elements=elements, method=method):
                        told = run(PROGRAM, "smooth", "in.vtu", "-m", method, "-o", "out.vtu", folder=folder).stdout
                        mine = mesh.copy()
                        result = smoothfem.smooth(mine, method)
                        theirs = smoothfem.read(folder / "out.vtu")
                        self.assertFalse(np.array_equal(mine.points, mesh.points))
                        np.testing.assert_array_equal(mine.points, theirs.points)
                        self.assertIn(f": {result.iterations} iterations in ", told)

    def test_result(self):
        mesh = distorted("triangles")
        where = address(mesh)
        result = smoothfem.smooth(mesh, "getme", sequential={"patience": 3}, threads=1, history=True)
        self.assertEqual(address(mesh), where)
        self.assertEqual(smoothfem._core.address(mesh), where)
        self.assertEqual([stage.name for stage in result.stages], ["simultaneous", "sequential"])
        self.assertEqual(result.iterations, "/".join(str(stage.iterations) for stage in result.stages))
        self.assertEqual(result.quality.q_mean, smoothfem.summary(mesh).q_mean)
        self.assertEqual([i.record for i in result.history], list(range(len(result.history))))
        self.assertEqual(result.history[0].stage, "initial")
        self.assertGreater(result.smoothing_seconds, 0.0)
        self.assertIn(result.quality.q_min, [i.quality.q_min for i in result.history])
        with self.assertWarnsRegex(UserWarning, "2 of 896 cells of the smoothed mesh are invalid"):
            self.assertEqual(smoothfem.smooth(mesh, "laplace").history, [])

    def test_parameters_are_the_methods_own(self):
        mesh = distorted("triangles")
        for given in ({"tolerance": 0.0, "max_iterations": np.int64(3)}, {"parameters": {"tolerance": 0.0, "max_iterations": 3}}):
            with self.assertWarns(UserWarning):
                self.assertEqual(smoothfem.smooth(mesh.copy(), "laplace", **given).iterations, "3")
        for wrong, sentence in (({"tolerance": -1}, "outside its range"), ({"tolerence": 1}, "did you mean 'tolerance'"),
                                ({"max_iterations": 2.5}, "whole number"), ({"threads": -1}, "threads is -1")):
            with self.subTest(wrong), self.assertRaisesRegex(smoothfem.InputError, sentence):
                smoothfem.smooth(mesh, "laplace", **wrong)
        with self.assertRaisesRegex(smoothfem.InputError, "there is no method"):
            smoothfem.smooth(mesh, "lapalce")
        with self.assertRaisesRegex(smoothfem.InputError, "there is no preset"):
            smoothfem.smooth(mesh, "getme", preset="none")

    def test_callback_sees_every_mesh(self):
        mesh, seen = distorted("quadrilaterals"), []
        initial = mesh.points.copy()

        def look(iteration, now):
            self.assertIs(now, mesh)
            seen.append((iteration.record, smoothfem.summary(now).q_mean == iteration.quality.q_mean, now.points.copy()))

        result = smoothfem.smooth(mesh, "smart-laplace", look, history=True)
        self.assertEqual([record for record, _, _ in seen], list(range(len(result.history))))
        self.assertTrue(all(same for _, same, _ in seen))
        np.testing.assert_array_equal(seen[0][2], initial)
        np.testing.assert_array_equal(seen[result.result_record][2], mesh.points)

    def test_exception_of_the_callback_is_passed_on(self):
        mesh = distorted("triangles")
        seen = []

        def stop(iteration, now):
            seen.append(now.points.copy())
            if iteration.record == 2:
                raise LookupError("enough")

        with self.assertRaisesRegex(LookupError, "^'?enough"):
            smoothfem.smooth(mesh, "laplace", stop)
        self.assertEqual(len(seen), 3)
        np.testing.assert_array_equal(mesh.points, seen[-1])

    def test_ctrl_c_ends_it(self):
        mesh = distorted("tetrahedra")
        # A test that runs in the background may inherit a setting that ignores the signal.
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        with self.assertRaises(KeyboardInterrupt):
            threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
            # Without the interrupt this would take hours.
            smoothfem.smooth(mesh, "laplace", tolerance=0.0, max_iterations=10**9)

    def test_ctrl_c_ends_solving_and_distorting(self):
        mesh = smoothfem.generate("gear", elements="triangles", edge_scale=1)
        self.addCleanup(signal.signal, signal.SIGINT, signal.signal(signal.SIGINT, signal.default_int_handler))
        # Without the interrupt the first call would take minutes, the second one hours.
        for call in (lambda: [smoothfem.solve(mesh, "gear", 2) for _ in range(1000)],
                     lambda: smoothfem.distort(mesh, 0.4, candidates=10**7)):
            with self.assertRaises(KeyboardInterrupt):
                threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
                call()

    def test_names_of_files_may_have_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.fsdecode(os.fsencode(folder) + b"/bin\xff.vtk")
            smoothfem.write(smoothfem.Mesh(SQUARE, QUADRILATERALS), path)
            self.assertEqual(len(smoothfem.read(path).points), 9)
            with self.assertRaisesRegex(smoothfem.InputError, "there is no such file"):
                smoothfem.read(path.replace("bin", "other"))

    def test_names_of_fields_are_escaped(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "out.vtu"
            mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
            smoothfem.write(mesh, path, cell={"<a&\"b>": [1.0] * 4})
            names = [entry.get("Name") for entry in xml.etree.ElementTree.parse(path).iter("DataArray")]
            self.assertIn("<a&\"b>", names)
            np.testing.assert_array_equal(smoothfem.read(path).points, mesh.points)
            with self.assertRaisesRegex(smoothfem.InputError, "control character"):
                smoothfem.write(mesh, path, cell={"a\nb": [1.0] * 4})

    def test_other_threads_run_meanwhile(self):
        # One thread smooths for hours. If it kept the GIL, the other thread could not report.
        code = """
import os, threading, time
from python.tests.test_module import distorted, smoothfem
mesh = distorted("tetrahedra")
threading.Thread(target=smoothfem.smooth, args=(mesh, "laplace"),
                 kwargs={"tolerance": 0.0, "max_iterations": 10**9}, daemon=True).start()
time.sleep(0.5)
print("my turn", flush=True)
os._exit(0)
"""
        ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
        self.assertEqual((ended.returncode, ended.stdout), (0, "my turn\n"), ended.stderr)

    def test_refuses_what_cannot_be_smoothed(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        mesh.points[4] = np.nan, 1.0
        with self.assertRaisesRegex(smoothfem.InputError, "node 4"):
            smoothfem.smooth(mesh, "laplace")
        mesh.points[4] = 2.5, 2.5
        with self.assertRaisesRegex(smoothfem.InputError, "invalid"):
            smoothfem.smooth(mesh, "getme")
        with self.assertRaisesRegex(smoothfem.InputError, "a name, a class or object with step"):
            smoothfem.smooth(mesh, 3)


class Solving(unittest.TestCase):
    def test_known_solution(self):
        mesh = smoothfem.generate("gear", elements="triangles", edge_scale=4)
        linear, quadratic = (smoothfem.solve(mesh, ("x^2 + y", "2*x ; 1", "-2"), degree, cg_tolerance=1e-13)
                             for degree in (1, 2))
        self.assertTrue(linear["cg_converged"] and linear["status"] == "ok")
        self.assertGreater(linear["l2_error"], 1e-6)
        self.assertLess(quadratic["l2_error"], 1e-9 * linear["l2_error"])  # u is in the finite element space
        self.assertGreater(linear["condition_number"], 1.0)

    def test_in_space(self):
        mesh = smoothfem.generate("flange", elements="tetrahedra", edge_scale=4)
        record = smoothfem.solve(mesh, next(iter(smoothfem.problems(3))), condition_number="lanczos", multigrid=True)
        self.assertTrue(record["cg_converged"])
        self.assertLess(record["amg_cg_iterations"], record["cg_iterations"])

    def test_refusals(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        for sentence, words in (("degree 3", ("gear", 3)), ("there is no", ("gaer",))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                smoothfem.solve(mesh, *words)
        mesh.points[4] = 2.5, 2.5
        with self.assertRaisesRegex(smoothfem.InputError, "invalid"):
            smoothfem.solve(mesh, "gear")


class Manual(unittest.TestCase):
    def test_lines_do_what_they_say(self):
        text = (SOURCE / "docs" / "how-to" / "python.md").read_text(encoding="utf-8")
        code = next(code for code in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "import smoothfem" in code)
        self.addCleanup(os.chdir, os.getcwd())
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            names = {}
            with contextlib.redirect_stdout(io.StringIO()) as told:
                exec(compile(code, "python.md", "exec"), names)  # the text is part of this repository
            np.testing.assert_array_equal(smoothfem.read("out.vtu").points, names["mesh"].points)
        self.assertRegex(told.getvalue(), r"^\d+/\d+ Quality\(q_min=0\.\d")


if __name__ == "__main__":
    unittest.main()
