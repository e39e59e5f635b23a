#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""nn_weights.py FROM TO: converts the published networks of NN-Smoothing to TorchScript files N.pt for nn_smoothing.py.

The published files are optN.pkl for N neighbours: linear layers with sigmoids between them. The pickles are not loaded, as
this could execute code in them. The program extracts their numbers only. Needs python3-torch."""

import io
import pickletools
import re
import sys
from pathlib import Path

import numpy as np
import torch


class Network(torch.nn.Module):
    """Maps 1 x N x 2 coordinates to 2 coordinates."""

    def __init__(self, layers):
        super().__init__()
        self.layers = torch.nn.Sequential(*layers)

    def forward(self, polygon):
        return self.layers(polygon.reshape(polygon.shape[0], -1))


def arrays(content):
    """Returns the arrays of a file in torch's format before 1.6, in the order of the network.

    The file has five pickles (the fourth is the network, the fifth lists the keys of the arrays), then each array after its
    length in eight bytes."""
    stream = io.BytesIO(content)
    pickles = [[arg for op, arg, _ in pickletools.genops(stream) if op.name == "BINUNICODE"] for _ in range(5)]
    keys = pickles[4]
    found = {}
    for key in keys:
        n = int(np.frombuffer(stream.read(8), dtype="<i8")[0])
        found[key] = np.frombuffer(stream.read(4 * n), dtype="<f4")
        if found[key].size != n:
            raise ValueError("the file ends within its numbers")
    return [found[name] for name in pickles[3] if name in found]


def network(content, n_neighbours):
    """Returns a network of these arrays: alternately weights and biases, whose lengths determine the layers."""
    numbers = arrays(content)
    layers, n_in = [], 2 * n_neighbours
    for weights, biases in zip(numbers[::2], numbers[1::2]):
        if weights.size != n_in * biases.size:
            raise ValueError(f"a layer of {weights.size} weights and {biases.size} biases does not take {n_in} numbers")
        layer = torch.nn.Linear(n_in, biases.size)
        with torch.no_grad():
            layer.weight.copy_(torch.tensor(weights).reshape(biases.size, n_in))
            layer.bias.copy_(torch.tensor(biases))
        layers += [layer, torch.nn.Sigmoid()]
        n_in = biases.size
    if n_in != 2:
        raise ValueError(f"the last layer has {n_in} numbers, not 2")
    return Network(layers[:-1])


def main(source, target):
    """Converts each file."""
    Path(target).mkdir(parents=True, exist_ok=True)
    for path in sorted(Path(source).glob("opt*.pkl")):
        n_neighbours = int(re.fullmatch(r"opt(\d+)", path.stem)[1])
        torch.jit.script(network(path.read_bytes(), n_neighbours)).save(str(Path(target) / f"{n_neighbours}.pt"))
        print(f"{path.name}: {n_neighbours} neighbours")


if __name__ == "__main__":
    main(*sys.argv[1:])
