# SPDX-License-Identifier: GPL-3.0-or-later
"""Content of a rendered picture, the server it is drawn with, and messages without a server."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import warnings
from pathlib import Path
from unittest import mock

import numpy as np

from plots.figures.render import Scene, render
from plots.figures.virtual_display import NoDisplay, virtual_display
from plots.figures.volume_geometry import Cut, view_of
from plots.results.vtu import read_vtu
from plots.tests.rendering import needs_rendering
from plots.tests.synthetic_volume import write_volume_vtu
from plots.tests.test_read_results import InFolder

SECONDS_TO_END = 10
PACKAGE = Path(__file__).resolve().parents[1]

# Says its own number, that of its display, and that of the process that draws, which then waits.
WAITING = """
import os, time
from plots.figures import render

def wait(scene):
    print(os.getppid(), os.environ["DISPLAY"].removeprefix(":"), os.getpid(), flush=True)
    time.sleep(100)

render.draw_scene = wait
render.render([1])
"""


def answers(number):
    """True if an X server listens on this display. Linux has its socket by name even where nobody may make the file."""
    with socket.socket(socket.AF_UNIX) as connection:
        return connection.connect_ex(f"\0/tmp/.X11-unix/X{number}") == 0


def runs(process):
    """True if there is a process of this number; one that nobody has waited for does not run."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def comes_true(condition):
    """True if a condition is met within some seconds."""
    end = time.monotonic() + SECONDS_TO_END
    while not condition() and time.monotonic() < end:
        time.sleep(0.02)
    return condition()


@needs_rendering
class Rendering(InFolder):
    def test_colours_of_cut_faces_only(self):
        write_volume_vtu(self.folder / "mesh.vtu", "hex")
        grid = read_vtu(self.folder / "mesh.vtu")
        cut = Cut((2.2, 1, 1.5), (1, 0, 0))
        red = np.tile(np.array([[255, 0, 0]], dtype=np.uint8), (len(grid.types), 1))
        reds = []
        views = [view_of(grid.points, direction, margin=0) for direction in ((1, 0, 0), (-1, 0, 0))]
        scenes = [Scene(grid, view, (60, 40), cells=cut.kept(grid), cell_colours=red, ambient=1.0,
                        plain_colour=(0, 0, 1)) for view in views]
        for picture in render(scenes):
            self.assertEqual(picture.shape, (40, 60, 3))
            reds.append(np.mean((picture == (255, 0, 0)).all(axis=2)))
            self.assertFalse((picture == (0, 0, 0)).all(axis=2).any())
        # The box fills the height of the picture and the width of 2 : 3.
        self.assertAlmostEqual(reds[0], 40 * 2 / 3 / 60, delta=0.05)
        self.assertEqual(reds[1], 0)

    def test_server_ends_and_environment_is_restored(self):
        with mock.patch.dict(os.environ, {"DISPLAY": ":4321"}):
            with virtual_display():
                number = os.environ["DISPLAY"].removeprefix(":")
                self.assertTrue(answers(number))
            self.assertEqual(os.environ["DISPLAY"], ":4321")
        self.assertFalse(answers(number))

    def test_a_crash_is_one_sentence(self):
        with mock.patch("plots.figures.render.draw_scene", os._exit):
            with self.assertRaisesRegex(NoDisplay, "gave up"):
                render([1])

    def test_a_killed_python_leaves_nothing_behind(self):
        for number in (signal.SIGTERM, signal.SIGKILL):
            with subprocess.Popen([sys.executable, "-c", WAITING], cwd=PACKAGE.parent, text=True,
                                  stdout=subprocess.PIPE) as python:
                parent, display, drawer = map(int, python.stdout.readline().split())
                self.assertEqual(parent, python.pid)
                self.assertTrue(answers(display) and runs(drawer))
                python.send_signal(number)
                python.wait()
                self.assertTrue(comes_true(lambda: not answers(display)), number)
                self.assertTrue(comes_true(lambda: not runs(drawer)), number)


class ServersThatDoNotStart(InFolder):
    def setUp(self):
        super().setUp()
        # PyVirtualDisplay leaves the pipes of a server that has ended to the garbage collector.
        self.enterContext(warnings.catch_warnings(action="ignore", category=ResourceWarning))

    def programs(self, xvfb, *others):
        """A folder that stands for PATH: Xvfb as a shell script, and other programs as they are."""
        folder = self.folder / str(len(list(self.folder.iterdir())))
        folder.mkdir()
        (folder / "Xvfb").write_text(f"#!/bin/sh\n{xvfb}\n")
        (folder / "Xvfb").chmod(0o755)
        for name in others:
            (folder / name).symlink_to(shutil.which(name))
        return mock.patch.dict(os.environ, {"PATH": str(folder)})

    def test_one_sentence_each(self):
        ends_at_once = '[ "$1" = -help ] && echo -displayfd >&2; exit 1'
        modules = {"pyvirtualdisplay.xvfb": None}
        for broken, said in (
                (mock.patch("shutil.which", return_value=None), "not installed"),
                (mock.patch.dict(sys.modules, modules), "python3-pyvirtualdisplay"),
                (self.programs(ends_at_once), "cannot be started .*setpriv"),
                (self.programs(ends_at_once, "setpriv"), "did not start"),
                (self.programs("exit 0", "setpriv"), "did not start")):
            with broken, self.assertRaisesRegex(NoDisplay, rf"^[^\n]*{said}[^\n]*$"), virtual_display():
                self.fail("there is no server")
