# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear elasticity by DOLFINx 0.5 (FEniCS), on triangles, quadrilaterals, tetrahedra or hexahedra: a solver for studies.

The displacement is given on the whole boundary; there is no load inside. Planar problems are in plane strain.
Needs python3-dolfinx, a Debian package."""

import logging

import numpy as np
import scipy.sparse as sp
import ufl
from dolfinx import cpp, fem
from dolfinx.fem import assemble_scalar
from dolfinx.mesh import create_mesh, exterior_facet_indices, to_type
from mpi4py import MPI

NAMES = {(2, 3): "triangle", (2, 4): "quadrilateral", (3, 4): "tetrahedron", (3, 8): "hexahedron"}


class ElasticityDolfinx:
    parameters = {"E": (1.0, "Young's modulus"), "nu": (0.3, "Poisson's ratio"), "bend": (0.1, "size of the given displacement")}
    numbers = {"energy": ("", "Square of the energy norm of the displacement."),
               "u_max": ("", "Largest displacement of a node.")}
    degrees = [1, 2]
    gives_matrix = True  # condition number, CG and multigrid are then recorded

    def initialize(self, mesh):
        """Sets up what depends on the topology alone: the mesh, the forms, and the dofs on the boundary."""
        logging.disable(logging.INFO)  # no lines for each form that is compiled
        if isinstance(mesh.cells, tuple):
            raise ValueError("the mesh has cells of several types; this solver takes one")
        dim, n_corners = mesh.points.shape[1], mesh.cells.shape[1]
        name = NAMES[dim, n_corners]
        order = cpp.io.perm_vtk(to_type(name), n_corners)  # DOLFINx numbers corners of quadrilaterals line by line
        cells = np.asarray(mesh.cells, dtype=np.int64)[:, order]
        self.domain = create_mesh(MPI.COMM_SELF, cells, np.array(mesh.points), ufl.Mesh(ufl.VectorElement("Lagrange", name, 1)))
        self.origin = self.domain.geometry.input_global_indices  # DOLFINx numbers the nodes anew

        mu = fem.Constant(self.domain, self.E / (2 * (1 + self.nu)))
        lame = fem.Constant(self.domain, self.E * self.nu / ((1 + self.nu) * (1 - 2 * self.nu)))
        dx = ufl.dx(metadata={"quadrature_degree": 2 * self.degree})

        def strain(u):
            return ufl.sym(ufl.grad(u))

        def work(u, v):
            return ufl.inner(2 * mu * strain(u) + lame * ufl.div(u) * ufl.Identity(dim), strain(v)) * dx

        space = fem.VectorFunctionSpace(self.domain, ("Lagrange", self.degree))
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        no_load = ufl.inner(fem.Constant(self.domain, np.zeros(dim)), v) * dx
        self.boundary_values, self.u = fem.Function(space), fem.Function(space)
        self.energy = fem.form(work(self.u, self.u))

        self.domain.topology.create_connectivity(dim - 1, dim)
        boundary = fem.locate_dofs_topological(space, dim - 1, exterior_facet_indices(self.domain.topology))
        free = np.setdiff1d(np.arange(space.dofmap.index_map.size_local), boundary)
        self.free = (free[:, None] * dim + np.arange(dim)).ravel()
        self.problem = fem.petsc.LinearProblem(work(u, v), no_load, [fem.dirichletbc(self.boundary_values, boundary)], self.u,
                                               petsc_options={"ksp_type": "preonly", "pc_type": "lu"})

    def solve(self, mesh):
        """Returns the numbers of one mesh."""
        dim = mesh.points.shape[1]
        self.domain.geometry.x[:, :dim] = mesh.points[self.origin]
        self.boundary_values.interpolate(self.given)
        self.problem.solve()
        offsets, columns, entries = self.problem.A.getValuesCSR()
        matrix = sp.csr_matrix((entries, columns, offsets))[self.free][:, self.free]
        return {"energy": assemble_scalar(self.energy), "u_max": np.linalg.norm(self.u.x.array.reshape(-1, dim), axis=1).max(),
                "matrix": matrix, "right_hand_side": self.problem.b.array[self.free]}

    def given(self, x):
        """The displacement at points x (3 rows: x, y, z). It solves the equations inside, too, for any E and nu."""
        u = np.zeros((self.domain.geometry.dim, x.shape[1]))
        u[0] = self.bend * (x[0] ** 2 - x[1] ** 2)
        u[1] = -2 * self.bend * x[0] * x[1]
        return u
