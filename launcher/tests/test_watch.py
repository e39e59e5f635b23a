# SPDX-License-Identifier: GPL-3.0-or-later
"""Watching a study: it runs again when one of its files changes."""

import os
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

from launcher.tests.build_folder import SMOOTHFEM, environment

STUDY = """set title = Watched
set meshes = square
set methods = half
set degrees =
set timing runs = 1
subsection mesh square
  set domain = square
  set edge scale = 12
  set distort to = 0.7
end
subsection method half
  set type = python:half.py:Half
end
"""
SMOOTHER = """class Half:
    def step(self, mesh):
        mesh.points[mesh.free] += {}
"""
LONGEST = 60.0  # seconds that a run may take on a busy machine


class Watch(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "own.prm").write_text(STUDY)
        (self.folder / "half.py").write_text(SMOOTHER.format("1e-4"))

    def wait_for(self, text, count):
        """Waits until the log has the text so often."""
        end = time.monotonic() + LONGEST
        while self.log().count(text) < count:
            self.assertLess(time.monotonic(), end, self.log())
            time.sleep(0.05)

    def log(self):
        return (self.folder / "log").read_text()

    def test_runs_again_after_each_change_and_ends_by_ctrl_c(self):
        with open(self.folder / "log", "w", encoding="utf-8") as log:
            watched = subprocess.Popen([SMOOTHFEM, "study", "own.prm", "--watch", "--no-figures"], cwd=self.folder, stdout=log, stderr=log,
                                       start_new_session=True, env=environment())
        self.addCleanup(watched.wait)
        self.addCleanup(lambda: watched.poll() is None and os.killpg(watched.pid, signal.SIGKILL))
        self.wait_for("waiting for a change of", 1)
        self.assertIn("one of 2 files: own.prm half.py (Ctrl-C ends)", self.log())
        (self.folder / "half.py").write_text(SMOOTHER.format("2e-4"))
        self.wait_for("waiting for a change of", 2)
        self.assertIn("half.py has changed", self.log())
        # A study that is wrong for a moment does not end it.
        (self.folder / "own.prm").write_text(STUDY + "nonsense\n")
        self.wait_for("waiting for a change of", 3)
        self.assertIn("'nonsense' is not a line of a study file", self.log())
        (self.folder / "own.prm").write_text(STUDY.replace("Watched", "Changed"))
        self.wait_for("waiting for a change of", 4)
        self.assertIn("title was 'Watched' and is 'Changed'", self.log())
        os.killpg(watched.pid, signal.SIGINT)
        self.assertEqual(watched.wait(LONGEST), 130)


if __name__ == "__main__":
    unittest.main()
