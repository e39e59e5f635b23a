# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes report.html: one file that opens without a network."""

import json
import re
import shlex
from html import escape
from pathlib import Path
from string import Template

from ..claims.report import criterion_of, totals, verdict_cell
from ..results.rows import ResultsError
from ..results.write_files import write_atomically
from ..tables.formats import column_headings, filled_down, machine_text, superscript
from .contents import comparison, contents, summary_table
from .libraries import scripts

NAME = "report.html"
HERE = Path(__file__).parent


def script(text):
    """A script within a page: nothing in it ends the element."""
    return "<script>" + text.replace("</script", "<\\/script") + "</script>"


def json_in_page(data):
    """JSON within a page: nothing in it ends the element, or begins a comment or another script."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def inline(text):
    """The HTML of text with the Markdown that this program's sentences have: bold, code, escaped characters."""
    text = escape(text)
    for mark, tag in ((r"\*\*(?=\S)(.+?)(?<=\S)\*\*", "b"), ("`([^`]+)`", "code")):
        text = re.sub(mark, rf"<{tag}>\1</{tag}>", text)
    return re.sub(r"\\([|*_])", r"\1", text)


def html_table(table, caption, identifier, filters=(), words=escape):
    """Headings and rows of cells {text, order} as a table that DataTables sorts and filters. words: makes HTML of texts."""
    def td(cell):
        if "order" in cell:
            return f'<td class="number" data-order="{cell["order"]:.17g}">{escape(cell["text"])}</td>'
        return f"<td>{words(cell['text'])}</td>"
    head = "".join(f'<th scope="col">{escape(heading)}</th>' for heading in table["headings"])
    body = "\n".join("<tr>" + "".join(td(cell) for cell in row) + "</tr>" for row in table["rows"])
    columns = " ".join(str(table["headings"].index(name)) for name in filters if name in table["headings"])
    name = escape(caption, quote=True)
    # The script fills the paragraph if the table has columns beyond the edge.
    return (f'<p class="beyond" hidden></p><div class="scroll" role="region" tabindex="0" aria-label="{name}">'
            f'<table id="{identifier}" class="sortable" data-filters="{columns}"><caption>{name}</caption>'
            f"<thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table></div>")


def table_data(table):
    """Headings and rows of a Table for html_table. Keys stand in every row, and numbers are sorted as such."""
    def cell(text, mark=""):
        shown = text + superscript(mark)
        try:
            return {"text": shown, "order": float(text.removeprefix("<"))}
        except ValueError:
            return {"text": shown}
    rows, above = [], [""] * len(table.key_headings)
    for number, key in enumerate(table.keys):
        above = filled_down([entry.text for entry in key], above)
        rows.append([cell(text) for text in above] +
                    [cell(machine_text(entry.text), entry.mark) for group in table.groups for entry in group.cells[number]])
    return {"headings": column_headings(table), "rows": rows}


def tables_section(tables):
    """All tables; those columns can be chosen from that say what a row is about."""
    found = []
    for table in tables:
        data = table_data(table)
        found.append(html_table(data, table.caption, table.name, data["headings"][:len(table.key_headings)]))
        found += [f"<p>{escape(f'{superscript(letter)} {sentence}'.strip())}</p>" for letter, sentence in table.notes]
    return '<section id="tables"><h2>Tables</h2>' + "\n".join(found) + "</section>" if found else ""


def claims_section(outcomes):
    """The verdicts on claims of the thesis; empty for a study without claims."""
    if not outcomes:
        return ""
    rows = [[{"text": text} for text in (o.claim["id"], o.claim["section"], o.claim["statement"], criterion_of(o.claim),
                                         o.printed, o.computed, verdict_cell(o))] for o in outcomes]
    table = {"headings": ["Claim", "Section", "Statement", "Criterion", "Thesis", "smoothfem", "Verdict"], "rows": rows}
    return (f'<section id="claims"><h2>Claims of the thesis</h2><p>{escape(totals(outcomes))}.</p>'
            + html_table(table, "Claims, criteria and results", "claims-table", ("Verdict",), inline) + "</section>")


def against_section(results, against):
    """The comparison with another folder; empty if none is asked for."""
    if against is None:
        return ""
    found = comparison(results, against)
    return (f'<section id="against"><h2>Against {escape(str(against))}</h2><p>Numbers of this folder divided by those of '
            f'{escape(found["study"])} there (commit {escape(found["made_by"][:12])}). "=": the same number to the last '
            "digit.</p>" + html_table(found, "Ratios", "against-table", ("Mesh", "Method", "degree")) + "</section>")


def provenance_section(study, provenance):
    """The source of the numbers, and the command that reproduces them."""
    program, machine = provenance.get("program", {}), provenance.get("machine", {})
    scale = provenance.get("scale", "default")
    command = f"smoothfem study {shlex.quote(study)}" + ("" if scale == "default" else f" --scale {scale}")
    if any(mesh.get("published") for mesh in provenance.get("meshes", []) if isinstance(mesh, dict)):
        command += " --published"
    changed = " with changes that are not committed" if program.get("uncommitted_changes") else ""
    facts = (("Made by", f"smoothfem {program.get('version', '?')}, commit {program.get('commit', '?')}{changed}"),
             ("Written", provenance.get("written", "?")), ("Scale", scale),
             ("Machine", ", ".join(f"{name} {value}" for name, value in machine.items())),
             ("Again", command))
    listed = "".join(f"<dt>{escape(name)}</dt><dd>{escape(str(value))}</dd>" for name, value in facts)
    return (f'<section id="provenance"><h2>Provenance</h2><dl>{listed}</dl><details><summary>All of provenance.json</summary>'
            f"<pre>{escape(json.dumps(provenance, indent=1))}</pre></details></section>")


def file_text(name):
    """Returns the text of a file next to this one."""
    return (HERE / name).read_text(encoding="utf-8")


def html_page(title, main, facts="", script_file=None):
    """Returns a whole page. main, facts: HTML. script_file: next to this one, of a page with plots. Raises
    NoLibrary."""
    return Template(file_text("page.html")).substitute(
        title=escape(title), facts=facts, main=main, style=file_text("report.css"),
        libraries="".join(map(script, scripts(with_plots=script_file is not None))), common=script(file_text("page.js")),
        script=script(file_text(script_file)) if script_file else "")


def counted(number, noun, plural="s"):
    """2 methods, 1 method."""
    return f"{number} {noun}{'' if number == 1 else plural}"


def page(results, outcomes=(), against=None, tables=()):
    """The text of the page; outcomes: of the study's claims; tables: of its results. Raises NoLibrary or ResultsError."""
    counts = escape(f"{counted(len(results.meshes), 'mesh', 'es')}, {counted(len(results.methods), 'method')}, "
                    f"degree {' and '.join(results.degrees) or 'none (smoothing only)'}")
    failures = "".join(f"<li>{escape(f'{results.title(method)}, {results.title(mesh)}: {status}')}</li>"
                       for (mesh, method), status in results.failures.items())
    main = Template(file_text("smoothing.html")).substitute(
        summary=html_table(summary_table(results), "summary.csv: a row for each mesh, method and degree", "summary-table",
                           ("mesh", "method", "degree")),
        tables=tables_section(tables), claims=claims_section(outcomes), against=against_section(results, against),
        provenance=provenance_section(results.study, results.provenance), data=json_in_page(contents(results)))
    return html_page(results.study_title, main, f'<p>{counts}. {escape(results.note)}</p>\n<ul class="failures">{failures}</ul>',
                     "report.js")


def write_report(results, outcomes=(), against=None, path=None, tables=()):
    """Writes report.html into the results folder, or to a path; returns where."""
    if against is not None and not Path(against).is_dir():
        raise ResultsError(f"{against}: there is no such folder to compare with.")
    return write_atomically(path or results.folder / NAME, page(results, outcomes, against, tables))
