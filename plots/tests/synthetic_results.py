# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiny invented results folder: four cells, two methods, a few iterations. No result of any study."""

import base64
import csv
import json
from pathlib import Path

import numpy as np

COLUMNS = ("study mesh method stage iteration smoothing_seconds q_min q_star_min q_mean n_invalid "
           "n_reset w_max w_mean degree n_dofs n_free condition_number condition_method lambda_min lambda_max "
           "condition_residual cg_iterations cg_seconds cg_converged jacobi_cg_iterations "
           "jacobi_cg_seconds amg_cg_iterations amg_setup_seconds amg_cg_seconds e_max e_mean "
           "e_l2 e_h1 l2_error h1_error status").split()
SUMMARY = ["study", "mesh", "method", "iterations", "smoothing_seconds", "q_min", "q_star_min", "q_mean",
           "n_invalid", "w_max", "w_mean", "peak_memory_gib"] + COLUMNS[COLUMNS.index("degree"):]
THRESHOLDS = ("study mesh degree error threshold reference_method reference_seconds method "
              "method_seconds speedup").split()


def results_row(**fields):
    """A row with plausible numbers; fields replace some of them."""
    row = {name: "1.5" for name in COLUMNS}
    row.update(w_max="", w_mean="")  # planar meshes have none
    row.update(study="gear", stage="", n_invalid="0", status="ok", iterations="", q_min="0.2046",
               condition_number="377.4", e_max="9.49379", n_dofs="9", condition_method="dense")
    row.update(fields)
    return row


def without_columns(path, names):
    """Takes columns out of a CSV file, as older versions and other studies lack them."""
    with open(path, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    write_csv(path, [name for name in rows[0] if name not in names], rows)


def without_finite_elements(folder):
    """Makes a folder that of a study that only smooths: fields of finite elements are empty."""
    for name in ("iterations.csv", "summary.csv"):
        with open(folder / name, newline="", encoding="utf-8") as stream:
            rows = [row for row in csv.DictReader(stream) if row["degree"] == "1"]
        header = list(rows[0])
        for row in rows:
            row.update(dict.fromkeys(header[header.index("degree"):], ""), status="not solved")
        write_csv(folder / name, header, rows)
    write_csv(folder / "thresholds.csv", THRESHOLDS, [])
    return folder


def change_provenance(folder, **entries):
    """Changes or adds entries of provenance.json."""
    path = Path(folder) / "provenance.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))


def write_csv(path, header, rows):
    """Writes rows as the program does; keys that are not in the header are dropped."""
    with open(path, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, header, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def data_array(name, values, layout, components=1):
    """A DataArray element, as text or as base64 with a UInt64 length in front."""
    kind = {"f": "Float64", "i": "Int64", "u": "UInt8"}[values.dtype.kind]
    if layout == "ascii":
        body = " ".join(repr(value) for value in values.ravel().tolist())
    else:
        body = base64.b64encode(np.uint64(values.nbytes).tobytes() + values.tobytes()).decode()
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
            f'format="{layout}">\n{body}\n</DataArray>')


def write_vtu(path, layout="binary"):
    """A triangle, a quadrilateral and a pentagon around one another."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [3, 0.5, 0], [2, 1, 0],
                       [0.5, 1.8, 0]], dtype=float)
    connectivity = np.array([0, 1, 2, 3, 1, 4, 5, 6, 2, 3, 2, 7])
    parts = {
        "PointData": [data_array("exact_solution", points[:, 0] * points[:, 1], layout)],
        "CellData": [data_array("mean_ratio", np.array([1.0, 0.5, 0.9]), layout)],
        "Points": [data_array("Points", points, layout, 3)],
        "Cells": [data_array("connectivity", connectivity, layout),
                  data_array("offsets", np.array([4, 9, 12]), layout),
                  data_array("types", np.array([9, 7, 5], dtype=np.uint8), layout)]}
    body = "".join(f"<{name}>{''.join(arrays)}</{name}>" for name, arrays in parts.items())
    Path(path).write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="1.0" '
        'byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="8" NumberOfCells="3">{body}</Piece></UnstructuredGrid></VTKFile>')


def write_results(folder, study="gear", meshes=("tri",), methods=("weighted-laplace", "getme")):
    """A complete folder: iteration 1 of the first method is invalid and has no FE numbers."""
    folder = Path(folder)
    (folder / "meshes").mkdir(parents=True)
    iterations, summary, thresholds = [], [], []
    for mesh in meshes:
        for method in ("initial", *methods):
            write_vtu(folder / "meshes" / f"{mesh}_{method}.vtu")
            for degree in "12":
                keys = {"study": study, "mesh": mesh, "method": method, "degree": degree}
                summary.append(results_row(**keys, iterations="" if method == "initial" else "3"))
                for i in range(1 if method == "initial" else 4):
                    row = results_row(**keys, iteration=i, smoothing_seconds=0.01 * i,
                                      q_mean=0.4 + 0.1 * i, e_max=9.0 / (1 + i))
                    if i == 1 and method == methods[0]:
                        row.update(n_invalid="2", status="invalid mesh", q_min="-0.1", e_max="",
                                   e_mean="", e_l2="", e_h1="", l2_error="", h1_error="")
                    iterations.append(row)
                if method == methods[-1]:
                    thresholds.append({**keys, "error": "e_max", "threshold": "7.8", "speedup": "20",
                                       "reference_method": methods[0], "reference_seconds": "0.4",
                                       "method_seconds": "0.02"})
    write_csv(folder / "iterations.csv", COLUMNS, iterations)
    write_csv(folder / "summary.csv", SUMMARY, summary)
    write_csv(folder / "thresholds.csv", THRESHOLDS, thresholds)
    (folder / "provenance.json").write_text(json.dumps({
        "study": study, "study_title": "A & B_1", "methods": [{"name": "getme", "title": "GETMe"}],
        "meshes": [{"name": "tri", "title": "Triangular mesh", "published": False}]}))
    return folder
