# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures are drawn where they changed, and the screen says what its numbers are."""

import contextlib
import io
import json
from unittest import mock

from plots.__main__ import main
from plots.report.reload import VERSION_FILE, make_final, make_reloading
from plots.results.drawn import Drawn
from plots.results.processes import finished
from plots.results.smoothing import read_results
from plots.tables.screen import screen
from plots.tests.synthetic_results import change_provenance, write_results
from plots.tests.test_read_results import InFolder


def fail():
    raise ValueError("of a process")


class Processes(InFolder):
    def test_results_come_with_the_numbers_of_their_functions(self):
        self.assertEqual(sorted(finished([lambda n=n: n * n for n in range(5)])), [(n, n * n) for n in range(5)])
        with self.assertRaisesRegex(ValueError, "of a process"):
            list(finished([fail, fail]))


class KnownFigures(InFolder):
    def test_files_and_inputs_decide(self):
        (self.folder / "figures").mkdir()
        (self.folder / "figures" / "a.png").write_bytes(b"")
        drawn = Drawn(self.folder, "one")
        drawn.note("a", [self.folder / "figures" / "a.png"])
        drawn.note("empty", [])
        drawn.save(["a", "empty"])
        again = Drawn(self.folder, "one")
        self.assertEqual(again.paths("a"), [self.folder / "figures" / "a.png"])
        self.assertEqual(again.paths("empty"), [])
        self.assertIsNone(again.paths("b"))
        self.assertEqual(again.all_paths(), [self.folder / "figures" / "a.png"])
        self.assertIsNone(Drawn(self.folder, "two").paths("a"))
        (self.folder / "figures" / "a.png").unlink()
        self.assertIsNone(again.all_paths())

    def test_files_of_figures_that_are_gone_are_removed(self):
        (self.folder / "figures").mkdir()
        for name in ("a.png", "b.png", "mine.png"):
            (self.folder / "figures" / name).write_bytes(b"")
        drawn = Drawn(self.folder, "one")
        drawn.note("a", [self.folder / "figures" / "a.png"])
        drawn.note("b", [self.folder / "figures" / "b.png"])
        drawn.save(["b"])
        self.assertEqual(sorted(path.name for path in self.folder.glob("figures/*.png")), ["b.png", "mine.png"])

    def test_a_damaged_list_is_no_list(self):
        for text in ("", "[]", '{"figures": 1}', '{"figures": {"a": 1}, "whole": ""}'):
            (self.folder / ".drawn.json").write_text(text, encoding="utf-8")
            self.assertIsNone(Drawn(self.folder, "one").paths("a"))

    def test_a_study_draws_only_what_changed(self):
        write_results(self.folder)

        def drawn_figures():
            with mock.patch("plots.figures.planned.PlannedFigure.save", autospec=True, side_effect=self.note) as save, \
                    mock.patch("plots.results.processes.os.cpu_count", return_value=1), contextlib.redirect_stdout(io.StringIO()), \
                    contextlib.redirect_stderr(io.StringIO()):
                self.assertEqual(main([str(self.folder)]), 0)
            return save.call_count
        n = drawn_figures()
        self.assertGreater(n, 0)
        self.assertEqual(drawn_figures(), 0)
        change_provenance(self.folder, study_title="Another title", written="later")
        self.assertEqual(drawn_figures(), 0)
        (self.folder / "own.csv").write_text("any row of the folder\n", encoding="utf-8")
        self.assertEqual(drawn_figures(), n)

    @staticmethod
    def note(plan, folder, formats):
        folder.mkdir(exist_ok=True)
        (folder / f"{plan.name}.png").write_bytes(b"")
        return [folder / f"{plan.name}.png"]


class Screen(InFolder):
    def test_says_the_problem_and_the_sessions_of_times(self):
        write_results(self.folder)
        self.assertNotIn("sessions", screen(read_results(self.folder)))
        results = read_results(self.folder)
        mesh, (first, second) = results.meshes[0], results.methods[:2]
        change_provenance(self.folder, problem={"solutions": [{"u": "x*y", "A": "2"}], "natural": ["left"], "load": "quadrature"},
                          results=[{"mesh": mesh, "method": first, "smoothed": "2026-01-01T00:00:00Z"},
                                   {"mesh": mesh, "method": second, "smoothed": "2026-01-02T00:00:00Z"}])
        text = screen(read_results(self.folder))
        self.assertTrue(text.startswith("Problem: -div(A grad u) = f, u = x*y, A = 2\n"
                                        "Boundary: natural conditions on left, u given elsewhere. Load: f integrated.\n"), text)
        self.assertIn("The smoothing times of a mesh come from up to 2 sessions", text)


class Reload(InFolder):
    def test_a_page_has_the_version_that_lies_next_to_it(self):
        page = self.folder / "report.html"
        page.write_text("<html><body>first</body></html>", encoding="utf-8")
        make_reloading(page)
        version = (self.folder / VERSION_FILE).read_text(encoding="utf-8").split('"')[1]
        self.assertIn(json.dumps(version), page.read_text(encoding="utf-8"))
        make_final(page)
        self.assertFalse((self.folder / VERSION_FILE).exists())
