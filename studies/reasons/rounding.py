# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes a mesh by as little as rounding does."""

import numpy as np


class Rounding:
    """Each iteration changes each coordinate of a free node by a last bit or two, up or down."""

    title = "Rounding"
    parameters = {"relative": (2e-16, "most that a coordinate changes, of itself")}

    def initialize(self, mesh):
        """The same changes in every run."""
        self.random = np.random.default_rng(1)

    def step(self, mesh):
        """Changes the mesh of the iteration before: after n iterations by some sqrt(n) bits."""
        factors = self.random.uniform(-1, 1, (len(mesh.free), mesh.points.shape[1]))
        mesh.points[mesh.free] *= 1 + self.relative * factors
