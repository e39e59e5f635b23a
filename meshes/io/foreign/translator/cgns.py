# SPDX-License-Identifier: GPL-3.0-or-later
"""CGNS, read by VTK and written by h5py."""

import sys

import numpy as np

from .mesh import TYPE_NAMES, Failure, in_other_order_of_wedges, joined, mesh_of, without_fields


def read_cgns(path):
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader
    reader = vtkCGNSReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllBases()
    reader.EnableAllFamilies()
    reader.Update()
    return joined([mesh_of(leaf) for leaf in leaves_of(reader.GetOutput())])


def leaves_of(data):
    if data is None:
        return []
    if hasattr(data, "GetNumberOfBlocks"):
        return [leaf for b in range(data.GetNumberOfBlocks()) for leaf in leaves_of(data.GetBlock(b))]
    if data.IsA("vtkStructuredGrid"):
        raise Failure("the file has a structured grid; save it with unstructured cells")
    return [data] if data.GetNumberOfCells() else []


def write_cgns(mesh, path):
    """A file of CGNS/HDF5: one zone with one section for each type of cells."""
    try:
        import h5py
    except ImportError:
        raise Failure("CGNS files are written by h5py; on Debian: apt install python3-h5py") from None
    mesh = mesh.largest()

    def describe(group, name, label, data):
        kind = "MT" if data is None else {"i1": "C1", "i4": "I4", "f4": "R4", "f8": "R8"}[data.dtype.str[1:]]
        for key, text, size in (("name", name, 33), ("label", label, 33), ("type", kind, 3)):
            group.attrs.create(key, np.bytes_(text), dtype=h5py.string_dtype("ascii", size))
        group.attrs.create("flags", np.array([1], np.int32))
        if data is not None:
            group.create_dataset(" data", data=data)

    def add(parent, name, label, data=None):
        group = parent.create_group(name, track_order=True)
        describe(group, name, label, data)
        return group

    def text(words, size=0):
        return np.frombuffer(words.encode().ljust(size, b"\0"), np.int8)

    def ints(*values):
        return np.array(values, np.int32)

    ordered = in_other_order_of_wedges(mesh)
    with h5py.File(path, "w", track_order=True, libver=("earliest", "v108")) as file:
        describe(file, "HDF5 MotherNode", "Root Node of HDF5 File", None)
        file.create_dataset(" format", data=text(f"IEEE_{sys.byteorder.upper()}_32", 15))
        file.create_dataset(" hdf5version", data=text("HDF5 Version 1.8", 33))
        add(file, "CGNSLibraryVersion", "CGNSLibraryVersion_t", np.array([3.2], np.float32))
        base = add(file, "Base", "CGNSBase_t", ints(int(mesh.dimensions().max()), 3))
        zone = add(base, "Zone", "Zone_t", ints([len(mesh.points)], [len(mesh.types)], [0]))
        add(zone, "ZoneType", "ZoneType_t", text("Unstructured"))
        coordinates = add(zone, "GridCoordinates", "GridCoordinates_t")
        for k, axis in enumerate("XYZ"):
            add(coordinates, "Coordinate" + axis, "DataArray_t", mesh.points[:, k].astype(np.float64))
        n = 0
        for cell_type, number in ((5, 5), (9, 7), (10, 10), (14, 12), (13, 14), (12, 17)):  # VTK's and CGNS's numbers
            part = ordered.only(mesh.types == cell_type)
            if len(part.types):
                section = add(zone, TYPE_NAMES[cell_type].capitalize(), "Elements_t", ints(number, 0))
                add(section, "ElementRange", "IndexRange_t", ints(n + 1, n + len(part.types)))
                add(section, "ElementConnectivity", "DataArray_t", (part.nodes + 1).astype(np.int32))
                n += len(part.types)
    return without_fields(mesh)
