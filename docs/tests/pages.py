# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages of the manual and their fenced blocks."""

import re
from dataclasses import dataclass

from launcher.tests.build_folder import SOURCE

DOCS = SOURCE / "docs"
# A line with a file's name before a fenced block, and the block with its language.
BLOCK = re.compile(r"(?:^`(?P<file>[^`\n]+)`:\n\n)?^```(?P<language>[^\n]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block of a page; file: the name in the line before it, or None."""

    file: str
    language: str
    text: str


def pages():
    """Returns {name: path} of README.md, CONTRIBUTING.md and the manual's pages; a name is, for example, how-to/pandas."""
    found = {path.stem: path for path in (SOURCE / "README.md", SOURCE / "CONTRIBUTING.md")}
    found |= {path.relative_to(DOCS).with_suffix("").as_posix(): path for path in sorted(DOCS.rglob("*.md")) if path.name != "doxygen.md"}
    return found


def blocks(path):
    """Returns the fenced blocks of a page."""
    return [Block(*match.group("file", "language", "text")) for match in BLOCK.finditer(path.read_text(encoding="utf-8"))]


def has_commands(path):
    """Returns True if a page has commands that are run."""
    return any(block.language == "sh" for block in blocks(path))


def test_name(name):
    """Returns the name of the test of a page."""
    return "test_" + re.sub(r"\W", "_", name).lower()
