# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables, independent of the format: cells, groups of columns, notes."""

from dataclasses import dataclass

from ..results.symbols import SYMBOLS, Heading, of_solver, symbol_of
from .number_format import MISSING, grouped


@dataclass(frozen=True)
class Cell:
    """One entry: the same content for text and LaTeX; `mark` is the letter of a note."""

    text: str
    mark: str = ""
    tex: str = ""  # where LaTeX wants other characters than escaped text


@dataclass(frozen=True)
class Group:
    """Columns under one heading: `subheadings` has an entry for each of the group's columns."""

    heading: Heading
    subheadings: tuple
    cells: tuple  # one tuple of cells for each row
    tied: bool = False  # stays next to the group before it


@dataclass(frozen=True)
class Table:
    """A table ready to be written in any format."""

    study: str  # with the name it makes a label that other studies' tables do not have
    name: str
    caption: str
    key_headings: tuple
    keys: tuple  # one tuple of cells for each row, empty where the entry repeats the one above
    rules: tuple  # numbers of the rows above which a rule is drawn
    left_aligned: tuple  # subheadings of columns that hold words
    groups: tuple
    notes: tuple  # (letter or empty, sentence)


def number_cell(text, mark=""):
    """A cell whose LaTeX has true minus signs and powers of ten; counts get their commas."""
    text = grouped(text)
    mantissa, exponent, power = text.partition("e")
    try:
        float(text)
    except ValueError:
        return Cell(text, mark, {MISSING: "--", "=": "$=$"}.get(text, escape_tex(text)))
    if exponent:
        return Cell(text, mark, rf"${mantissa}\cdot10^{{{int(power)}}}$")
    return Cell(text, mark, f"${text}$" if text[0] in "+-" else text)


def heading_of(column):
    """The heading of a column, with names that are no symbols escaped for LaTeX."""
    label, number = of_solver(column)
    tex = SYMBOLS[number].tex if number in SYMBOLS else escape_tex(number)
    return Heading(symbol_of(column).text, f"{escape_tex(label)}: {tex}" if label else tex)


def escape_tex(text):
    """Text with LaTeX's special characters escaped."""
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
               "–": "--", "×": r"$\times$", "•": r"\textbullet{}", "<": "$<$", ">": "$>$", "|": "$|$",
               **{c: "\\" + c for c in "&%$#_{}"}}
    return "".join(special.get(character, character) for character in text)


def text_cell(text):
    """A cell of words."""
    return Cell(text, tex=escape_tex(text))
