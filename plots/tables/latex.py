# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a Table as LaTeX (booktabs, graphicx)."""

from .formats import group_width, key_widths, split
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
    """The lines of one panel."""
    columns = "l" * len(table.key_headings)
    first, second, rules, column = [h.tex for h in table.key_headings], [], [], len(columns) + 1
    second = ["" for _ in first]
    for group in table.groups:
        n = len(group.subheadings)
        columns += "l" if group.heading.text in table.left_aligned else "r" * n
        first.append(rf"\multicolumn{{{n}}}{{c}}{{{group.heading.tex}}}" if n > 1
                     else group.heading.tex)
        second += [escape_tex(subheading) for subheading in group.subheadings]
        rules += [rf"\cmidrule(lr){{{column}-{column + n - 1}}}"] if n > 1 else []
        column += n
    header = [" & ".join(first) + r" \\"]
    if any(second):
        header += ["".join(rules), " & ".join(second) + r" \\"]
    body = []
    for number, key in enumerate(table.keys):
        if number in table.rules:
            body.append(r"\addlinespace")
        cells = list(key) + [cell for group in table.groups for cell in group.cells[number]]
        body.append(" & ".join(tex_cell(cell) for cell in cells) + r" \\")
    return [rf"\begin{{tabular}}{{{columns}}}", r"\toprule", *header, r"\midrule", *body,
            r"\bottomrule", r"\end{tabular}"]


def tex_cell(cell):
    """A cell in LaTeX with its mark; \\rlap keeps the digits of marked numbers in their columns."""
    text = cell.tex or escape_tex(cell.text)
    return text + (rf"\rlap{{\textsuperscript{{{cell.mark}}}}}" if cell.mark else "")
