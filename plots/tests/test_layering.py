# SPDX-License-Identifier: GPL-3.0-or-later
"""Subpackages import one way: `results` imports no other, and no two import each other."""

import ast
import unittest
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
# `claims` imports `tables`, as claims are shown as a table.
ALLOWED_IMPORTS = {"results": set(), "statistics": set(), "collections": {"results", "statistics"},
                   "tables": {"results", "collections"}, "figures": {"results", "collections", "statistics"},
                   "claims": {"results", "tables"}, "manual": {"results", "tables", "claims", "collections", "statistics"},
                   "report": {"results", "collections", "tables", "claims", "figures"}}


def imported_subpackages(path):
    """Returns the subpackages that a module imports from, anywhere in the file."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level >= 2:
            found.add((node.module or "").partition(".")[0])
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("plots"):
            found.add("the package by its name")
    return found


class Files(unittest.TestCase):
    def test_every_file_names_its_licence(self):
        for path in PACKAGE.rglob("*.py"):
            self.assertTrue(path.read_text(encoding="utf-8").startswith(
                "# SPDX-License-Identifier: GPL-3.0-or-later\n"), path)


class Layering(unittest.TestCase):
    def test_every_subpackage_is_listed(self):
        subpackages = {path.parent.name for path in PACKAGE.glob("*/__init__.py")} - {"tests"}
        self.assertEqual(subpackages, set(ALLOWED_IMPORTS))

    def test_imports_go_one_way(self):
        for subpackage, allowed in ALLOWED_IMPORTS.items():
            for path in (PACKAGE / subpackage).glob("*.py"):
                self.assertLessEqual(imported_subpackages(path), allowed, path)
