# SPDX-License-Identifier: GPL-3.0-or-later
"""The page that holds a whole results folder: its data, and the page in a browser (headless Chromium)."""

import base64
import json
import re
import time
from unittest import mock

import numpy as np

from plots.__main__ import main
from plots.collections.diagrams import Curve, Diagram
from plots.report import libraries
from plots.report.collection_plots import MOST_STEPS, collection_plots, diagram_data
from plots.report.contents import comparison, contents, ratio, summary_table
from plots.report.mesh_views import mesh_view, metrics_of, seen_of
from plots.report.page import inline, page, table_data, write_report
from plots.report.reload import make_reloading
from plots.report.tables_page import html_text
from plots.results.collection import read_collection_results
from plots.results.rows import ResultsError, read_rows
from plots.results.smoothing import read_results
from plots.results.symbols import Heading
from plots.results.vtu import UnstructuredGrid
from plots.study_kinds import outputs_of
from plots.tables.table import Cell, Group, Table
from plots.tests.test_collection import write_collection
from plots.tests.synthetic_polygons import write_polygon_results
from plots.tests.synthetic_results import write_csv, write_results
from plots.tests.test_read_results import InFolder

MOST_BYTES = 8e6


def hexahedra():
    """Two unit cubes side by side."""
    points = np.array([[x, y, z] for x in range(3) for y in range(2) for z in range(2)], dtype=float)
    number = {tuple(point): i for i, point in enumerate(points.astype(int).tolist())}
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [number[x + dx, y, z] for dx in (0, 1) for x, y, z in corners]
    return UnstructuredGrid(points, np.array(cells), np.array([0, 8, 16]), np.array([12, 12]), {},
                            {"mean_ratio": np.array([1.0, 0.25])})


class Views(InFolder):
    def test_surface_and_cut_of_cubes(self):
        grid = hexahedra()
        whole = seen_of(grid)
        self.assertEqual(len(whole.triangles), 10 * 2)  # the face between them is not seen
        self.assertEqual(len(whole.edges), 20)
        left = seen_of(grid, np.array([False, True]))
        self.assertEqual((len(left.triangles), set(left.cells)), (12, {1}))
        areas = np.linalg.norm(np.cross(*(grid.points[whole.triangles[:, k]] - grid.points[whole.triangles[:, 0]]
                                          for k in (1, 2))), axis=1) / 2
        self.assertAlmostEqual(areas.sum(), 10.0)

    def test_metrics_of_a_cube_and_a_sheared_one(self):
        grid = hexahedra()
        grid.points[grid.points[:, 2] == 1, 0] += 1.0  # by 45 degrees: the scaled Jacobian is 1 / sqrt(2)
        metrics = metrics_of(grid)
        np.testing.assert_allclose(metrics["scaled_jacobian"], np.sqrt(0.5), atol=1e-12)
        np.testing.assert_array_equal(metrics["mean_ratio"], [1.0, 0.25])

    def test_view_has_places_and_values(self):
        results = read_results(write_results(self.folder / "r"))
        view = mesh_view(results, "tri")
        self.assertTrue(view["planar"])
        self.assertEqual(set(view["states"]), {"initial", "weighted-laplace", "getme"})
        state = view["states"]["getme"]
        places = np.frombuffer(base64.b64decode(state["points"]), dtype="<u2").reshape(-1, 3)
        self.assertEqual(places.max(), 65535)
        values = np.frombuffer(base64.b64decode(state["values"]["mean_ratio"]), dtype="u1")
        self.assertEqual(sorted(values), [128, 230, 255])  # of 0.5, 0.9, 1
        self.assertEqual([worst["cell"] for worst in state["worst"]["mean_ratio"]], [1, 2, 0])


class Contents(InFolder):
    def test_numbers_are_those_of_the_files(self):
        results = read_results(write_results(self.folder / "r"))
        data = contents(results)
        rows = read_rows(self.folder / "r" / "iterations.csv")
        self.assertEqual(data["curves"]["keys"]["method"], list(rows.text("method")))
        self.assertEqual([value for value in data["curves"]["columns"]["e_max"] if value is not None],
                         [value for value in rows.number("e_max").tolist() if value == value])
        json.dumps(data, allow_nan=False)

    def test_comparison(self):
        first = write_results(self.folder / "a")
        second = write_results(self.folder / "b")
        rows = read_rows(second / "summary.csv").records()
        for row in rows:
            row["q_mean"] = "3.0" if row["method"] == "getme" else row["q_mean"]
        write_csv(second / "summary.csv", list(rows[0]), rows)
        found = comparison(read_results(second), first)
        column = found["headings"].index("q_mean")
        self.assertEqual({row[column]["text"] for row in found["rows"] if row[1]["text"] == "GETMe"}, {"2"})
        self.assertEqual({row[column]["text"] for row in found["rows"] if row[1]["text"] != "GETMe"}, {"="})
        self.assertEqual(ratio("", "2"), {"text": ""})
        write_results(self.folder / "c", meshes=("other",))
        with self.assertRaisesRegex(ResultsError, "compare results of the same study"):
            comparison(read_results(second), self.folder / "c")

    def test_no_markup_of_names_gets_into_the_page(self):
        folder = write_results(self.folder / "r")
        rows = read_rows(folder / "summary.csv").records()
        for row in rows:
            row["status"] = "failed: <!--<script></script><b>&" if row["method"] == "getme" else row["status"]
        write_csv(folder / "summary.csv", list(rows[0]), rows)
        text = page(read_results(folder))
        self.assertNotIn("<b>&", text)
        self.assertIn("failed: &lt;!--&lt;script&gt;&lt;/script&gt;&lt;b&gt;&amp;", text)
        self.assertNotIn("<!--<script", text)

    def test_needs_no_network(self):
        text = page(read_results(write_results(self.folder / "r")))
        outside = re.sub(r"<script.*?</script>", "", text, flags=re.DOTALL)
        self.assertNotRegex(outside, r"(src|href)=[\"']?(https?:)?//")
        self.assertLess(len(text.encode()), MOST_BYTES)

    def test_missing_library_and_folder_are_reported(self):
        folder = write_results(self.folder / "r")
        self.assertEqual(main(["report", str(folder), "--against", str(self.folder / "none")]), 2)
        with mock.patch.object(libraries, "PLOTLY", (self.folder / "plotly.js", "python3-plotly")):
            self.assertEqual(main(["report", str(folder), "--quiet"]), 2)
            self.assertFalse((folder / "report.html").exists())
            with self.assertRaisesRegex(libraries.NoLibrary, "install the Debian package python3-plotly"):
                write_report(read_results(folder))


class TablesPage(InFolder):
    def test_findings_tables_and_figures_stand_in_it(self):
        folder = write_collection(self.folder / "r")
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        text = (folder / "report.html").read_text()
        self.assertIn("<h3>Which method</h3>", text)
        self.assertTrue("<li>Triangles, degree 1, distorted to 0.5: Good leaves 0.500" in text)
        for name in ("table_members", "table_prediction", "table_smoothing", "table_budgets", "table_payoff"):
            self.assertIn(f'<table id="{name}" class="sortable"', text)
        self.assertIn('id="diagram"', text)
        self.assertLess(len(text.encode()), MOST_BYTES)
        self.assertEqual(main(["report", str(folder), "--against", str(folder), "--quiet"]), 2)

    def test_figures_of_other_kinds_are_pictures(self):
        folder = write_polygon_results(self.folder / "p")
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        text = (folder / "report.html").read_text()
        self.assertEqual(text.count("<figure>"), len(list((folder / "figures").glob("*.png"))))
        self.assertGreater(text.count("<figure>"), 0)
        self.assertNotIn('id="diagram"', text)

    def test_plots_have_the_numbers_of_the_collection(self):
        results = read_collection_results(write_collection(self.folder / "r"))
        plots = collection_plots(results)
        json.dumps(plots, allow_nan=False)
        diagrams = {diagram["name"]: diagram for diagram in plots["diagrams"]}
        anytime = {curve["method"]: curve for curve in diagrams["anytime"]["curves"]}
        self.assertEqual((anytime["good"]["y"][-1], anytime["idle"]["y"][-1]), (0.5, 1.0))
        self.assertEqual(anytime["good"]["x"][-1], 2.0)  # solutions on the initial mesh
        self.assertEqual(diagrams["profile"]["curves"][0]["y"][-1], 1.0)
        first, row, column = plots["kinds"][0], plots["qualities"].index("q_mean"), plots["outcomes"].index("h1_error")
        self.assertEqual(first["name"], "Triangles, d = 1")
        self.assertAlmostEqual(first["rho"][row][column], -1.0, places=2)  # equal errors differ by rounding
        self.assertIsNone(first["rho"][plots["qualities"].index("q_min")][column])  # always the same
        self.assertEqual(len(first["qualities"]["q_mean"]), len(first["relative"]["h1_error"]))
        self.assertEqual((min(first["relative"]["h1_error"]), max(first["qualities"]["q_mean"])), (1.0, 0.8))

    def test_of_long_curves_some_steps_are_drawn(self):
        n = 10 * MOST_STEPS
        found = diagram_data(Diagram("x", "y", True, (Curve("m", np.arange(1.0, n + 1), np.arange(1, n + 1) / n),)))
        self.assertEqual(len(found["curves"][0]["x"]), MOST_STEPS)
        self.assertEqual((found["curves"][0]["x"][0], found["curves"][0]["x"][-1], found["curves"][0]["y"][-1]), (1, n, 1))
        self.assertNotIn("lower", found["curves"][0])

    def test_bold_and_code_of_markdown(self):
        self.assertEqual(inline("**cannot be** `a<b` 2 * 3 ** 4"), "<b>cannot be</b> <code>a&lt;b</code> 2 * 3 ** 4")

    def test_answers_come_first(self):
        headings = summary_table(read_results(write_results(self.folder / "r")))["headings"]
        self.assertEqual(headings[:10], ["mesh", "method", "degree", "status", "q_min", "q_mean", "n_invalid", "H1 error", "L2 error",
                                         "CG iterations"])
        self.assertIn("e_H1 (norm of the thesis)", headings[10:])
        self.assertEqual(headings[-2:], ["n_dofs", "n_free"])

    def test_tables_have_the_printed_values(self):
        folder = write_results(self.folder / "r")
        outputs_of(folder).write_page()
        text = (folder / "report.html").read_text()
        self.assertIn("<caption>Table 6.3: A &amp; B_1", text)
        self.assertRegex(text, '<th scope="col">e_max smoothfem</th><th scope="col">e_max thesis</th>')

    def test_marks_and_numbers_of_a_table(self):
        table = Table("s", "t", "", (Heading("Mesh", ""),), ((Cell("tri"),), (Cell(""),)), (), (),
                      (Group(Heading("N", ""), ("",), ((Cell("1,234", "a"),), (Cell("<0.01"),))),), ())
        self.assertEqual(table_data(table), {"headings": ["Mesh", "N"], "rows": [
            [{"text": "tri"}, {"text": "1234ᵃ", "order": 1234.0}], [{"text": "tri"}, {"text": "<0.01", "order": 0.01}]]})

    def test_sentences_become_lists(self):
        self.assertEqual(html_text("# Title\n\nA & b\n\n## More\n\n- one\n- <two>\n"),
                         "<p>A &amp; b</p>\n<h3>More</h3>\n<ul>\n<li>one</li>\n<li>&lt;two&gt;</li>\n</ul>")


class Browser(InFolder):
    """Opened as a reader opens it, in Chromium."""

    @classmethod
    def setUpClass(cls):
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service

        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--enable-unsafe-swiftshader",
                         "--use-angle=swiftshader"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        super().setUp()
        self.results = write_results(self.folder / "r", meshes=("tri", "quad"))
        write_results(self.folder / "before", meshes=("tri", "quad"))
        self.path = write_report(read_results(self.results), against=self.folder / "before")

    def open(self, width=1280, dark=False, height=900):
        command = self.browser.execute_cdp_cmd
        command("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme",
                                                             "value": "dark" if dark else "light"}]})
        command("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1,
                                                       "mobile": False})
        self.browser.get(self.path.as_uri())
        self.assertEqual(self.js("return document.documentElement.dataset.ready"), "yes")

    def js(self, script, *arguments):
        return self.browser.execute_script(script, *arguments)

    def wait_for(self, script, seconds=60):
        """The script's value as soon as it is one."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := self.js(script):
                return found
            time.sleep(0.1)
        raise AssertionError(f"not within {seconds} s: {script}")

    def see_table(self, name):
        """Scrolled to, it can be sorted."""
        self.js("document.getElementById(arguments[0]).scrollIntoView()", name)
        self.wait_for(f"return document.querySelector('#{name}.dataTable')")

    def errors(self):
        return [entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]

    def test_curves_have_the_files_numbers(self):
        self.open()
        names = self.js("return document.getElementById('curve').data.map((trace) => trace.name)")
        self.assertEqual(names, ["GETMe", "weighted-laplace"])
        looks = self.js("return document.getElementById('curve').data.map((t) => [t.line.color, t.line.dash, t.marker.symbol])")
        self.assertEqual(looks, [["#D55E00", "solid", "circle"], ["#0072B2", "10px,3px,2.4px,3px", "diamond"]])
        self.js("const y = document.getElementById('curve-y'); y.value = 'q_mean';"
                "y.dispatchEvent(new Event('change', {bubbles: true}))")
        values = self.js("return Array.from(document.getElementById('curve').data[0].y)")
        rows = read_rows(self.results / "iterations.csv").select(mesh="tri", method="getme", degree="1")
        self.assertEqual(values, rows.number("q_mean").tolist())
        self.js("document.getElementById('log-y').click()")
        self.assertEqual(self.js("return document.getElementById('curve').layout.yaxis.type"), "log")
        self.js("document.querySelector('#curve-methods input').click()")
        self.assertEqual(self.js("return document.getElementById('curve').data.length"), 1)
        self.assertEqual(self.errors(), [])

    def test_tables_sort_and_filter(self):
        self.open()
        self.see_table("summary-table")
        visible = "return [...document.querySelectorAll('#summary-table tbody tr')].map((row) => row.cells[%d].textContent)"
        everything = self.js(visible % 1)
        self.assertEqual(len(everything), 12)
        header = "[...document.querySelectorAll('#summary-table th')].find((th) => th.firstChild.textContent === 'degree')"
        self.js(f"{header}.click()")
        column = self.js(f"return {header}.cellIndex")
        self.assertEqual(self.js(visible % column), ["1"] * 6 + ["2"] * 6)
        self.js(f"{header}.click()")
        self.assertEqual(self.js(visible % column), ["2"] * 6 + ["1"] * 6)
        self.js("const s = document.querySelectorAll('#summary-table th select')[1]; s.value = 'GETMe';"
                "s.dispatchEvent(new Event('change', {bubbles: true}))")
        self.assertEqual(self.js(visible % 1), ["GETMe"] * 4)
        hint = "const p = document.querySelector('#summary .beyond'); return p.hidden ? '' : p.textContent"
        self.assertRegex(self.wait_for(hint), r"^\d+ of \d+ columns are further to the right")
        self.js("document.querySelector('#summary .scroll').scrollLeft = 1e6")
        self.wait_for("return document.querySelector('#summary .beyond').hidden")
        self.assertEqual(self.errors(), [])

    def test_meshes_are_drawn_side_by_side(self):
        self.open()
        self.js("document.getElementById('view').scrollIntoView()")
        traces = self.wait_for("const d = document.getElementById('view').data; return d && d.map((t) => [t.type, t.scene])")
        self.assertEqual([scene for kind, scene in traces if kind == "mesh3d"], ["scene", "scene2"])
        box = self.js("return document.getElementById('view').layout.scene.aspectratio")
        self.assertAlmostEqual(box["x"] / box["y"], 3 / 1.8, places=2)  # as wide and as high as the mesh
        colours = self.js("return Array.from(document.getElementById('view').data[0].intensity)")
        self.assertEqual(len(colours), 1 + 2 + 3)  # triangles of a triangle, a quadrilateral, a pentagon
        self.assertEqual(len(self.js("return [...document.querySelectorAll('#worst table')].map((t) => t.rows.length)")), 2)
        self.assertEqual(self.errors(), [])

    def test_fits_a_narrow_screen_is_dark_where_asked_and_prints(self):
        self.open(width=400, dark=True)
        self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 400)
        ground = "return getComputedStyle(document.body).backgroundColor"
        self.assertEqual(self.js(ground), "rgb(22, 24, 27)")
        self.js("document.getElementById('theme').click()")
        self.assertEqual(self.js(ground), "rgb(255, 255, 255)")
        self.assertEqual(self.errors(), [])

    def test_what_has_not_been_seen_is_printed(self):
        self.open(height=200)
        self.assertFalse(self.js("return Boolean(document.getElementById('view').data)"))
        printed = base64.b64decode(self.browser.execute_cdp_cmd("Page.printToPDF", {})["data"])
        self.assertTrue(printed.startswith(b"%PDF"))
        self.assertTrue(self.js("return document.getElementById('view').data.length"))
        self.assertEqual(self.errors(), [])

    def test_a_collection_sorts_filters_and_fits(self):
        folder = write_collection(self.folder / "many")
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        self.path = folder / "report.html"
        self.open(width=400, dark=True)
        self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 400)
        self.see_table("table_payoff")
        rows = "return [...document.querySelectorAll('#table_payoff tbody tr')].map((row) => row.cells[0].textContent)"
        self.assertEqual(set(self.js(rows)), {"triangles"})
        self.js("const s = document.querySelectorAll('#table_payoff th select')[1]; s.value = '2';"
                "s.dispatchEvent(new Event('change', {bubbles: true}))")
        self.assertEqual(set(self.js(rows.replace("cells[0]", "cells[1]"))), {"2"})
        self.assertEqual(self.errors(), [])

    def test_a_collection_has_plots_to_choose(self):
        folder = write_collection(self.folder / "many")
        self.assertEqual(main([str(folder), "--quiet"]), 0)
        self.path = folder / "report.html"
        self.open()
        change = "const e = document.getElementById(arguments[0]); e.value = arguments[1];" \
                 "e.dispatchEvent(new Event('change', {bubbles: true}))"
        self.js(change, "diagram-name", "anytime")
        traces = self.js("return document.getElementById('diagram').data.map((t) => [t.name, t.y[t.y.length - 1]])")
        self.assertEqual([trace for trace in traces if "quartiles" not in trace[0]], [["Good", 0.5], ["Idle", 1]])
        self.assertEqual(self.js("return document.getElementById('diagram').layout.xaxis.type"), "log")
        self.js("document.getElementById('diagram-log-x').click()")
        self.assertEqual(self.js("return document.getElementById('diagram').layout.xaxis.type"), "linear")
        self.js("document.querySelector('#diagram-methods input').click()")
        self.assertEqual(self.js("return document.getElementById('diagram').data.length"), 2)  # a curve and its band
        self.js(change, "quality", "q_mean")
        self.js(change, "kind", "Triangles, d = 2")
        records = self.js("const d = document.getElementById('records').data[0]; return [d.x, d.y, d.text]")
        self.assertEqual((max(records[0]), min(records[1])), (0.8, 1))
        self.assertEqual({name[0] for name in records[2]}, {"m"})
        rows = self.js("const d = document.getElementById('correlations').data[0]; return d.customdata.map((r, i) => [r[1][0], d.z[i][1]])")
        self.assertEqual([quality for quality, _ in rows], ["q_star_min", "q_mean"])  # q_min is always the same
        self.assertAlmostEqual(rows[1][1], -1, places=2)
        self.js("document.getElementById('correlations').emit('plotly_click', {points: [{customdata: ['q_min', 'l2_error']}]})")
        self.assertEqual(self.js("return [document.getElementById('quality').value, document.getElementById('outcome').value]"),
                         ["q_min", "l2_error"])
        self.assertEqual(self.js("return [...document.querySelectorAll('#figures [aria-label=\"\"]')].length"), 0)
        self.js("document.getElementById('theme').click()")
        self.assertEqual(self.js("return document.getElementById('records').layout.paper_bgcolor"), "#16181b")
        self.assertEqual(self.errors(), [])

    def test_an_open_page_shows_its_next_version_once(self):
        path = self.folder / "open.html"

        def write(words):
            path.write_text(f"<!DOCTYPE html><html><body>{words}</body></html>", encoding="utf-8")
            make_reloading(path)
        write("first")
        self.browser.get(path.as_uri())
        self.js("window.isFirst = true")
        write("second")
        self.wait_for("return document.body.textContent.startsWith('second')", seconds=20)
        self.js("window.isSecond = true")
        time.sleep(1.2)  # it has looked again, and found no other
        self.assertEqual(self.js("return [window.isFirst, window.isSecond]"), [None, True])
        self.assertEqual(self.errors(), [])

    def test_everything_that_can_be_set_has_a_name(self):
        self.open()
        nameless = self.js("return [...document.querySelectorAll('select, input, button')].filter((e) => "
                           "!(e.getAttribute('aria-label') || (e.labels && e.labels.length) || e.textContent.trim())).length")
        self.assertEqual(nameless, 0)
        self.assertEqual(self.js("return document.documentElement.lang"), "en")
        self.assertEqual(self.js("return [...document.querySelectorAll('table')].filter((t) => !t.caption).length"), 0)
