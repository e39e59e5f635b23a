# SPDX-License-Identifier: GPL-3.0-or-later
"""What `./run reference` refuses: one sentence, exit code 2, nothing written."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


class MakeReference(unittest.TestCase):
    def refused(self, source, work, *words):
        """What the script says of words behind the paths, as ./run has them."""
        command = [sys.executable, "-B", SOURCE / "launcher" / "make_reference.py", source, "no-program", work, *words]
        found = subprocess.run(command, capture_output=True, text=True, check=False,
                               env={**os.environ, "PYTHONPATH": str(SOURCE)})
        self.assertEqual((found.returncode, found.stdout), (2, ""), found.stderr)
        self.assertEqual(len(found.stderr.splitlines()), 1, found.stderr)
        self.assertEqual(list(work.iterdir()), [])
        return found.stderr

    def test_studies_that_there_are_not_or_that_have_no_reference(self):
        with tempfile.TemporaryDirectory() as folder:
            source, work = Path(folder) / "source", Path(folder) / "work"
            source.mkdir()
            work.mkdir()
            (source / "studies").symlink_to(SOURCE / "studies")
            for words in (("nosuch",), ("--compare", "nosuch"), ("nosuch", "--compare")):
                self.assertRegex(self.refused(source, work, *words), "^reference: there is no study 'nosuch'.*ring")
            self.assertRegex(self.refused(source, work, "--compare", "ring"), "^reference: 'ring' has no reference")
            self.assertEqual([path.name for path in source.iterdir()], ["studies"])


if __name__ == "__main__":
    unittest.main()
