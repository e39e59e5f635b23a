# SPDX-License-Identifier: GPL-3.0-or-later
"""A folder with examples of smoothers (mine.py), and the messages for smoothers that violate rules."""

import os
import tempfile
import unittest
from pathlib import Path

SMOOTHERS = Path(__file__).with_name("mine.py").read_text(encoding="utf-8")
CHEATS = {"MovesFixed": "MovesFixed: step has moved the fixed node", "NotFinite": "NotFinite: step has set a coordinate of node",
          "WrongShape": "WrongShape: step returned an array of the shape", "ReturnsText": "ReturnsText: step returned no array",
          "Raises": r"Raises: step failed: mine.py:\d+: ZeroDivisionError: division by zero",
          "Exits": "Exits: step failed: mine.py:.*SystemExit", "Keeps": "Keeps: step keeps mesh.points",
          "Surrogate": r"Surrogate: step failed: mine.py:\d+: ValueError: \?", "TooMany": "max_iterations is -5, but has to be from 1",
          "Huge": "parameter n has the default 10+; numbers have to be finite", "NotANumber": "parameter x has the default nan",
          "FailsToBegin": r"FailsToBegin: initialize failed: mine.py:\d+: ValueError: assignment destination is read-only"}


class InAFolder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        (self.folder / "mine.py").write_text(SMOOTHERS)
        here = os.getcwd()
        self.addCleanup(os.chdir, here)
        os.chdir(self.folder)
