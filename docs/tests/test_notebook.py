# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the notebook of the manual by Jupyter's kernel."""

import importlib.util
import os
import tempfile
import unittest
from unittest import mock

from launcher.tests.build_folder import BUILD

from .pages import DOCS

HAS_JUPYTER = all(importlib.util.find_spec(name) for name in ("nbclient", "nbformat", "ipykernel"))

NOTEBOOK = DOCS / "tutorials" / "notebook.ipynb"
SECONDS = 120  # for each cell, while other tests run, too


@unittest.skipUnless(HAS_JUPYTER, "SKIPPED: python3-nbconvert or python3-ipykernel is not installed")
class Notebook(unittest.TestCase):
    def test_runs_and_shows_pictures(self):
        import nbclient
        import nbformat

        notebook = nbformat.read(NOTEBOOK, as_version=4)
        nbformat.validate(notebook)
        cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
        for cell in cells:
            self.assertFalse(cell.outputs or cell.execution_count, "the repository has notebooks without output")
        with tempfile.TemporaryDirectory() as folder:
            own = {"PYTHONPATH": str(BUILD / "lib" / "python3" / "dist-packages"), "PYDEVD_DISABLE_FILE_VALIDATION": "1",
                   "MPLBACKEND": "module://matplotlib_inline.backend_inline",
                   **{name: folder for name in ("IPYTHONDIR", "JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR")}}
            with mock.patch.dict(os.environ, own):
                nbclient.NotebookClient(notebook, timeout=SECONDS, kernel_name="python3", resources={"metadata": {"path": folder}}).execute()
        outputs = [output for cell in cells for output in cell.outputs]
        pictures = [output for output in outputs if "image/png" in output.get("data", {})]
        printed = "".join(output.get("text", "") for output in outputs)
        self.assertEqual(len(pictures), 4)
        self.assertNotIn("Warning", printed)
        errors = [float(line.split()[3]) for line in printed.splitlines() if "H1 error" in line]
        self.assertLess(max(errors[1:]), 0.6 * errors[0])


if __name__ == "__main__":
    unittest.main()
