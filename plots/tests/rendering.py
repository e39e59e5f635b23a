# SPDX-License-Identifier: GPL-3.0-or-later
"""Conditions of tests that need rendering."""

import importlib.util
import shutil
import unittest

MISSING = [f"{name} is not installed" for name in ("vtkmodules", "pyvirtualdisplay")
           if importlib.util.find_spec(name) is None]
MISSING += [] if shutil.which("Xvfb") else ["Xvfb is not installed"]

needs_rendering = unittest.skipIf(MISSING, f"nothing can be rendered off screen: {', '.join(MISSING)}")
