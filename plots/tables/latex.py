# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a Table as LaTeX (booktabs, graphicx)."""

from .formats import group_width, key_widths, split, split_number
from .table import escape_tex

# Points: a digit of \footnotesize, the space of a column, the line of an article.
DIGIT, COLUMN_SPACE, LINE_WIDTH = 4.25, 6.0, 345.0
LEAST_SCALE = 0.7  # of a table that is shrunk to the line: smaller digits cannot be read


def as_latex(table):
    """The table for LaTeX; needs the packages booktabs and graphicx.

    Shrunk to the line width if it is a little wider, never enlarged; groups of columns that would
    have to be shrunk more go to a panel below.
    """
    caption = table.caption.partition(": ")[2] if table.caption.startswith("Table ") else table.caption
    lines = [r"% Needs \usepackage{booktabs} and \usepackage{graphicx}.", r"\begin{table}", r"\centering",
             rf"\caption{{{escape_tex(caption)}}}", rf"\label{{{label_of(table)}}}", r"\footnotesize",
             r"\setlength{\tabcolsep}{3pt}"]
    for number, panel in enumerate(panels_of(table)):
        lines += [r"\par\medskip"] if number else []
        lines += [r"\resizebox{\ifdim\width>\linewidth\linewidth\else\width\fi}{!}{%",
                  "\n".join(tabular(panel)) + "}"]
    notes = [rf"\textsuperscript{{{letter}}}~{escape_tex(sentence)}" if letter
             else escape_tex(sentence) for letter, sentence in table.notes]
    lines += [r"\par\smallskip\begin{minipage}{\linewidth}\scriptsize",
              "\\par\n".join(notes), r"\end{minipage}"] if notes else []
    return "\n".join(lines + [r"\end{table}"]) + "\n"


def label_of(table):
    """tab:gear:6_1_smoothing."""
    return f"tab:{table.study}:{table.name.removeprefix('table_')}"


def panels_of(table):
    """The table, or parts of it that are about equally wide if it is too wide for a line."""
    keys = sum(DIGIT * width + COLUMN_SPACE for width in key_widths(table))

    def width_of(group):
        # The text has a blank between columns where LaTeX has the space.
        n = len(group.subheadings)
        return DIGIT * (group_width(group) - n + 1) + COLUMN_SPACE * n
    most = LINE_WIDTH / LEAST_SCALE - keys
    n_panels = len(split(table, most, width_of))
    # The narrowest panels of which there are no more: otherwise the last one is nearly empty.
    while most > DIGIT and len(split(table, most - DIGIT, width_of)) == n_panels:
        most -= DIGIT
    return split(table, most, width_of)


def tabular(table):
    """The lines of one panel. Columns of numbers with different decimals have two columns each, which meet at the point."""
    first, second, rules = [h.tex for h in table.key_headings], ["" for _ in table.key_headings], []
    columns, rows = "l" * len(table.key_headings), [[tex_cell(cell) for cell in key] for key in table.keys]
    place = len(table.key_headings) + 1  # of the next column
    for group in table.groups:
        is_left = group.heading.text in table.left_aligned
        divided = [not is_left and is_uneven(column) for column in zip(*group.cells)] or [False] * len(group.subheadings)
        width = len(divided) + sum(divided)
        columns += "".join("l" if is_left else "r@{}l" if each else "r" for each in divided)
        first.append(rf"\multicolumn{{{width}}}{{c}}{{{group.heading.tex}}}" if width > 1 else group.heading.tex)
        second += [rf"\multicolumn{{2}}{{c}}{{{escape_tex(subheading)}}}" if each else escape_tex(subheading)
                   for subheading, each in zip(group.subheadings, divided)]
        rules += [rf"\cmidrule(lr){{{place}-{place + width - 1}}}"] if len(divided) > 1 else []
        place += width
        for row, cells in zip(rows, group.cells):
            row += [divided_cell(cell) if each else tex_cell(cell) for cell, each in zip(cells, divided)]
    header = [" & ".join(first) + r" \\"]
    if any(part for part in second if not part.endswith("{}")):
        header += ["".join(rules), " & ".join(second) + r" \\"]
    body = [(r"\addlinespace" + "\n" if number in table.rules else "") + " & ".join(row) + r" \\"
            for number, row in enumerate(rows)]
    return [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", *header, r"\midrule", *body,
            r"\bottomrule", r"\end{tabular}"]


def is_uneven(cells):
    """True if numbers of a column have different numbers of decimals, or powers of ten."""
    return len({len(part[1]) for cell in cells if (part := split_number(cell.text))}) > 1


def divided_cell(cell):
    """A number as two cells that meet at its decimal point; words go across both."""
    part = split_number(cell.text)
    if not part:
        return rf"\multicolumn{{2}}{{r}}{{{tex_cell(cell)}}}"
    decimals, _, power = part[1].partition("e")
    whole = f"${part[0]}$" if part[0][0] in "+-" else part[0]
    behind = rf"${decimals}\cdot10^{{{int(power)}}}$" if power else decimals
    return f"{whole} & {behind}{mark_of(cell)}"


def tex_cell(cell):
    """A cell in LaTeX with its mark."""
    return (cell.tex or escape_tex(cell.text)) + mark_of(cell)


def mark_of(cell):
    """The mark of a note, or an empty string; \\rlap keeps the digits of marked numbers in their columns."""
    return rf"\rlap{{\textsuperscript{{{cell.mark}}}}}" if cell.mark else ""
