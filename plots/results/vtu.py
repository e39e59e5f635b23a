# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads VTK's XML unstructured grids: one piece, arrays inline as base64 ("binary") or as text.

Format: VTK File Formats, "XML File Formats", UnstructuredGrid (The VTK User's Guide). Appended and
compressed data are not written by smoothfem and are refused.
"""

import base64
import binascii
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .cell_types import PLANAR_CELL_TYPES, VOLUME_CELL_TYPES
from .rows import ResultsError

NUMPY_TYPES = {"Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4",
               "UInt32": "u4", "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8"}


@dataclass(frozen=True)
class UnstructuredGrid:
    """Points (n, 3); cells in CSR form: cell c has nodes connectivity[offsets[c]:offsets[c + 1]]."""

    points: np.ndarray
    connectivity: np.ndarray
    offsets: np.ndarray  # n_cells + 1 entries, the first is 0
    types: np.ndarray
    point_data: dict
    cell_data: dict

    @property
    def is_planar(self):
        """Whether every cell is a triangle, quadrilateral or polygon, of one plane."""
        return self.has_polygons and bool((self.points[:, 2] == self.points[0, 2]).all())

    @property
    def is_surface(self):
        """The same in space."""
        return self.has_polygons and not self.is_planar

    @property
    def has_polygons(self):
        """Whether every cell is a triangle, quadrilateral or polygon."""
        return bool(np.isin(self.types, PLANAR_CELL_TYPES).all())

    @property
    def is_volume(self):
        """Whether every cell is a tetrahedron, hexahedron, prism or pyramid."""
        return bool(np.isin(self.types, list(VOLUME_CELL_TYPES)).all())

    def cells(self):
        """The cells as a list of arrays of node numbers."""
        return np.split(self.connectivity, self.offsets[1:-1])


def read_vtu(path):
    """Reads an unstructured grid; throws ResultsError if the file is missing, truncated or of a kind
    that is not understood."""
    path = Path(path)
    try:
        root = ElementTree.parse(path).getroot()
    except FileNotFoundError:
        raise ResultsError(f"{path}: the file is missing.") from None
    except (OSError, ElementTree.ParseError) as error:
        raise ResultsError(f"{path}: not a complete VTU file ({error}).") from None
    if root.get("compressor"):
        raise ResultsError(f"{path}: compressed VTU files are not supported.")
    try:
        return read_piece(root)
    except (ValueError, KeyError, AttributeError, IndexError, binascii.Error) as error:
        raise ResultsError(f"{path}: not a VTU file that can be read ({error}).") from None


def read_piece(root):
    """The grid of the first (and only) piece below the XML root."""
    piece = root.find("UnstructuredGrid/Piece")
    n_points, n_cells = int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))
    byte_order = ">" if root.get("byte_order") == "BigEndian" else "<"
    header = byte_order + NUMPY_TYPES[root.get("header_type", "UInt32")]

    def arrays(section, count):
        parent = piece.find(section)
        found = {} if parent is None else {
            array.get("Name"): read_array(array, byte_order, header)
            for array in parent.findall("DataArray") if array.get("type") in NUMPY_TYPES}
        for name, values in found.items():
            if count is not None and len(values) != count:
                raise ValueError(f"array {name} has {len(values)} entries instead of {count}")
        return found

    cells = arrays("Cells", None)
    offsets = np.concatenate(([0], cells["offsets"])).astype(np.int64)
    if len(offsets) != n_cells + 1 or offsets[-1] != len(cells["connectivity"]):
        raise ValueError("offsets and connectivity do not fit")
    points = next(iter(arrays("Points", n_points).values())).reshape(n_points, 3)
    return UnstructuredGrid(points=points, connectivity=cells["connectivity"].astype(np.int64),
                            offsets=offsets, types=cells["types"],
                            point_data=arrays("PointData", n_points),
                            cell_data=arrays("CellData", n_cells))


def read_array(element, byte_order, header):
    """The values of a DataArray, shape (tuples,) or (tuples, components)."""
    kind = byte_order + NUMPY_TYPES[element.get("type")]
    text = (element.text or "").strip()
    layout = element.get("format", "ascii")
    if layout == "ascii":
        values = np.array(text.split(), dtype=kind)
    elif layout == "binary":
        values = decode_block("".join(text.split()), kind, header)
    else:
        raise ValueError(f"format {layout} is not supported")
    components = int(element.get("NumberOfComponents", 1))
    return values.reshape(-1, components) if components > 1 else values


def decode_block(text, kind, header):
    """Decodes one base64 block: its length in bytes as an unsigned integer, then the values."""
    data = base64.b64decode(text, validate=True)
    width = np.dtype(header).itemsize
    length = int(np.frombuffer(data[:width], header)[0])
    if len(data) - width < length:
        raise ValueError(f"{len(data) - width} bytes instead of {length}")
    return np.frombuffer(data[width:width + length], kind)
