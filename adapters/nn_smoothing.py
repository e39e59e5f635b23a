# SPDX-License-Identifier: GPL-3.0-or-later
"""Smoothing of planar triangles by a neural network: each free node moves to the position that the network
predicts in the polygon of its neighbours (Guo et al., Computational Mechanics 69, 2022). You provide the weights: a folder
of TorchScript files (`torch.jit.save`), which can only evaluate a network. Pickles are not loaded; nn_weights.py
extracts the published numbers from them. Needs python3-torch.

    subsection method nn
      set type    = python:nn_smoothing.py:NeuralNetwork
      set weights = FOLDER
    end

FOLDER has a file N.pt for each number N of neighbours. Its network takes N x 2 coordinates: the node's polygon,
counterclockwise, moved and scaled into the unit square. It returns the 2 coordinates of the node in this square."""

from pathlib import Path

import numpy as np


class NeuralNetwork:
    """Each free node moves to the position that a network predicts from its neighbours."""

    title = "Neural network"
    parameters = {"weights": ("weights", "folder of the networks, a TorchScript file N.pt for N neighbours")}

    def initialize(self, mesh):
        """Stores the rings of neighbours, counterclockwise, and loads the networks for their sizes."""
        import torch  # torch is needed by this method only

        if list(mesh.blocks) != ["triangle"]:
            raise ValueError("meshes of triangles only")
        follower = {}
        for a, b, c in mesh.blocks["triangle"].tolist():
            for node, first, second in ((a, b, c), (b, c, a), (c, a, b)):
                follower.setdefault(node, {})[first] = second
        self.rings = {}
        for node in mesh.free.tolist():
            ring = [next(iter(follower[node]))]
            while (following := follower[node][ring[-1]]) != ring[0]:
                ring.append(following)
            self.rings[node] = ring
        sizes = {len(ring) for ring in self.rings.values()}
        self.networks = {n: torch.jit.load(str(Path(self.weights) / f"{n}.pt")) for n in sizes
                         if (Path(self.weights) / f"{n}.pt").exists()}
        self.tensor = torch.as_tensor

    def step(self, mesh):
        """Moves the nodes one after the other. Nodes without a network for their number of neighbours stay."""
        for node, ring in self.rings.items():
            if len(ring) not in self.networks:
                continue
            polygon = mesh.points[ring]
            corner, size = polygon.min(axis=0), np.ptp(polygon, axis=0).max()
            placed = self.networks[len(ring)](self.tensor((polygon - corner) / size).float()[None])
            mesh.points[node] = corner + size * placed.detach().numpy().reshape(2)
