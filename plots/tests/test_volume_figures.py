# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of volume studies: which are made, and of what."""

import contextlib
import io
from dataclasses import replace
from unittest import mock

import numpy as np

from plots.__main__ import main
from plots.figures import style
from plots.figures.element_types import counts_of_types, draw_element_types, is_mixed, type_colours
from plots.figures.histograms import draw_histogram_differences, draw_histograms
from plots.figures.meshes import columns_of
from plots.figures.pages import pages
from plots.figures.sections import detail_of
from plots.figures.smoothing_study import read_grids
from plots.figures.volume_geometry import Cut, view_of, widest_cut
from plots.results.smoothing import read_results
from plots.results.vtu import UnstructuredGrid, read_vtu
from plots.tests.rendering import needs_rendering
from plots.tests.synthetic_results import write_vtu
from plots.tests.synthetic_volume import box, write_volume_results, write_volume_vtu
from plots.tests.test_read_results import InFolder

class Geometry(InFolder):
    def grid(self, kind):
        write_volume_vtu(self.folder / "mesh.vtu", kind)
        return read_vtu(self.folder / "mesh.vtu")

    def test_kinds_of_cells(self):
        for kind, n_cells in (("tet", 6 * 24), ("hex", 24)):
            grid = self.grid(kind)
            self.assertTrue(grid.is_volume and not grid.is_planar)
            self.assertEqual(len(grid.types), n_cells)

    def test_widest_cut_goes_through_the_longest_sides(self):
        cut = widest_cut(self.grid("tet"))  # the box is 4 x 2 x 3
        self.assertEqual((cut.origin, cut.normal), ((2.0, 1.0, 1.5), (0, -1, 0)))

    def test_cut_keeps_whole_cells_of_one_side(self):
        grid = self.grid("hex")
        cut = Cut((1.2, 0, 0), (1, 0, 0))
        self.assertEqual(cut.kept(grid).sum(), 6)  # the centres of the second layer are at x = 1.5
        self.assertEqual(cut.crossed(grid).sum(), 6)
        middle = Cut((2, 1, 1), (0, 0, 1))
        self.assertEqual((middle.spacing(grid), middle.seen_spacing(grid)), (1.0, 1.0))

    def test_few_large_cells_are_what_is_seen(self):
        grid = self.grid("hex")
        points = grid.points.copy()
        points[points[:, 0] == 4, 0] = 40.0  # the first edge of a cell is along x: 1, 1, 1 and 37
        middle = Cut((2, 1, 1), (0, 0, 1))
        graded = replace(grid, points=points)
        self.assertEqual((middle.spacing(graded), middle.seen_spacing(graded)), (1.0, 37.0))

    def test_a_detail_is_smaller_than_the_whole(self):
        grid = self.grid("hex")
        cut = Cut((2, 1, 1), (0, 0, 1))
        view = cut.view(grid)
        for cells, width in ((1, 1.0), (100, 0.5 * min(view.width, view.height))):
            self.assertAlmostEqual(cut.densest_window(grid, view, cells)[1], width)

    def test_a_detail_of_a_narrow_cut_is_filled(self):
        points, cells = box("hex", (60, 2, 2))
        grid = UnstructuredGrid(points=points, connectivity=cells.ravel(), offsets=8 * np.arange(len(cells) + 1),
                                types=np.full(len(cells), 12), point_data={}, cell_data={})
        cut = Cut((30, 1, 1), (0, 0, 1))
        view = replace(cut.view(grid), height=40.0)  # of a solid that is high elsewhere
        centre, width = detail_of(grid, cut, view)
        self.assertLessEqual(width, 6.0)  # of 16 cells an eighth would be filled
        self.assertLess(abs(centre[1] - 1), 0.6)
        thick, cells = box("hex", (60, 20, 2))
        grid = replace(grid, points=thick, connectivity=cells.ravel(), offsets=8 * np.arange(len(cells) + 1),
                       types=np.full(len(cells), 12))
        self.assertEqual(detail_of(grid, cut, replace(view, width=60.0))[1], 16.0)

    def test_view_holds_all_points(self):
        points = self.grid("tet").points
        view = view_of(points, (-1, -2, 0.5)).fitted(1.7)
        self.assertAlmostEqual(view.width / view.height, 1.7)
        flat = view.flattened(points) - view.flattened([view.centre])
        self.assertTrue((np.abs(flat) <= (0.5 * view.width, 0.5 * view.height)).all())

    def test_pages(self):
        meshes = ["a", "a-distorted", "b", "b-distorted", "c"]
        for most, expected in ((5, [""]), (4, ["_a", "_b", "_c"]),
                               (1, ["_a", "_a-distorted", "_b", "_b-distorted", "_c"])):
            found = pages(meshes, lambda group: len(group) <= most)
            self.assertEqual(list(found), expected)
            self.assertEqual([mesh for group in found.values() for mesh in group], meshes)

    def test_rows_are_about_equally_full(self):
        for n_panels, most, with_free, expected in ((4, 4, False, 4), (4, 4, True, 3), (5, 4, False, 3),
                                                    (5, 5, False, 5), (6, 5, False, 3), (8, 5, False, 4)):
            self.assertEqual(columns_of([("", [1] * n_panels)], most, with_free), expected)


class ElementTypes(InFolder):
    def mixed(self):
        """Six tetrahedra and a hexahedron for each brick of a box."""
        parts = [box(kind) for kind in ("tet", "hex")]
        (points, _), sizes = parts[0], [np.full(len(cells), cells.shape[1]) for _, cells in parts]
        return UnstructuredGrid(
            points=points, connectivity=np.concatenate([cells.ravel() for _, cells in parts]),
            offsets=np.concatenate(([0], np.cumsum(np.concatenate(sizes)))),
            types=np.repeat([10, 12], [len(cells) for _, cells in parts]), point_data={}, cell_data={})

    def test_counts_and_colours(self):
        grid = self.mixed()
        self.assertTrue(is_mixed(grid))
        self.assertEqual(counts_of_types(grid), "144 tetrahedra, 24 hexahedra")
        colours = type_colours(grid)
        self.assertEqual(len(np.unique(colours, axis=0)), 2)
        self.assertEqual(len(np.unique(colours[grid.types == 12], axis=0)), 1)

    @needs_rendering
    def test_picture_of_each_mesh_as_a_whole_and_in_detail(self):
        style.apply_style()
        grid = self.mixed()
        with mock.patch("plots.figures.sections.IMAGE_DPI", 60):
            figure = draw_element_types([("Box", [("Initial", grid), ("GETMe", grid)])])
        captions = [axes.texts[0].get_text() for axes in figure.axes]
        self.assertEqual(captions, ["Initial", "GETMe", "Initial, detail", "GETMe, detail"])
        self.assertEqual([text.get_text() for text in figure.legends[0].get_texts()],
                         ["Tetrahedron", "Hexahedron"])
        style.pyplot.close(figure)


class ParallelRuns(InFolder):
    def test_the_same_mesh_is_shown_once(self):
        methods = ("getme", "getme-parallel", "own-parallel")
        results = read_results(write_volume_results(self.folder / "r", "own", ("hex",), methods))
        _, volume, _ = read_grids(results, self.fail)
        self.assertEqual([method for _, method in volume], ["initial", "getme", "own-parallel"])


class Histograms(InFolder):
    def test_every_cell_is_counted_once(self):
        results = read_results(write_volume_results(self.folder / "r"))
        _, volume, _ = read_grids(results, self.fail)
        style.apply_style()
        qualities = {key: grid.cell_data["mean_ratio"] for key, grid in volume.items()}
        figure = draw_histograms(results, results.meshes, qualities)
        for axes, n_cells in zip(figure.axes, (6 * 24, 24)):
            self.assertEqual([patch.get_data().values.sum() for patch in axes.patches], [n_cells] * 5)
            self.assertEqual({patch.get_data().values[0] for patch in axes.patches}, {1})
        style.pyplot.close(figure)

    def test_differences_are_those_of_the_distorted_mesh(self):
        results = read_results(write_volume_results(self.folder / "r", "own", ("hex", "hex-distorted"),
                                                    ("getme", "own")))
        qualities = {("hex", "initial"): [0.5, 0.99, 1.0], ("hex-distorted", "initial"): [-0.1, 0.5, 0.5],
                     ("hex", "getme"): [0.9, 0.9, 0.9], ("hex-distorted", "getme"): [0.9, 0.9, 0.9],
                     ("hex", "own"): [0.5, 0.5, 0.5]}  # without a result on the distorted mesh
        style.apply_style()
        figure = draw_histogram_differences(results, [("hex", "hex-distorted")], qualities)
        lines = {line.get_label(): line for line in figure.axes[0].get_lines()}
        middles, counts = lines["initial"].get_data()
        self.assertEqual({f"{q:.2f}": n for q, n in zip(middles, counts) if n},
                         {"0.02": 1, "0.52": 1, "0.98": -2})
        self.assertFalse(lines["getme"].get_ydata().any())
        self.assertNotIn("own", lines)
        self.assertEqual(figure.axes[0].get_yscale(), "linear")
        style.pyplot.close(figure)

    def test_small_differences_are_seen_next_to_large_ones(self):
        results = read_results(write_volume_results(self.folder / "r", "own", ("hex", "hex-distorted"),
                                                    ("getme", "own")))
        qualities = {(mesh, method): [0.9] * 100 for mesh in results.meshes for method in ("getme", "own")}
        qualities["hex-distorted", "own"] = [0.5] * 100
        qualities["hex-distorted", "getme"] = [0.9] * 98 + [0.5] * 2
        style.apply_style()
        figure = draw_histogram_differences(results, [("hex", "hex-distorted")], qualities)
        axes = figure.axes[0]
        self.assertEqual(axes.get_yscale(), "symlog")
        heights = axes.transAxes.inverted().transform(axes.transData.transform([(0, 0), (0, 2), (0, 100)]))[:, 1]
        self.assertGreater(heights[1] - heights[0], 0.02)  # on a linear axis 2 of 200 would be 0.01
        self.assertLess(heights[2], 1)
        style.pyplot.close(figure)


class VolumeStudy(InFolder):
    def run_main(self, folder):
        errors = io.StringIO()
        # Coarse pictures: what they look like is not looked at here.
        with contextlib.redirect_stderr(errors), mock.patch("plots.figures.style.DPI", 40), \
                mock.patch("plots.figures.sections.IMAGE_DPI", 100), \
                mock.patch("plots.figures.solid.IMAGE_DPI", 100):
            self.assertEqual(main([str(folder), "--quiet", "--format", "png"]), 0, errors.getvalue())
        return errors.getvalue(), {path.stem for path in folder.glob("figures/*.png")}

    @needs_rendering
    def test_figures_of_the_thesis(self):
        folder = write_volume_results(self.folder / "r")
        errors, names = self.run_main(folder)
        self.assertEqual(errors, "")
        self.assertEqual(names, {
            "figure_6_5_model", "figure_6_6_meshes", "figure_6_6_meshes_detail",
            "figure_6_7_histograms", "figure_6_7_histograms_log", "figure_6_8_history",
            "figure_6_8_history_log_time", "figure_history_d1", "figure_history_d2", "figure_history_norms_d1",
            "figure_history_norms_d2", "figure_plane_sections_tet", "figure_plane_sections_hex"})

    @needs_rendering
    def test_own_study_of_both_dimensions_with_a_missing_file(self):
        folder = write_volume_results(self.folder / "r", "own", ("hexes", "tets"), ("getme",))
        (folder / "meshes" / "hexes_initial.vtu").unlink()
        write_vtu(folder / "meshes" / "tets_initial.vtu")
        errors, names = self.run_main(folder)
        self.assertIn("hexes_initial.vtu", errors)
        self.assertLessEqual({"model", "model_volume", "meshes", "meshes_volume", "history",
                              "meshes_volume_detail", "plane_sections_volume_tets", "histograms"},
                             names)

    def test_without_a_server_the_other_figures_are_made(self):
        folder = write_volume_results(self.folder / "r")
        with mock.patch("shutil.which", return_value=None), mock.patch.dict("os.environ", XDG_CACHE_HOME=str(self.folder)):
            errors, names = self.run_main(folder)
        self.assertEqual(sorted(line.partition(":")[0] for line in errors.splitlines()),
                         ["No pictures of volume meshes and surfaces", "No report.html"])  # both need a program
        self.assertIn("No pictures of volume meshes and surfaces", errors)
        self.assertIn("figure_6_7_histograms", names)
        self.assertNotIn("figure_6_6_meshes", names)
