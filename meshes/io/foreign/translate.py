#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates mesh files of other formats to and from .vtu, by VTK, meshio and h5py.

translate.py read FILE MESH.vtu    translate.py write MESH.vtu FILE

Lines "note: ..." of the output name the losses. If the translation fails, the last line says why, and the exit code is 1.
Each written file is read again: a library that loses cells in silence is found out."""

import contextlib
import io
import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))  # PYTHONSAFEPATH=1 leaves it out

from translator.cgns import read_cgns, write_cgns
from translator.exodus import read_exodus, write_exodus
from translator.mesh import TYPE_NAMES, Failure, load_vtu, save_vtu
from translator.surfaces import read_surface, write_stl, write_surface
from translator.xdmf import read_xdmf, write_xdmf

EXODUS, XDMF, SURFACES = (".exo", ".e", ".ex2"), (".xdmf", ".xmf"), (".stl", ".obj", ".ply")


def reader_of(suffix):
    return read_exodus if suffix in EXODUS else read_xdmf if suffix in XDMF else read_cgns if suffix == ".cgns" else read_surface


def read(source, target):
    save_vtu(reader_of(Path(source).suffix.lower())(source), target)


def write(source, target):
    suffix = Path(target).suffix.lower()
    writer = (write_exodus if suffix in EXODUS else write_xdmf if suffix in XDMF else write_cgns if suffix == ".cgns"
              else write_stl if suffix == ".stl" else write_surface)
    meant = writer(load_vtu(source), target)
    if not Path(target).exists():
        raise Failure("the library for this format has written no file")
    library = {write_cgns: "h5py", write_xdmf: "meshio", write_surface: "meshio"}.get(writer, "VTK")
    try:
        read_back = reader_of(suffix)(target)
    except Exception as error:
        raise Failure(f"{library} has written a file that cannot be read ({described(error)}); choose .vtu") from None
    difference = differs(meant, read_back, suffix in SURFACES)
    if difference:
        raise Failure(f"this mesh cannot be written by {library}: read back, {difference}; choose .vtu")


def differs(meant, found, has_single_precision):
    """Says how a mesh that was read back differs from the one that was written; nothing if it does not."""
    def kinds(mesh):
        tags = mesh.tags() if meant.cell_data else None
        return Counter(zip(mesh.types.tolist(), [0] * len(mesh.types) if tags is None else tags.tolist()))

    def nodes(mesh):
        used = mesh.points[np.unique(mesh.nodes)]
        return np.unique(used.astype(np.float32) + 0, axis=0) if has_single_precision else used
    n_wrong = max((kinds(meant) - kinds(found)).total(), (kinds(found) - kinds(meant)).total())
    if n_wrong:
        return f"{n_wrong} of {len(meant.types)} cells differ"
    if len(nodes(meant)) != len(nodes(found)):
        return f"it has {len(nodes(found))} nodes instead of {len(nodes(meant))}"
    for cell_type in np.unique(meant.types):  # the order of cells may differ, so coordinates are sorted
        a, b = (np.sort(mesh.points[mesh.only(mesh.types == cell_type).nodes], axis=0) for mesh in (meant, found))
        if not np.allclose(a, b, rtol=0, atol=1e-6 * np.abs(meant.points).max()):
            return f"the nodes of {TYPE_NAMES[int(cell_type)]} differ"
    for a, b in ((meant.point_data, found.point_data), (meant.cell_data, found.cell_data)):
        for name, values in a.items():
            is_part = values.ndim == 1 and name[:-1] in b  # VTK joins the fields vX, vY and vZ of Exodus files to v
            if values.any() and not is_part and (name not in b or b[name].shape[1:] != values.shape[1:]):
                return f"the field '{name}' is missing"
    return None


def described(error):
    """An error of a library in words."""
    text = (str(error).splitlines() or [""])[0]
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def main(direction, source, target):
    errors = io.StringIO()
    try:
        with contextlib.redirect_stderr(errors):
            {"read": read, "write": write}[direction](source, target)
    except Failure as failure:
        print(failure)
        return 1
    except (Exception, SystemExit) as error:  # of a library, about a file that it does not understand
        print(f"the file cannot be translated ({described(error)}); save it in another format, for example .vtu")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
