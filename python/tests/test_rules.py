# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests the options of smooth(): which nodes move, untangling, targets, warnings; objects and functions as smoothers."""

import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

from .built import PROGRAM, QUADRILATERALS, SQUARE, distorted, grid, run, smoothfem


def moved(mesh, before):
    """Returns the numbers of the nodes that have moved."""
    return set(np.flatnonzero((mesh.points != before.points).any(axis=1)).tolist())


def tangled():
    """Returns a mesh of triangles with some nodes far away."""
    mesh = distorted("triangles")
    mesh.points[mesh.free[:9]] += 2.0
    return mesh


class Nodes(unittest.TestCase):
    def test_fix_adds_to_the_nodes_that_stay(self):
        before = distorted("triangles")
        flags = np.arange(before.n_nodes) % 2 == 0
        for fix, stay in ((before.free[:20], before.free[:20]), (before.free[:20].tolist(), before.free[:20]), (flags, np.flatnonzero(flags))):
            mesh = before.copy()
            smoothfem.smooth(mesh, "getme", fix=fix)
            self.assertTrue(moved(mesh, before))
            self.assertFalse(moved(mesh, before) & ({*stay.tolist()} | {*before.fixed.tolist()}))
            np.testing.assert_array_equal(mesh.free, before.free)

    def test_same_bits_as_the_options_of_the_command(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for source, words, options in (
                    (distorted("triangles"), {"boundary": "slide"}, ["--boundary", "slide"]),
                    (distorted("quadrilaterals"), {"only_below": 0.3, "rings": 1}, ["--only-below", "0.3", "--rings", "1"]),
                    (distorted("triangles"), {"fix": "free"}, ["--fix", "free"]),
                    (distorted("triangles"), {"target": "initial-size"}, ["--target", "initial-size"]),
                    (tangled(), {"untangle": True}, ["--untangle"])):
                with self.subTest(words):
                    smoothfem.write(source, folder / "in.vtu")
                    run(PROGRAM, "smooth", "in.vtu", "-m", "getme", "-o", "out.vtu", *options, folder=folder)
                    mesh = source.copy()
                    smoothfem.smooth(mesh, "getme", allow_worse=False, **words)
                    np.testing.assert_array_equal(mesh.points, smoothfem.read(folder / "out.vtu").points)

    def test_another_mesh_as_target(self):
        goal, mesh = grid("triangles"), grid("triangles")
        goal.points[:, 0] *= 3
        mesh.points[:, 0] *= 3
        mesh.points[mesh.free] += np.random.default_rng(2).uniform(-0.1, 0.1, (len(mesh.free), 2))
        result = smoothfem.smooth(mesh, "getme", target=goal)
        self.assertGreater(result.quality.q_mean, 0.98)
        self.assertLess(smoothfem.summary(mesh).q_mean, 0.8)

    def test_untangling_is_noted(self):
        result = smoothfem.smooth(tangled(), "getme", untangle=True)
        self.assertRegex(result.notes[0], r"^untangled \d+ invalid cells in ")
        self.assertEqual((result.quality.n_invalid, result.warnings), (0, []))

    def test_warns_of_invalid_cells(self):
        with self.assertWarnsRegex(UserWarning, "2 of 896 cells of the smoothed mesh are invalid; choose"):
            result = smoothfem.smooth(distorted("triangles"), "laplace")
        self.assertEqual(len(result.warnings), 1)
        mesh = distorted("triangles")
        with self.assertWarnsRegex(UserWarning, "allow_worse=True"):
            smoothfem.smooth(mesh, "laplace", allow_worse=False)
        self.assertEqual(smoothfem.summary(mesh).n_invalid, 0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            smoothfem.smooth(mesh, "getme")

    def test_messages_name_arguments(self):
        mesh = distorted("triangles")
        for sentence, words in (("raise only_below", {"only_below": 0}), ("only_below is 2, but", {"only_below": 2}),
                                ("only_below is 'x'", {"only_below": "x"}), ("slide_distance is for 'boundary=\"slide\"'", {"slide_distance": 0.1}),
                                ("no boundary group is called 'wall'", {"fix": "wall"}), ("fix has the node number", {"fix": [10**6]}),
                                ("fix is 3", {"fix": 3}), ("fix is an array", {"fix": [0.5]}), ("boundary is 3", {"boundary": 3}),
                                ("there is no boundary 'free'", {"boundary": "free"}), ("leave out periodic", {"periodic": "smooth"}),
                                ("keep_layers", {"keep_layers": 3}), ("callback is 3", {"callback": 3}), ("parameters is 3", {"parameters": 3}),
                                ("other cells than", {"target": smoothfem.Mesh(SQUARE, QUADRILATERALS)})):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                smoothfem.smooth(mesh, "getme", **words)
        with self.assertRaisesRegex(smoothfem.InputError, r"untangle the mesh first \(untangle\)|\(untangle\)"):
            smoothfem.smooth(tangled(), "getme")


class Spring:
    """Each free node moves to the mean of its neighbours."""

    parameters = {"part": (1.0, "of the way")}
    tolerance = -1.0

    def __init__(self, part):
        self.part, self.n_steps = part, 0

    def step(self, mesh):
        self.n_steps += 1
        offsets, nodes = mesh.node_neighbours
        for i in mesh.free:
            mesh.points[i] += self.part * (mesh.points[nodes[offsets[i]:offsets[i + 1]]].mean(axis=0) - mesh.points[i])


class OwnSmoothers(unittest.TestCase):
    def test_object(self):
        meshes = [distorted("triangles"), distorted("triangles"), distorted("triangles")]
        spring = Spring(0.5)
        self.assertEqual(smoothfem.smooth(meshes[0], spring, max_iterations=2).iterations, "2")
        self.assertEqual(spring.n_steps, 2)
        smoothfem.smooth(meshes[1], Spring(0.1), part=0.5, max_iterations=2)
        np.testing.assert_array_equal(meshes[0].points, meshes[1].points)
        smoothfem.smooth(meshes[2], Spring(0.1), max_iterations=2)
        self.assertFalse(np.array_equal(meshes[0].points, meshes[2].points))

    def test_functions_return_points_or_change_them(self):
        def relax(mesh):
            points = mesh.points.copy()
            points[mesh.free] += 1e-6
            return points

        def in_place(mesh):
            mesh.points[mesh.free] += 1e-6

        relax.max_iterations, relax.tolerance = 3, -1.0
        meshes = [distorted("triangles"), distorted("triangles")]
        self.assertEqual(smoothfem.smooth(meshes[0], relax).iterations, "3")
        result = smoothfem.smooth(meshes[1], lambda mesh: in_place(mesh), max_iterations=3, tolerance=-1)
        self.assertEqual((result.iterations, result.method), ("3", "python:lambda"))
        np.testing.assert_array_equal(meshes[0].points, meshes[1].points)

    def test_mistakes_are_sentences(self):
        mesh = distorted("triangles")
        for sentence, method in (("moved the fixed node 0", lambda mesh: mesh.points + 1), ("has to be a name, a class or object", [1]),
                                 (r"fails: step failed: test_rules|step failed: .*ZeroDivisionError", lambda mesh: 1 / 0),
                                 ("shape", lambda mesh: mesh.points[:3])):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                smoothfem.smooth(mesh, method)


if __name__ == "__main__":
    unittest.main()
