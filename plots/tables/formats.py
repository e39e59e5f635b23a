# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a Table as aligned text, as Markdown and as CSV."""

import csv
import io
import re
import textwrap
from dataclasses import replace

from .number_format import MISSING

TERMINAL_WIDTH = 110
# A number, its part before the decimal point, and the rest.
NUMBER = re.compile(r"([-+]?\d[\d,]*)((?:\.\d*)?(?:e[-+]?\d+)?)")
FIGURE_SPACE = "\N{FIGURE SPACE}"  # as wide as a digit; Markdown drops other blanks at the end of a cell
GAP = 2  # blanks between groups; within a group there is one

SUPERSCRIPTS = dict(zip("abcdefghij", "ᵃᵇᶜᵈᵉᶠᵍʰⁱʲ"))


def superscript(letter):
    """The mark of a note in plain text: one character wide where Unicode has one."""
    return SUPERSCRIPTS.get(letter, f"[{letter}]" if letter else "")


def as_text(table, width=TERMINAL_WIDTH):
    """The table for a terminal; groups that do not fit the width go to a panel below."""
    key_width = sum(w + GAP for w in key_widths(table))
    lines = [table.caption, ""]
    for panel in split(table, width - key_width, lambda group: GAP + group_width(group)):
        lines += panel_lines(panel) + [""]
    for letter, sentence in table.notes:
        lines += textwrap.wrap(sentence, width, initial_indent=f"{superscript(letter):2}",
                               subsequent_indent="  ")
    return "\n".join(line.rstrip() for line in lines).rstrip() + "\n"


def split(table, width, width_of):
    """Tables of some groups each, as many in each as fit a width; `width_of` is that of a group. Tied groups stay next to
    those before them."""
    panels, used = [[]], 0
    for block in blocks(table.groups):
        needed = sum(map(width_of, block))
        if panels[-1] and used + needed > width:
            panels.append([])
            used = 0
        panels[-1].extend(block)
        used += needed
    return [replace(table, groups=tuple(panel)) for panel in panels]


def blocks(groups):
    """The groups as lists; the groups of a list stay together."""
    found = []
    for group in groups:
        if group.tied and found:
            found[-1].append(group)
        else:
            found.append([group])
    return found


def panel_lines(table):
    """One panel: headings, subheadings and rows between rules."""
    widths = key_widths(table)
    keys = (" " * GAP).join(h.text.ljust(w) for h, w in zip(table.key_headings, widths))
    first = [keys] + [g.heading.text.center(group_width(g)) for g in table.groups]
    second = [" " * len(keys)] + [joined(g, g.subheadings) for g in table.groups]
    columns = [(group, list(zip(*aligned_columns(group)))) for group in table.groups]
    body = []
    for number, key in enumerate(table.keys):
        cells = [(" " * GAP).join(c.text.ljust(w) for c, w in zip(key, widths))]
        cells += [joined(group, rows[number], left=group.heading.text in table.left_aligned) for group, rows in columns]
        body.append((" " * GAP).join(cells))
    gap = " " * GAP
    length = max(len(line) for line in body)
    for number in reversed(table.rules):
        body.insert(number, "-" * length)
    header = [gap.join(first)] + ([gap.join(second)] if gap.join(second).strip() else [])
    return ["=" * length] + header + ["-" * length] + body + ["=" * length]


def key_widths(table):
    """Width of each key column."""
    return [max([len(heading.text)] + [len(row[i].text) for row in table.keys])
            for i, heading in enumerate(table.key_headings)]


def split_number(text):
    """A number before its decimal point, and the rest: ("7", ".39e+02"); None for words."""
    match = NUMBER.fullmatch(text)
    return match and (match[1], match[2])


def aligned(texts, marks, blank=" "):
    """The texts of a column with their marks. Numbers have blanks behind them, so that, flush right, their decimal
    points stand below each other."""
    parts = [split_number(text) for text in texts]
    behind = [len(part[1]) + len(mark) for part, mark in zip(parts, marks) if part]
    room = max(behind, default=0)
    return [text + mark + (blank * (room - len(part[1]) - len(mark)) if part else "")
            for text, mark, part in zip(texts, marks, parts)]


def aligned_columns(group, blank=" "):
    """The texts of each of a group's columns."""
    return [aligned([cell.text for cell in column], [superscript(cell.mark) for cell in column], blank)
            for column in zip(*group.cells)]


def column_widths(group):
    """Width of each of a group's columns, so that the group is as wide as its heading."""
    columns = aligned_columns(group) or [() for _ in group.subheadings]
    widths = [max([len(subheading), *map(len, column)]) for subheading, column in zip(group.subheadings, columns)]
    missing = len(group.heading.text) - (sum(widths) + len(widths) - 1)
    widths[0] += max(0, missing)
    return widths


def group_width(group):
    """Width of a group with single blanks between its columns."""
    widths = column_widths(group)
    return sum(widths) + len(widths) - 1


def joined(group, texts, left=False):
    """The texts of one line of a group, aligned."""
    return " ".join(text.ljust(w) if left else text.rjust(w)
                    for text, w in zip(texts, column_widths(group)))


def escape_markdown(text):
    """Text with the characters escaped that would end a cell or begin emphasis."""
    return re.sub(r"([|*_])", r"\\\1", text)


def column_headings(table):
    """A heading for each column: that of its group is repeated."""
    return [heading.text for heading in table.key_headings] + [
        f"{group.heading.text} {sub}".strip() for group in table.groups for sub in group.subheadings]


def as_csv(table):
    """Returns the table for programs: one line of headings, keys in every row, no commas between thousands, empty
    fields for missing numbers. Caption and notes are in the Markdown only."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(column_headings(table))
    above = [""] * len(table.key_headings)
    for number, key in enumerate(table.keys):
        above = filled_down([cell.text for cell in key], above)
        writer.writerow(above + [machine_text(cell.text) for group in table.groups for cell in group.cells[number]])
    return text.getvalue()


def filled_down(key, above):
    """A row's key with what it repeats of the row above: leading entries that are left empty."""
    n_repeated = next((i for i, entry in enumerate(key) if entry), len(key))
    return above[:n_repeated] + key[n_repeated:]


def machine_text(text):
    """A cell's text as a program reads it."""
    return "" if text == MISSING else re.sub(r"(?<=\d),(?=\d{3}(\D|$))", "", text)


def markdown_cell(text, mark):
    """A text for a Markdown page; its mark becomes a superscript."""
    return escape_markdown(text).replace(superscript(mark), f"<sup>{mark}</sup>") if mark else escape_markdown(text)


def as_markdown(table):
    """The table for a Markdown page; headings are repeated in each column."""
    columns = [[escape_markdown(row[i].text) for row in table.keys] for i in range(len(table.key_headings))]
    alignment = [":--" for _ in columns]
    for group in table.groups:
        columns += [[markdown_cell(text, cell.mark) for text, cell in zip(texts, cells)]
                    for texts, cells in zip(aligned_columns(group, FIGURE_SPACE), zip(*group.cells))]
        alignment += [":--" if group.heading.text in table.left_aligned else "--:" for _ in group.subheadings]
    headings = " | ".join(escape_markdown(heading) for heading in column_headings(table))
    lines = [f"**{escape_markdown(table.caption)}**", "", f"| {headings} |", f"|{'|'.join(alignment)}|",
             *("| " + " | ".join(row) + " |" for row in zip(*columns)), ""]
    for letter, sentence in table.notes:
        lines.append((f"<sup>{letter}</sup> " if letter else "") + escape_markdown(sentence) + "  ")
    return "\n".join(lines).rstrip() + "\n"
