# SPDX-License-Identifier: GPL-3.0-or-later
"""Generated blocks: parts of a Markdown page between two comments, which a program writes."""

from ..results.rows import ResultsError


def begin(name):
    """The line before a block."""
    return f"<!-- begin {name}: made by python3 -m plots.manual -->"


def end(name):
    """The line after a block."""
    return f"<!-- end {name} -->"


def updated(path, made):
    """The text of a page with its blocks replaced; made: {name of a block: Markdown}.

    Raises ResultsError if the page does not have a block."""
    text = path.read_text(encoding="utf-8")
    for name, block in made.items():
        before, first, rest = text.partition(begin(name) + "\n")
        _, last, after = rest.partition(end(name) + "\n")
        if not first or not last:
            raise ResultsError(f"{path}: the lines `{begin(name)}` and `{end(name)}` are missing.")
        text = f"{before}{first}\n{block.strip()}\n\n{last}{after}"
    return text


def table(heading, rows, align=""):
    """Lines of a Markdown table; align: one of "lr" for each column."""
    marks = {"l": ":--", "r": "--:"}
    rule = [marks[mark] for mark in (align or "l" * len(heading))]
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in (heading, rule, *rows))
