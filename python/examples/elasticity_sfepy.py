# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear elasticity by sfepy, on triangles, quadrilaterals, tetrahedra or hexahedra: a solver for studies.

The displacement is given on the whole boundary; there is no load inside. Planar problems are in plane strain.
Needs python3-sfepy, a Debian package."""

import numpy as np
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Function, Integral, Integrals, Material, Problem
from sfepy.discrete.conditions import Conditions, EssentialBC
from sfepy.discrete.fem import FEDomain, Field, Mesh
from sfepy.mechanics.matcoefs import stiffness_from_youngpoisson
from sfepy.solvers.ls import ScipyDirect
from sfepy.solvers.nls import Newton
from sfepy.terms import Term


class ElasticitySfepy:
    parameters = {"E": (1.0, "Young's modulus"), "nu": (0.3, "Poisson's ratio"), "bend": (0.1, "size of the given displacement")}
    numbers = {"energy": ("", "Square of the energy norm of the displacement."),
               "u_max": ("", "Largest displacement of a node.")}
    degrees = [1, 2]
    gives_matrix = True  # condition number, CG and multigrid are then recorded

    def initialize(self, mesh):
        """Keeps the cells. Both programs order the nodes of a cell in the same way."""
        if isinstance(mesh.cells, tuple):
            raise ValueError("the mesh has cells of several types; this solver takes one")
        self.cells = np.asarray(mesh.cells, dtype=np.int32)

    def solve(self, mesh):
        """Returns the numbers of one mesh."""
        output.set_output(quiet=True)
        dim, n_corners = mesh.points.shape[1], self.cells.shape[1]
        domain = FEDomain("domain", Mesh.from_data("mesh", np.array(mesh.points), None, [self.cells],
                                                   [np.zeros(len(self.cells), dtype=np.int32)], [f"{dim}_{n_corners}"]))
        omega = domain.create_region("Omega", "all")
        boundary = domain.create_region("Boundary", "vertices of surface", "facet")

        field = Field.from_args("displacement", np.float64, "vector", omega, approx_order=self.degree)
        u = FieldVariable("u", "unknown", field)
        v = FieldVariable("v", "test", field, primary_var_name="u")
        material = Material("m", D=stiffness_from_youngpoisson(dim, self.E, self.nu, plane="strain"))
        integral = Integral("i", order=2 * self.degree + 1)
        stiffness = Term.new("dw_lin_elastic(m.D, v, u)", integral, omega, m=material, v=v, u=u)

        problem = Problem("elasticity", equations=Equations([Equation("balance", stiffness)]))
        given = EssentialBC("given", boundary, {"u.all": Function("given", self.given)})
        problem.set_bcs(ebcs=Conditions([given]))
        problem.set_solver(Newton({"i_max": 1}, lin_solver=ScipyDirect({})))
        state = problem.solve(save_results=False, verbose=False)
        energy = problem.evaluate("dw_lin_elastic.i.Omega(m.D, u, u)", m=material, u=u, integrals=Integrals([integral]))
        return {"energy": energy, "u_max": np.linalg.norm(state().reshape(-1, dim), axis=1).max(),
                "matrix": problem.mtx_a, "right_hand_side": problem.mtx_a @ state.get_reduced()}

    def given(self, ts, x, **_):
        """The displacement at points of the boundary. It solves the equations inside, too, for any E and nu."""
        u = np.zeros_like(x)
        u[:, 0] = self.bend * (x[:, 0] ** 2 - x[:, 1] ** 2)
        u[:, 1] = -2 * self.bend * x[:, 0] * x[:, 1]
        return u
