# SPDX-License-Identifier: GPL-3.0-or-later
"""XDMF, by meshio."""

import dataclasses
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

from .fields import as_wide_numbers, with_joined_fields, with_split_fields
from .mesh import VERTEX, load_vtu
from .meshio_library import meshio, write_by_meshio


def read_xdmf(path):
    mesh = last_step(path) if is_time_series(path) else meshio().read(path, file_format="xdmf")
    with TemporaryDirectory() as folder:
        translated = str(Path(folder) / "mesh.vtu")
        mesh.write(translated, file_format="vtu", compression=None)
        mesh = load_vtu(translated)
    return dataclasses.replace(mesh, point_data=with_joined_fields(mesh.point_data), cell_data=with_joined_fields(mesh.cell_data))


def is_time_series(path):
    return any(grid.get("CollectionType") == "Temporal" for grid in ElementTree.parse(path).iter("Grid"))


def last_step(path):
    library = meshio()
    with library.xdmf.TimeSeriesReader(path) as series:
        if series.num_steps > 1:
            print(f"note: only the last of {series.num_steps} time steps is read")
        step = series.collection[-1]
        if step.find("Topology") is not None and step.find("Geometry") is not None:
            series.mesh_grid = step  # otherwise all steps share one mesh
        for attribute in step.findall("Attribute"):
            if len(attribute) != 1 or attribute.get("Center") not in ("Node", "Cell"):
                print(f"note: the field '{attribute.get('Name')}' has values elsewhere than at nodes and cells and is left out")
                step.remove(attribute)
        for item in step.iter("DataItem"):
            if item.get("Format") == "HDF":
                item.text = re.sub(":(?=[^/])", ":/", item.text)  # meshio wants paths from the root of the file
        if step.find("Time") is None:
            ElementTree.SubElement(step, "Time", Value="0")  # meshio needs one
        points, cells = series.read_points_cells()
        _, point_data, cell_data = series.read_data(series.num_steps - 1)
    return library.Mesh(points, cells, point_data, cell_data)


def write_xdmf(mesh, path):
    mesh = mesh.only(mesh.types != VERTEX)  # meshio cannot read them back
    held = {1, 2, 3, 6, 9}
    write_by_meshio(dataclasses.replace(mesh, point_data=as_wide_numbers(with_split_fields(mesh.point_data, held)),
                                        cell_data=as_wide_numbers(with_split_fields(mesh.cell_data, held))),
                    path, "xdmf", data_format="XML")
    return mesh
