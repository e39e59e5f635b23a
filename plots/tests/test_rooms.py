# SPDX-License-Identifier: GPL-3.0-or-later
"""Which room of the package may know which: results knows none, and the others know no way back."""

import ast
import unittest
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
# Claims are shown as a table.
KNOWN_ROOMS = {"results": set(), "statistics": set(), "collections": {"results", "statistics"},
               "tables": {"results", "collections"}, "figures": {"results", "collections", "statistics"},
               "claims": {"results", "tables"}, "manual": {"results", "tables", "claims"},
               "report": {"results", "collections", "tables", "claims", "figures"}}


def imported_rooms(path):
    """The rooms from which a module of a room imports, wherever in the file."""
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


class Rooms(unittest.TestCase):
    def test_every_room_is_known(self):
        rooms = {path.parent.name for path in PACKAGE.glob("*/__init__.py")} - {"tests"}
        self.assertEqual(rooms, set(KNOWN_ROOMS))

    def test_imports_go_one_way(self):
        for room, known in KNOWN_ROOMS.items():
            for path in (PACKAGE / room).glob("*.py"):
                self.assertLessEqual(imported_rooms(path), known, path)
