# SPDX-License-Identifier: GPL-3.0-or-later
"""Notes on known deviations below a table, and the cells they belong to."""


class Notes:
    """Gives the notes on known deviations letters in the order in which cells ask for them."""

    def __init__(self, deviations, pairs):
        self.pairs = pairs
        meshes = {computed.get("mesh", "") for computed, _ in pairs} | {"*"}
        deviations = [d for d in deviations if d["mesh"] in meshes]
        self.cell_notes = [d for d in deviations if d["method"] != "*"]
        columns = {name for _, printed in pairs for name, field in printed.items() if field} | {"*"}
        self.table_notes = list(dict.fromkeys(d["note"] for d in deviations if d["method"] == "*"
                                              and d["column"] in columns))
        self.letters = {}

    def letter(self, column, row):
        """The letter of the note on a printed cell, or an empty string."""
        wanted = {**self.pairs[row][0], "column": column}
        for note in self.cell_notes:
            if all(note[key] in ("*", wanted.get(key, ""))
                   for key in ("mesh", "degree", "method", "column")):
                return self.letters.setdefault(note["note"], chr(ord("a") + len(self.letters)))
        return ""

    def sentences(self):
        """All notes as (letter, sentence); those on the table as a whole come last."""
        lettered = tuple((letter, note) for note, letter in self.letters.items())
        return lettered + tuple(("", note) for note in self.table_notes)
