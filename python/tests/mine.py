# SPDX-License-Identifier: GPL-3.0-or-later
"""Examples of smoothers of users: valid ones, and ones that violate rules."""

import json
import os
import time

import numpy as np


class Laplace:
    """Each free node moves to the mean of its edge neighbours, one after the other."""

    parameters = {"fraction": (1.0, "of the way"), "unused": (3, "a whole number")}
    tolerance = -1.0
    max_iterations = 4

    def initialize(self, mesh):
        sides = {"triangle": [(0, 1), (1, 2), (2, 0)],
                 "quadrilateral": [(0, 1), (1, 2), (2, 3), (3, 0)],
                 "tetrahedron": [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)],
                 "hexahedron": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4),
                                (0, 4), (1, 5), (2, 6), (3, 7)]}
        neighbours = [set() for _ in range(mesh.n_nodes)]
        for name, cells in mesh.blocks.items():
            for cell in cells:
                for a, b in sides[name]:
                    neighbours[cell[a]].add(cell[b])
                    neighbours[cell[b]].add(cell[a])
        self.neighbours = [sorted(nodes) for nodes in neighbours]

    def step(self, mesh):
        points = mesh.points
        for i in mesh.free:
            mean = np.zeros(points.shape[1])
            for j in self.neighbours[i]:
                mean += points[j]
            points[i] += self.fraction * (mean / len(self.neighbours[i]) - points[i])


class Returning:
    title = "Returned points"
    tolerance = -1.0
    max_iterations = 3

    def step(self, mesh):
        points = mesh.points.copy()
        points[mesh.free] *= 1.0 + 1e-9
        return points


class Addresses:
    """Records the addresses of the coordinates in NumPy and in C++."""

    tolerance = -1.0
    max_iterations = 5

    def __init__(self):
        self.seen = []

    def step(self, mesh):
        from smoothfem._core import address
        mesh.points[mesh.free] += 1e-7
        self.seen.append((mesh.points.__array_interface__["data"][0], address(mesh), len(mesh.free)))
        with open("addresses.json", "w") as file:
            json.dump(self.seen, file)


class MovesFixed:
    def step(self, mesh):
        mesh.points[mesh.fixed[3]] += 1e-3


class NotFinite:
    def step(self, mesh):
        mesh.points[mesh.free[2]] = np.nan


class WrongShape:
    def step(self, mesh):
        return mesh.points[:-1]


class ReturnsText:
    def step(self, mesh):
        return "points"


class Raises:
    def step(self, mesh):
        return 1 / 0


class Exits:
    def step(self, mesh):
        raise SystemExit(0)


class Leaves:
    def step(self, mesh):
        os._exit(0)


class Interrupts:
    def step(self, mesh):
        raise KeyboardInterrupt


class Surrogate:
    title = "a \udcff"

    def step(self, mesh):
        raise ValueError("\udcff")


class TooMany:
    max_iterations = -5

    def step(self, mesh):
        pass


class Huge:
    parameters = {"n": (10**30, "too large")}

    def step(self, mesh):
        pass


class NotANumber:
    parameters = {"x": (float("nan"), "no number")}

    def step(self, mesh):
        pass


class GoesElsewhere:
    max_iterations = 1

    def step(self, mesh):
        os.makedirs("elsewhere", exist_ok=True)
        os.chdir("elsewhere")


class Forks:
    max_iterations = 2

    def step(self, mesh):
        os.fork()


class Sleeps:
    tolerance = -1.0

    def step(self, mesh):
        self.n = getattr(self, "n", 0) + 1
        if self.n == 3:
            open("asleep", "w").close()
            time.sleep(1000)


class Keeps:
    def step(self, mesh):
        self.points = mesh.points[:2]


class FailsToBegin:
    def initialize(self, mesh):
        mesh.points[0] = 0.0

    def step(self, mesh):
        pass


class NoStep:
    pass


class Text:
    parameters = {"flag": (True, "no number")}

    def step(self, mesh):
        pass
