# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes report.html for studies without meshes of their own: their sentences, tables and figures as one file that opens
without a network."""

import base64
from html import escape
from string import Template

from ..results.rows import read_provenance
from ..results.write_files import write_atomically
from .page import NAME, file_text, html_page, inline, json_in_page, provenance_section, tables_section


def html_text(markdown):
    """Headings, lists and paragraphs, which is all that this program's texts of sentences have; the first heading is the
    page's own."""
    lines, in_list = [], False
    for line in markdown.splitlines():
        is_item = line.startswith("- ")
        if is_item != in_list:
            lines.append("<ul>" if is_item else "</ul>")
            in_list = is_item
        if is_item:
            lines.append(f"<li>{inline(line[2:])}</li>")
        elif line.startswith("## "):
            lines.append(f"<h3>{escape(line[3:])}</h3>")
        elif line and not line.startswith("# "):
            lines.append(f"<p>{inline(line)}</p>")
    return "\n".join(lines + ["</ul>"] * in_list)


def figures_section(folder, planned):
    """The figures that have been drawn."""
    found = []
    for figure in planned:
        path = folder / "figures" / f"{figure.name}.png"
        if path.is_file():
            image = base64.b64encode(path.read_bytes()).decode()
            found.append(f'<figure><img alt="{escape(figure.title, quote=True)}" src="data:image/png;base64,{image}">'
                         f"<figcaption>{escape(figure.title)}</figcaption></figure>")
    return '<section id="figures"><h2>Figures</h2>' + "\n".join(found) + "</section>" if found else ""


def plots_section(plots):
    """The section with plots that the reader can redraw."""
    return Template(file_text("collection.html")).substitute(data=json_in_page(plots))


def write_tables_report(folder, title, tables, planned, texts, plots=None, path=None):
    """Writes report.html into the results folder, or to a path; returns where. texts: Markdown. plots: of a collection, in
    place of the figures. Raises NoLibrary."""
    provenance = read_provenance(folder / "provenance.json")
    sentences = "\n".join(html_text(text) for text in texts)
    main = "\n".join((
        f'<section id="texts"><h2>Findings</h2>{sentences}</section>' if sentences else "",
        plots_section(plots) if plots else figures_section(folder, planned), tables_section(tables),
        provenance_section(str(provenance.get("study") or folder.resolve().name), provenance)))
    return write_atomically(path or folder / NAME, html_page(title, main, script_file="collection.js" if plots else None))
