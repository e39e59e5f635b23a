# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes on the order of the methods compared with the printed one."""

import itertools
import re
import unittest
from types import SimpleNamespace

from plots.results.printed_values import read_printed_tables
from plots.results.smoothing import read_results
from plots.tables.descriptions import ERRORS, SMOOTHING, THRESHOLDS
from plots.tables.formats import as_markdown, as_text
from plots.tables.latex import as_latex
from plots.tables.method_order import order_notes
from plots.tables.smoothing import make_tables
from plots.tests.synthetic_results import without_finite_elements, write_results
from plots.tests.test_read_results import InFolder

RESULTS = SimpleNamespace(title=lambda name: name)


def pairs_of(column, numbers, mesh="tri", **keys):
    """Rows of a mesh: method -> (measured, printed); None for a printed row that does not exist."""
    return [({"mesh": mesh, "method": method, column: computed, **keys},
             {} if printed is None else {"mesh": mesh, "method": method, column: printed, **keys})
            for method, (computed, printed) in numbers.items()]


def notes(column, numbers, description=SMOOTHING):
    return order_notes(description, pairs_of(column, numbers), RESULTS)


class Order(unittest.TestCase):
    def test_same_order_is_one_sentence(self):
        numbers = {"initial": ("0.95", "0.10"), "a": ("0.3", "0.7"), "b": ("0.4", "0.8")}
        self.assertEqual(notes("q_mean", numbers),
                         ["The order of the methods by q_mean is that of the thesis."])

    def test_a_method_that_alone_is_out_of_place_takes_one_sentence(self):
        numbers = {"a": ("0.9", "0.1"), "b": ("0.5", "0.5"), "c": ("0.6", "0.6")}
        first, *cases = notes("q_mean", numbers)
        self.assertEqual(first, "The order of the methods by q_mean is that of the thesis, but for these:")
        self.assertEqual(cases, ["• tri, q_mean: a (0.9000) > b (0.5000), c (0.6000); "
                                 "thesis: 0.1 < 0.5, 0.6"])

    def test_every_pair_in_another_order_is_named_once(self):
        methods = "abcd"
        for computed in itertools.permutations("1234"):
            # The printed numbers rise.
            expected = {frozenset((m, n)) for (m, x), (n, y)
                        in itertools.combinations(zip(methods, computed), 2) if x > y}
            found = []
            for sentence in notes("q_mean", dict(zip(methods, zip(computed, "5678"))))[1:]:
                one, *others = re.findall(r"([a-d]) \(", sentence)
                found += [frozenset((one, other)) for other in others]
            self.assertEqual(len(found), len(set(found)))
            self.assertEqual(set(found), expected)

    def test_numbers_shown_alike_have_no_order(self):
        for numbers in ({"a": ("0.91204", "0.8"), "b": ("0.91201", "0.9")},
                        {"a": ("0.7", "0.5000"), "b": ("0.6", "0.5")}):
            self.assertEqual(len(notes("q_mean", numbers)), 1)
        # Times differ in the digits shown, not in those of the printed values.
        times = {"a": ("0.0007", "0.03"), "b": ("0.0006", "0.08")}
        self.assertEqual(len(notes("smoothing_seconds", times)), 2)

    def test_what_is_shown_twice_is_compared_once(self):
        numbers = {"a": ("0.9", "0.1"), "b": ("0.5", "0.5"), "b-parallel": ("0.5", "0.5")}
        self.assertEqual(notes("q_mean", numbers)[1:],
                         ["• tri, q_mean: a (0.9000) > b (0.5000); thesis: 0.1 < 0.5"])

    def test_nothing_to_compare(self):
        for numbers in ({"a": ("0.3", "0.7"), "b": ("0.4", "invalid"), "c": ("0.4", ""), "d": ("0.4", None),
                         "e": ("", "0.3")}, {}):
            self.assertEqual(notes("q_mean", numbers), [])
        self.assertEqual(notes("peak_memory_gib", {"a": ("1", "3"), "b": ("2", "1")}), [])
        self.assertEqual(notes("threshold", {"a": ("1", "3"), "b": ("2", "1")}, THRESHOLDS), [])

    def test_each_mesh_and_degree_has_an_order_of_its_own(self):
        numbers = {"a": ("0.1", "0.4"), "b": ("0.2", "0.5")}
        pairs = [pair for mesh, degree in itertools.product(("tri", "quad"), "12")
                 for pair in pairs_of("e_max", numbers, mesh, degree=degree)]
        pairs[3][0]["e_max"] = "0.05"  # method b, mesh tri, d = 2
        self.assertEqual(order_notes(ERRORS, pairs, RESULTS)[1:],
                         ["• tri, d = 2, e_max: a (0.1000) > b (0.0500); thesis: 0.4 < 0.5"])


class BelowTheTable(InFolder):
    def test_all_formats_show_the_cases(self):
        folder = without_finite_elements(write_results(self.folder / "r", methods=("smart-laplace", "getme")))
        results = read_results(folder)
        results.summary.columns["q_mean"][:] = ["0.1", "0.9", "0.8"]
        table, *_ = make_tables(results, read_printed_tables(results.study, results.provenance))
        for write, bullet in ((as_text, "• "), (as_markdown, "• "), (as_latex, r"\textbullet{} ")):
            text = " ".join(write(table).split())
            self.assertIn(f"{bullet}Triangular mesh, q", text)
            self.assertIn("thesis: 0.8896", text)
