# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests solve(): formulas, diffusivities and natural groups as in studies; the nodal solution and its errors."""

import json
import sys
import unittest

import numpy as np

from plots.results.rows import read_rows

from .built import PROGRAM, QUADRILATERALS, SOURCE, SQUARE, distorted, grid, run, smoothfem
from .test_meshes import Block, Foreign


def two_materials():
    """Returns the unit square with the groups left (tag 1) and right (2), and the boundary groups bottom (3) and top (4)."""
    x, y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9))
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    cells = np.c_[corner, corner + 1, corner + 10, corner + 9]
    points = np.c_[x.ravel(), y.ravel()]
    tags = np.where(points[cells].mean(axis=1)[:, 0] < 0.5, 1, 2)
    low, high = np.arange(8), 72 + np.arange(8)
    return smoothfem.from_meshio(Foreign(
        points=points, cells=[Block("line", np.c_[low, low + 1]), Block("line", np.c_[high, high + 1]), Block("quad", cells)], point_data={},
        cell_data={"gmsh:physical": [np.full(8, 3), np.full(8, 4), tags]},
        field_data={"left": [1, 2], "right": [2, 2], "bottom": [3, 1], "top": [4, 1]}, cell_sets={}))


class Straightened(unittest.TestCase):
    """The table of the page on curved elements is that of its script."""

    def test_the_disc_has_the_row_of_the_page(self):
        sys.path.insert(0, str(SOURCE / "studies" / "reasons"))
        try:
            from straightened import errors_of
        finally:
            sys.path.pop(0)
        found = errors_of("disc", "triangles", 11.3)
        row = read_rows(SOURCE / "docs" / "explanation" / "curved-straightened.csv").select(domain="disc", elements="triangles").records()[0]
        for name in ("initial", "global", "curved", "straightened"):
            self.assertAlmostEqual(float(found[name]) / float(row[name]), 1, 4)
        self.assertLess(float(found["straightened"]), 0.6 * float(found["curved"]))


class Solutions(unittest.TestCase):
    def test_fields_belong_to_the_numbers(self):
        for elements, degrees in (("triangles", (1, 2)), ("tetrahedra", (1, 2)), ("hexahedra", (1,))):
            mesh = distorted(elements)
            for degree in degrees:
                with self.subTest(elements=elements, degree=degree):
                    u = "sin(x/9)*cos(y/7)"
                    found = smoothfem.solve(mesh, u=u, degree=degree, condition_number="none")
                    self.assertEqual((found.u_h.shape, found.cell_h1_error.shape), ((mesh.n_nodes,), (mesh.n_cells,)))
                    np.testing.assert_allclose(found.u, np.sin(mesh.points[:, 0] / 9) * np.cos(mesh.points[:, 1] / 7), atol=1e-14)
                    self.assertAlmostEqual(np.linalg.norm(found.cell_h1_error) / found.h1_error, 1, 12)
                    self.assertAlmostEqual(np.linalg.norm(found.cell_l2_error) / found.l2_error, 1, 12)
                    self.assertEqual(found.dof_points.shape, (found.n_dofs, mesh.spacedim))
                    nodes = {tuple(point): value for point, value in zip(found.dof_points, found.dof_values)}
                    self.assertEqual([nodes[tuple(point)] for point in mesh.points], found.u_h.tolist())
                    if degree == 1:
                        self.assertEqual(found.nodal_error.max(), found.e_max)

    def test_errors_are_those_of_the_right_cells(self):
        mesh = smoothfem.Mesh(SQUARE, [[0, 1, 4, 3], [1, 2, 4], [2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
        found = smoothfem.solve(mesh, u="if(x < 1, 0, (x-1)^3)", condition_number="none")
        self.assertLess(max(found.cell_h1_error[[0, 3]]), min(found.cell_h1_error[[2, 4]]))

    def test_result_is_also_a_dict(self):
        found = smoothfem.solve(smoothfem.Mesh(SQUARE, QUADRILATERALS), u="x*y")
        self.assertEqual(json.loads(json.dumps(found))["h1_error"], found.h1_error)
        self.assertRegex(repr(found), r"^<smoothfem.Solution: degree 1, 1 unknowns, L2 error \S+, H1 error \S+, ok>$")
        with self.assertRaisesRegex(AttributeError, "h1_error"):
            found.h2_error

    def test_nodes_without_cells_have_no_value(self):
        mesh = smoothfem.Mesh(np.vstack([SQUARE, [[9, 9]]]), QUADRILATERALS)
        self.assertEqual(np.flatnonzero(np.isnan(smoothfem.solve(mesh, u="x*y").u_h)).tolist(), [9])


class Problems(unittest.TestCase):
    def test_formula_and_its_parts_are_the_same(self):
        mesh = distorted("triangles")
        derived, given = smoothfem.solve(mesh, u="x^2 + y"), smoothfem.solve(mesh, ("x^2 + y", "2*x ; 1", "-2"))
        self.assertAlmostEqual(derived.h1_error / given.h1_error, 1, 12)

    def test_diffusivity_is_a_number_a_formula_or_a_tensor(self):
        mesh = grid("quadrilaterals")
        by = {name: smoothfem.solve(mesh, u="x^2*y", diffusivity=a, cg_tolerance=1e-12).h1_error
              for name, a in (("none", None), ("number", 3), ("formula", "3"), ("tensor", np.diag([3.0, 3.0])), ("texts", [["3", 0], [0, "3"]]))}
        for name, error in by.items():
            self.assertAlmostEqual(error / by["none"], 1, 8, name)
        skew = smoothfem.solve(mesh, u="x + 2*y", diffusivity=[[2, "1/2"], ["1/2", "1+x^2"]], cg_tolerance=1e-12)
        self.assertLess(skew.h1_error, 1e-9)

    def test_groups_and_natural_boundaries(self):
        mesh = two_materials()
        u = "if(x < 1/2, 2*(x - 1/2), x - 1/2)"  # continuous flux: 1 * 2 = 2 * 1
        for diffusivity in ({"left": 1, "right": 2}, {1: 1, None: 2}):
            for natural in ((), "top", ["bottom", 4], [3, 4]):
                with self.subTest(diffusivity=diffusivity, natural=natural):
                    found = smoothfem.solve(mesh, u=u, diffusivity=diffusivity, natural=natural, cg_tolerance=1e-12)
                    self.assertLess(found.h1_error, 1e-9)
                    self.assertEqual(found.n_free, 49 + 7 * {(): 0, "top": 1}.get(natural if isinstance(natural, (str, tuple)) else "", 2))
        with self.assertRaisesRegex(smoothfem.InputError, "jumps|continuous"):
            smoothfem.solve(mesh, u=u, diffusivity={"left": 1, "right": 3})

    def test_same_numbers_as_a_study(self):
        import tempfile
        from pathlib import Path
        with tempfile.TemporaryDirectory() as folder:
            study = ("set meshes = m\nset methods = laplace\nset degrees = 1\nsubsection mesh m\n set file = m.vtu\nend\n"
                     "subsection solution\n set u = sin(x/9)*y\n set diffusivity = 1+x^2\nend\n")
            (Path(folder) / "s.prm").write_text(study)
            mesh = distorted("triangles")
            smoothfem.write(mesh, Path(folder) / "m.vtu")
            run(PROGRAM, "study", "s.prm", "--out", "r", "--quiet", folder=folder)
            row = smoothfem.Results(Path(folder) / "r").iterations.iloc[0]
        found = smoothfem.solve(mesh, u="sin(x/9)*y", diffusivity="1+x^2")
        self.assertEqual(row.cg_iterations, found.cg_iterations)
        self.assertAlmostEqual(row.h1_error / found.h1_error, 1, 14)  # pandas rounds


class Refusals(unittest.TestCase):
    def test_are_sentences(self):
        mesh = smoothfem.Mesh(SQUARE, QUADRILATERALS)
        for sentence, call in (
                ("needs a formula u or a problem", lambda: smoothfem.solve(mesh)),
                ("and not both", lambda: smoothfem.solve(mesh, "gear", u="x")),
                ("u is a function, but f", lambda: smoothfem.solve(mesh, u=lambda x, y: x)),
                ("problem is a function, but f", lambda: smoothfem.solve(mesh, lambda x, y: x)),
                (r"solve\(mesh, u='sin\(x\)\*y'\)", lambda: smoothfem.solve(mesh, "sin(x)*y")),
                ("ends too early", lambda: smoothfem.solve(mesh, u="sin(x")),
                ("u is None|needs a formula", lambda: smoothfem.solve(mesh, u=None)),
                ("u is an object of the type dict|u is {}", lambda: smoothfem.solve(mesh, u={})),
                ("diffusivity is True", lambda: smoothfem.solve(mesh, u="x", diffusivity=True)),
                ("tensor as rows", lambda: smoothfem.solve(mesh, u="x", diffusivity=[1, 2])),
                ("diffusivity needs a formula u", lambda: smoothfem.solve(mesh, "gear", diffusivity=2)),
                ("no boundary group is called 'wall'", lambda: smoothfem.solve(mesh, u="x", natural="wall")),
                ("a group of natural is 1.5", lambda: smoothfem.solve(mesh, u="x", natural=[1.5])),
                ("no cell of the mesh has", lambda: smoothfem.solve(mesh, u="x", diffusivity={"steel": 2})),
                ("degree is 'one'", lambda: smoothfem.solve(mesh, u="x", degree="one")),
                ("not solved on surface", lambda: smoothfem.solve(smoothfem.generate("roof", edge_scale=3), u="x")),
                (r"^solve\(\) has no argument 'difusivity'; did you mean 'diffusivity'\?$", lambda: smoothfem.solve(mesh, u="x", difusivity=2)),
                (r"^solve\(\) has no argument 'foo'; it has mesh, problem, ", lambda: smoothfem.solve(mesh, u="x", foo=2)),
                ("has to be a smoothfem.Mesh", lambda: smoothfem.solve([1], u="x"))):
            with self.subTest(sentence), self.assertRaisesRegex(smoothfem.InputError, sentence):
                call()


if __name__ == "__main__":
    unittest.main()
