# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of the short answer: what smoothing does to the solution. They come from the tables of the studies field, field-volume,
field-large and of collections of public meshes, and from the rows of gear, volume and energy-field."""

from collections import Counter

import numpy as np

from ..collections.comparison import share
from ..collections.problems import AS_GENERATED, WORSE, problems_of
from ..results.collection import read_collection_results
from ..results.rows import read_rows
from ..statistics.units import geometric, mean_of_units, t_interval
from .blocks import table
from .gears import bad_meshes, clusters, minimum
from .published import practice, published_hexahedra
from .reference import METHOD, PERCENT, REFERENCE_METHOD, SOLVER, mean_ratio, pairs_of, spread, tables_of, with_interval

FIELDS = ("field", "field-volume")
KINDS = {"field": "planar", "field-volume": "volume"}
ELEMENTS = ("triangles", "quadrilaterals", "tetrahedra", "hexahedra")
LEVELS = {"as generated": "as generated", "0.6": "distorted to 0.6", "0.45": "distorted to 0.45"}
SURE = 0.05  # adjusted p-values below it tell methods apart
LONG = 1.5  # times of the first assembly over a later one that are too long
FAR_BELOW = 0.25  # times the median of q_min of meshes as generated


class Fields:
    """The studies field and field-volume: their tables, their members and the ends of their methods."""

    def __init__(self, reference):
        self.reference = reference
        self.studies = [study for study in FIELDS if (reference / study).is_dir()]
        self.members = {study: read_rows(reference / study / "members.csv") for study in self.studies}
        self.pairs = [pairs_of(reference, study) for study in self.studies]
        self.problems = [problem for study in self.studies for problem in problems_of(read_collection_results(reference / study))]

    def rows(self, name):
        """The rows of a table of both studies."""
        return [row for study in self.studies for row in tables_of(self.reference, study, name)]

    def gain(self, elements, level, degree, method=REFERENCE_METHOD):
        """The row of a method on a kind of meshes."""
        found, = (row for row in self.rows("table_smoothing") if
                  (row["Elements"], row["Level"], row["d"], row["Method"]) == (elements, level, str(degree), method))
        return found

    @property
    def elements(self):
        """Types of elements: simplices first, the plane first."""
        known = {row["Elements"] for row in self.rows("table_smoothing")}
        return [elements for elements in ELEMENTS if elements in known]

    @property
    def methods(self):
        """Titles of methods, the reference first."""
        return list(dict.fromkeys(row["Method"] for row in self.rows("table_smoothing")))

    def domains(self):
        """"14 planar and 10 volume domains"."""
        counts = [f"{len(set(rows.text('domain')))} {KINDS[study]}" for study, rows in self.members.items()]
        return f"{' and '.join(counts)} domains"

    def n_meshes(self):
        """Number of initial meshes: members without their solution."""
        return sum(len({member.rsplit(".", 1)[0] for member in rows.text("member")}) for rows in self.members.values())

    def nodes(self):
        """Least and largest number of nodes of a mesh."""
        counts = np.concatenate([rows.number("n_nodes") for rows in self.members.values()])
        return int(np.nanmin(counts)), int(np.nanmax(counts))

    def qualities(self, elements, column="q_mean"):
        """Mean qualities of the meshes as generated, or another column of theirs."""
        of_members = [rows.select(elements=elements, distortion="").number(column) for rows in self.members.values()]
        return [quality for qualities in of_members for quality in qualities if np.isfinite(quality)]

    def low_limit(self, elements):
        """The limit of a q_min far below those of meshes as generated."""
        return FAR_BELOW * np.median(self.qualities(elements, "q_min") or [0.0])

    def iterations(self, elements, level, degree):
        """Solver iterations after over before smoothing, as a geometric mean over domains."""
        logs, domains = [], []
        for initial, after in self.pairs:
            chosen = (initial.text("elements") == elements) & (initial.text("degree") == str(degree))
            chosen &= initial.text("distortion") == ("" if level == AS_GENERATED else level)
            ratios = (after.number(SOLVER) / initial.number(SOLVER))[chosen]
            logs += list(np.log(ratios[np.isfinite(ratios)]))
            domains += list(initial.text("family")[chosen][np.isfinite(ratios)])
        return geometric(mean_of_units(logs, domains))[0]


def in_short(found):
    """The paragraph of README.md."""
    def ratios(level, degree):
        return spread([float(found.gain(elements, level, degree)["Error / initial"]) for elements in found.elements])
    least, most = found.nodes()
    low, high = differences(found)
    return (f"""Smoothing repairs bad meshes and does little for good ones. We solved diffusion problems on {found.n_meshes():,} meshes of
{least:,} to {most:,} nodes, from {found.domains()}, with GETMe simultaneous:

- On randomly distorted meshes (mean quality 0.45) the H1 error fell to {ratios("0.45", 1)} of its initial value with linear
  elements, and to {ratios("0.45", 2)} with quadratic elements. The ranges are over types of elements.
- On meshes as the generators made them it fell to {ratios("as generated", 1)} and {ratios("as generated", 2)}.
- The choice of the method matters less: the mean errors of the methods without failures are {low:.2f} to {high:.2f} times those of
  GETMe simultaneous.
""")


def differences(found):
    """Least and largest mean error of other methods over the reference's, of methods that never fail."""
    rows = found.rows("table_smoothing")
    failing = {row["Method"] for row in rows if float(row["Failed (%)"]) > 0}
    numbers = [float(row[f"Error / {REFERENCE_METHOD}"]) for row in rows if row["Method"] not in failing | {REFERENCE_METHOD}]
    return min(numbers), max(numbers)


def blocks(found, reference):
    """The blocks of the answer page."""
    return {"run": what_was_run(found), "levels": levels(found), "good": good_meshes(found), "bad": bad_meshes(reference),
            "methods": methods(found), "budgets": budgets(found), "clusters": clusters(reference), "minimum": minimum(reference), "low-minimum": low_minimum(found),
            "cost": cost(found), "prediction": prediction(found), "practice": practice(reference), "orders": order_or_constant(reference), "sizes": sizes(reference), "moving": moving(reference)}


def what_was_run(found):
    """The size of the studies."""
    least, most = found.nodes()
    counts = [Counter(rows.text("status")) for rows in found.members.values()]
    complete, total = sum(count["complete"] for count in counts), sum(sum(count.values()) for count in counts)
    folders = " and ".join(f"`results/reference/{study}`" for study in found.studies)
    rows = [(elements, spread(found.qualities(elements)), spread(found.qualities(elements, "q_min")),
             f"{np.median(found.qualities(elements, 'q_min')):.2f}", f"{found.low_limit(elements):.2f}") for elements in found.elements]
    return (f"{found.n_meshes():,} meshes of {found.domains()} have {least:,} to {most:,} nodes. Each mesh has five problems, {total:,} in all; "
            f"{complete:,} have complete results ({folders}).\n\nQualities of the meshes as generated (mean ratio, at most 1):\n\n"
            + table(("elements", "`q_mean`", "`q_min`", "median of `q_min`", "limit: a quarter of the median"), rows, "lrrrr"))


def levels(found):
    """Errors and iterations after over before, by type of elements and level of distortion."""
    rows = [(elements, name, *(with_interval(found.gain(elements, level, degree), "Error / initial") for degree in (1, 2)),
             *(f"{found.iterations(elements, level, degree):.2f}" for degree in (1, 2)))
            for elements in found.elements for level, name in LEVELS.items()]
    return ("The numbers are after over before smoothing by GETMe simultaneous: geometric means over domains, with 95 % intervals "
            "(`table_smoothing`; the iterations are those of `summary.csv`).\n\n"
            + table(("elements", "initial mesh", "H1 error, degree 1", "degree 2", "CG iterations with Jacobi, degree 1", "degree 2"),
                    rows, "llrrrr"))


def good_meshes(found):
    """Reports how often smoothing of a generated mesh gains next to nothing."""
    parts = []
    for degree in "12":
        problems = [problem for problem in found.problems if (problem.level, problem.degree) == (AS_GENERATED, degree)]
        small = share(problems, lambda problem: problem.ratio(METHOD) > 0.98)
        worse = share(problems, lambda problem: problem.ratio(METHOD) > WORSE)
        parts.append(f"with elements of degree {degree} the H1 error falls by less than 2 % on {PERCENT * small:.0f} % of the problems, and "
                     f"rises by more than 1 % on {PERCENT * worse:.0f} %")
    return f"On meshes as generated, {parts[0]}; {parts[1]} (means over domains)."


def low_minimum(found):
    """Meshes as generated with a few bad cells: errors and iterations after over before smoothing."""
    rows = []
    for initial, after in found.pairs:
        ratios = {"h1_error": after.number("h1_error") / initial.number("h1_error"), SOLVER: after.number(SOLVER) / initial.number(SOLVER)}
        meshes = np.array([member.rsplit(".", 1)[0] for member in initial.text("member")])
        for elements in found.elements:
            low = (initial.text("elements") == elements) & (initial.text("distortion") == "")
            low &= initial.number("q_min") < found.low_limit(elements)
            for mesh in dict.fromkeys(meshes[low]):
                here = low & (meshes == mesh)
                cells = [mean_ratio(ratios[column][here & (initial.text("degree") == degree)]) for degree in "12" for column in ratios]
                rows.append((initial.text("domain")[here][0], elements, f"{initial.number('q_min')[here][0]:.4f}",
                             f"{initial.number('q_mean')[here][0]:.2f}", *cells))
    return ("Meshes as generated whose q_min is below a quarter of the median of their elements (a limit chosen after looking). Each number is after over "
            "before smoothing, a geometric mean over five problems:\n\n"
            + table(("domain", "elements", "q_min", "q_mean", "H1 error, degree 1", "CG iterations with Jacobi", "degree 2", "iterations"),
                    rows, "llrrrrrr") + "\n\n" + published_hexahedra(found.reference, found.low_limit("hexahedra")))


def methods(found):
    """The errors of methods at their ends, over those of the reference method."""
    over = f"Error / {REFERENCE_METHOD}"

    def cell(elements, level, method):
        row = found.gain(elements, level, 1, method)
        sure = "*" if row[f"{over} p"] and float(row[f"{over} p"]) < SURE else ""
        failed = f", fails on {row['Failed (%)']} %" if float(row["Failed (%)"]) > 0 else ""
        return f"{float(row[over]):.2f}{sure}{failed}"
    rows = [(method, LEVELS[level], *(cell(elements, level, method) for elements in found.elements))
            for method in found.methods[1:] for level in ("as generated", "0.45")]
    return ("H1 error over that of GETMe simultaneous, degree 1, at the methods' ends (`table_smoothing`). A method fails if it has no "
            "result or invalid cells; the initial mesh then counts. A star: a test over domains finds a difference (p below 0.05 after "
            "correction). It can be too small for two digits, as in 1.00*.\n\n"
            + table(("method", "initial mesh", *found.elements), rows, "ll" + "r" * len(found.elements)))


def budgets(found):
    """The best method within a budget."""
    rows = found.rows("table_budgets")
    names = [name for name in rows[0] if name.endswith("solutions")]
    lines = []
    for elements in found.elements:
        chosen = [row for row in rows if (row["Elements"], row["d"], row["Level"]) == (elements, "1", "0.6")]
        cells = []
        for name in names:
            best = min(chosen, key=lambda row: float(row[name]))
            reference, = (row for row in chosen if row["Method"] == REFERENCE_METHOD)
            cells.append(f"{best['Method']} {float(best[name]):.2f} ({float(reference[name]):.2f})")
        lines.append((elements, *cells))
    return ("Method with the lowest mean ratio within a budget of smoothing time, in solutions on the initial mesh; in parentheses the ratio "
            "of GETMe simultaneous (degree 1, distorted to 0.6, `table_budgets`). Each method is chosen after looking; of methods with the same three "
            "digits the first of the table above is named:\n\n" + table(("elements", *names), lines))


def cost(found):
    """Error and total time of smoothing, of the next degree and of split cells."""
    rows = found.rows("table_payoff")
    ways = {REFERENCE_METHOD: "smoothed", "unsmoothed, cells split": "every cell split", "unsmoothed, degree d + 1": "next degree"}
    by_key = {(row["Elements"], row["d"], row["Level"], row["Instead"]): row for row in rows}
    lines = [(elements, name, *(f"{float(by_key[elements, '1', level, way][column]):{form}}" for way in ways
                                for column, form in (("Error / initial", ".2f"), ("Time / initial", ".1f"))))
             for elements in found.elements for level, name in LEVELS.items()]
    heading = [text for way in ways.values() for text in (f"{way}: error", "time")]
    second = [float(row["Time / initial"]) for row in rows if (row["d"], row["Instead"]) == ("2", REFERENCE_METHOD)]
    return ("H1 error, and total time to get it, each over that of one solution on the unsmoothed mesh with linear elements "
            "(`table_payoff`):\n\n" + table(("elements", "initial mesh", *heading), lines, "ll" + "rr" * len(ways))
            + f"\n\nWith quadratic elements, smoothing and solving take {spread(second)} times as long as solving on the unsmoothed mesh.\n\n"
            + first_solutions(found))


def first_solutions(found):
    """How much too long the first solution of a mesh takes: assembly does the same work before and after smoothing."""
    def longer(elements, level, degree):
        """Assembly times of the initial mesh over those of the smoothed one."""
        ratios = np.concatenate([(initial.number("assembly_seconds") / after.number("assembly_seconds"))[
            (initial.text("elements") == elements) & (initial.text("degree") == degree)
            & (initial.text("distortion") == ("" if level == AS_GENERATED else level))] for initial, after in found.pairs])
        return ratios[np.isfinite(ratios)]
    first, second = ([np.median(longer(elements, AS_GENERATED, degree)) for elements in found.elements] for degree in "12")
    long = [PERCENT * np.mean(longer(elements, level, "1") > LONG) for elements in found.elements for level in LEVELS]
    return ("The time of the unsmoothed mesh is too long, as it is solved first. Assembly does the same work before and after smoothing. On meshes as "
            "generated, degree 1, it takes longer on the initial mesh. The medians are "
            f"{', '.join(f'{ratio:.2f} times ({elements})' for ratio, elements in zip(first, found.elements))}. At degree 2, which is solved later, "
            f"they are {spread(second)}. At degree 1 it takes more than {LONG} times as long on {spread(long, '.0f')} % of the problems of a type and a "
            "level. So a time below 1 on a good mesh does not show that smoothing gains time. The times of split cells and of the next degree are too "
            "small for the same reason.")


def prediction(found):
    """The rank correlation of qualities with the true H1 error."""
    rows = [row for row in found.rows("table_prediction") if (row["Outcome"], row["d"]) == ("H1 error", "1")]
    lines = []
    for elements in found.elements:
        of_elements = {row["Quality"]: row for row in rows if row["Elements"] == elements and row["Correlation"]}
        strongest = max(of_elements.values(), key=lambda row: abs(float(row["Correlation"])))
        lines.append((elements, *(with_interval(of_elements[name], "Correlation") for name in ("q_mean", "q_min")),
                      f"{strongest['Quality']}: {with_interval(strongest, 'Correlation')}"))
    return ("Rank correlation of a mesh's quality with its H1 error, degree 1, mean over domains (`table_prediction`; -1: higher quality always "
            "goes with a lower error):\n\n" + table(("elements", "q_mean", "q_min", "strongest of all metrics, chosen after looking"), lines))


ORDERS = {"orders": "square and L-shape, triangles and quadrilaterals, five sizes, distorted to 0.45",
          "orders-volume": "cube and Fichera corner, tetrahedra and hexahedra, five or six sizes, distorted to 0.6"}


def order_or_constant(reference):
    """Whether smoothing changes the order of the error, in the plane and in space."""
    return "Observed orders on a smooth solution:\n\n" + "\n\n".join(
        f"{meshes[0].upper()}{meshes[1:]} (`results/reference/{study}/tables/table_orders.csv`):\n\n{orders_of(reference, study)}"
        for study, meshes in ORDERS.items())


def orders_of(reference, study):
    """The table of one study."""
    rows = [row for row in tables_of(reference, study, "table_orders") if row["Level"] != "as generated"]
    expected = {("H1", "1"): 1, ("H1", "2"): 2, ("L2", "1"): 2, ("L2", "2"): 3}
    lines = [(norm, degree, order, *(spread([float(row[f"Order of {norm}"]) for row in rows if row[f"Order of {norm}"] not in ("", "–")
                                             and row["d"] == degree and (row["Method"] == "Initial") == is_initial])
                                     for is_initial in (True, False)))
             for (norm, degree), order in expected.items()]
    return table(("error", "degree", "expected", "before smoothing", "after smoothing"), lines, "lrrrr")


def sizes(reference):
    """Gains on large meshes next to those on small ones: the same domains, elements and problems."""
    small, large = gains_by_domain(reference, FIELDS), gains_by_domain(reference, ("field-large",))
    rows, quotients = [], []
    for elements in ELEMENTS:
        for level, name in list(LEVELS.items())[:2]:
            domains = sorted(domain for of, at, domain in large if (of, at) == (elements, level) and (of, at, domain) in small)
            pairs = np.array([(small[elements, level, domain], large[elements, level, domain]) for domain in domains])
            means = [f"{np.exp(mean):.2f}" for mean in pairs.mean(axis=0)]
            differences = pairs[:, 1] - pairs[:, 0]
            quotient, (low, high) = geometric((differences.mean(), t_interval(differences)))
            quotients.append(quotient)
            rows.append((elements, name, len(domains), *means, f"{quotient:.3f} ({low:.3f} to {high:.3f})", "yes" if low > 1 or high < 1 else "no"))
    counts = read_rows(reference / "field-large" / "members.csv").number("n_nodes")
    return (f"`field-large` has meshes of {int(np.nanmin(counts)):,} to {int(np.nanmax(counts)):,} nodes. H1 error after over before GETMe simultaneous, degree "
            "1, the same domains and problems in both studies ([criterion](field-study.md#do-the-gains-depend-on-the-size)):\n\n"
            + table(("elements", "initial mesh", "domains", "small meshes", "large meshes", "large over small (95 % interval)", "depends on the size"),
                    rows, "llrrrrl")
            + f"\n\nSo large meshes are left with {spread(quotients)} times the part of the error that small ones are left with.")


def gains_by_domain(reference, studies):
    """{(elements, level, domain): mean logarithm of the H1 error after over before GETMe simultaneous}, degree 1, smooth and layer."""
    found = {}
    for study in studies:
        before, after = (pair.records() for pair in pairs_of(reference, study))
        for first, last in zip(before, after):
            if first["degree"] == "1" and first["solution"] in ("smooth", "layer") and last["n_invalid"] == "0":
                key = first["elements"], first["distortion"] or AS_GENERATED, first["domain"]
                found.setdefault(key, []).append(np.log(float(last["h1_error"]) / float(first["h1_error"])))
    return {key: np.mean(values) for key, values in found.items()}


def moving(reference):
    """Gains of solution-adaptive methods at degree 1."""
    rows = read_rows(reference / "energy-field" / "tables" / "table_energy_gains.csv").records()
    medians = sorted(float(row["H1 median"]) for row in rows if row["d"] == "1")
    return (f"Solution-adaptive methods lower the true H1 error further than GETMe: {medians[0]:.1f} to {medians[-1]:.1f} times (medians, "
            "linear elements, solutions with fronts, layers and peaks, `results/reference/energy-field`).")
