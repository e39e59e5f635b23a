# SPDX-License-Identifier: GPL-3.0-or-later
"""Agreement of the results on the published gears with the thesis: a table of the manual."""

from ..results.printed_values import read_printed_tables
from ..results.smoothing import INITIAL, read_results
from ..tables.number_format import as_printed

OPTIMIZER, AREA_WEIGHTED = "global-optimization", "weighted-laplace"
ERRORS = ("e_max", "e_mean", "e_l2", "e_h1")


def agreement(folder):
    """Compares the results in the folder with Tables 6.1 to 6.4; returns lines of Markdown."""
    results = read_results(folder)
    printed = read_printed_tables(results.thesis_study, results.provenance)

    def pairs(content, *columns):
        return paired(results.summary.records(), printed[content].rows, columns)
    quality = pairs("smoothing", "q_min", "q_mean")
    counts = [(row, computed, theirs) for row, computed, theirs in pairs("smoothing", "iterations")
              if row["method"] != OPTIMIZER]
    worst = [row for row, *_ in pairs("errors", "e_max")
             if (row["mesh"], row["degree"], row["method"]) == ("tri", "2", INITIAL)]
    errors = pairs("errors", *ERRORS)
    condition = pairs("solver", "condition_number")
    halved = [float(theirs) / float(computed) for row, computed, theirs in condition if row["method"] == AREA_WEIGHTED]
    cg = pairs("solver", "cg_iterations")
    reached = {method: [r["method_seconds"] != "" for r in results.thresholds.select(method=method).records()
                        if r["error"].startswith("e_")]
               for method in ("getme", "smart-laplace")}
    lines = (
        ("Table 6.1, smoothing", f"q_min and q_mean: {same(quality)} in all printed digits; iterations of both "
                                 f"Laplacians and GETMe: {same(counts)}"),
        ("Table 6.2, solver", f"condition numbers {within(condition, lambda row: row['method'] != AREA_WEIGHTED)}, but "
                              f"those of the area-weighted Laplace meshes are printed {min(halved):.2f} to "
                              f"{max(halved):.2f} times as large as here, while CG counts and errors of these "
                              f"meshes agree; CG iterations {within(cg, lambda row: row['method'] != INITIAL)}, on the "
                              f"initial meshes {within(cg, lambda row: row['method'] == INITIAL)}"),
        ("Table 6.3, errors", f"{within(errors, lambda row: row not in worst)}, {same(errors)} in all printed digits; on "
                              f"the initial triangles at d = 2 {within(errors, lambda row: row in worst)}"),
        ("Table 6.4, thresholds", "computed from runs of this program; " + ", ".join(
            f"{results.title(method)} reaches {sum(met)} of {len(met)}" for method, met in reached.items())))
    return ["| thesis | agreement |", "|---|---|", *(f"| {name} | {text} |" for name, text in lines), "",
            "Differences are the largest relative ones, less half a unit of the last printed digit."]


def paired(records, printed, columns):
    """Returns (printed row, measured field, printed field) wherever the thesis prints a number in one of the
    columns."""
    found = []
    for row in printed:
        keys = [key for key in ("mesh", "degree", "method") if key in row]
        computed = next(record for record in records if all(record[key] == row[key] for key in keys))
        found += [(row, computed[column], row[column]) for column in columns if row.get(column)]
    return found


def same(pairs):
    """Counts the measured numbers that have all digits of the printed ones."""
    n_same = sum(computed == theirs or ("/" not in theirs and as_printed(float(computed), theirs) == theirs)
                 for _, computed, theirs in pairs)
    return f"{n_same} of {len(pairs)}"


def within(pairs, chosen):
    """The largest relative difference of the chosen rows beyond the rounding of the printed values."""
    largest = max(max(0.0, abs(float(computed) - float(theirs)) - half_a_unit(theirs)) / float(theirs)
                  for row, computed, theirs in pairs if chosen(row))
    return f"within {100 * largest:.1f} %"


def half_a_unit(printed):
    """Half a unit of the last printed digit."""
    mantissa, _, exponent = printed.lower().partition("e")
    return 0.5 * 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
