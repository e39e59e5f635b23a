# SPDX-License-Identifier: GPL-3.0-or-later
"""reference_pages.py PROGRAM PAGES: writes the reference pages, which are generated from the program, into the folder PAGES."""

import json
import re
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
VALUE_COLUMN = 47  # where `smoothfem list` has the default of a parameter
SECTION = re.compile(r"^([A-Z]+)(?: \((.*)\))?$", re.MULTILINE)


def printed(*command):
    """Returns the output of a command."""
    return subprocess.run([str(word) for word in command], text=True, check=True, capture_output=True).stdout


def fenced(text):
    """Returns a literal block."""
    return f"```text\n{text.strip(chr(10)).rstrip()}\n```\n"


def cell(text):
    """Returns a text for a table cell, with escapes: the program's texts are not Markdown."""
    return re.sub(r"([\\`*_|<>\[\]])", r"\\\1", text)


def table(heading, rows):
    """Returns the lines of a Markdown table."""
    return "\n".join("| " + " | ".join(row) + " |" for row in (heading, ["---"] * len(heading), *rows)) + "\n"


def code(text):
    """Returns code for a table cell."""
    return "`" + text.replace("|", "\\|") + "`"


def commands(program):
    """Returns commands.md: the help of every command."""
    whole = printed(program, "--help")
    names = re.findall(r"^  ([a-z][a-z-]*) ", whole.partition("Subcommands")[2], re.MULTILINE)
    names += [name for name in ("plot", "report") if name not in names]
    parts = ["# Commands", "", "`smoothfem COMMAND --help` prints the same.", "", fenced(whole)]
    for name in names:
        parts += [f"## {name}", "", fenced(printed(program, name, "--help"))]
    return "\n".join(parts)


def study_keys(program):
    """Returns study-keys.md: the keys of study files."""
    parts = ["# Study keys", "", "A study file sets keys: `set KEY = VALUE`. Subsections group keys. `include FILE` takes the keys of another file, which "
             "later lines change. `smoothfem list --study-keys` prints the same.", ""]
    for section in re.split(r"^# Keys of studies of the kind ", printed(program, "list", "--study-keys"), flags=re.MULTILINE)[1:]:
        kind, _, text = section.partition("\n")
        parts += [f"## Kind `{kind}`", "", fenced(text)]
    return "\n".join(parts)


def sections(program):
    """Returns {heading: (use of the names, text)} of `smoothfem list`."""
    text = printed(program, "list")
    found = list(SECTION.finditer(text))
    ends = [match.start() for match in found[1:]] + [len(text)]
    return {match[1]: (match[2] or "", text[match.end():end].strip("\n")) for match, end in zip(found, ends)}


def methods(text):
    """Returns methods.md: methods with their parameters."""
    parts = ["# Methods and parameters", "", "`smooth -m NAME` and `set methods` in a study take these names. `--set KEY=VALUE`, or `set KEY = VALUE` in a "
             "method's subsection, sets a parameter. `smoothfem list` prints the same.", ""]
    for block in re.split(r"\n\n", text):
        lines = block.splitlines()
        head = re.fullmatch(r"  (\S+): (.*)", lines[0]) if lines else None
        if head is None:
            parts += [cell(" ".join(line.strip() for line in lines)), ""]
            continue
        described = [line.strip() for line in lines[1:3]]
        rows = [parameter(line) for line in lines[3:]]
        parts += [f"## {head[1]}", "", f"**{cell(head[2])}.** " + cell(" ".join(described)), ""]
        if rows:
            parts += [table(("parameter", "default", "meaning"), rows), ""]
    return "\n".join(parts)


def parameter(line):
    """Returns the cells of a parameter's line: name, default, meaning."""
    match = re.fullmatch(r" {6}(\S+) +(\S.*)", line)
    if match is None:
        raise SystemExit(f"reference_pages.py: this is not a parameter of `smoothfem list`: {line}")
    name, rest = match.groups()
    if len(line) - len(rest) > VALUE_COLUMN:  # the default is empty
        return code(name), "", cell(rest)
    default, meaning = re.fullmatch(r"(\S+(?:, \S+)*?) +(\S.*)", rest).groups()
    return code(name), code(default), cell(meaning)


def solvers(text):
    """Returns solvers.md: solvers with their parameters and the numbers that they record."""
    parts = ["# Solvers and their numbers", "", "`set solvers` in a study names solvers, and the subsection of one sets its parameters. `smoothfem list solvers` prints the "
             "same. [Another equation, another solver](../how-to/other-equations.md) shows how to use them.", ""]
    for block in re.split(r"\n\n", text.strip("\n")):
        lines = block.splitlines()
        name, _, title = lines[0].strip().partition(": ")
        records = [re.fullmatch(r" {6}records (\S+) +(\S.*)", line) for line in lines[2:]]
        rows = [parameter(line) for line, record in zip(lines[2:], records) if record is None]
        numbers = [(code(record[1]), cell(record[2])) for record in records if record]
        parts += [f"## {name}", "", cell(title if len(lines) == 1 else lines[1].strip()), ""]
        parts += [table(("parameter", "default", "meaning"), rows), ""] if rows else []
        parts += [table(("number", "meaning"), numbers), ""] if numbers else []
    return "\n".join(parts)


def named(title, where, text, note=""):
    """Returns a page of names with descriptions, one a line."""
    rows = [re.fullmatch(r"  (\S+):? +(\S.*)", line) for line in text.splitlines() if line.strip()]
    if None in rows:
        raise SystemExit(f"reference_pages.py: the section {title} of `smoothfem list` has another form")
    return "\n".join((f"# {title}", "", f"Used in: {cell(where)}. `smoothfem list` prints the same." if where else "`smoothfem list` prints the same.", "",
                      *((note, "") if note else ()),
                      table(("name", "description"), [(code(row[1].rstrip(":")), cell(row[2])) for row in rows])))


def presets(where, text):
    """Returns presets.md: presets with the parameters that they set."""
    parts = [named("Presets", where, text), ""]
    for path in sorted((SOURCE / "studies" / "presets").glob("*.json")):
        parts += [f"## {path.stem}", "", "```json", path.read_text(encoding="utf-8").strip(), "```", ""]
    return "\n".join(parts)


def columns():
    """Returns columns.md: every column once, and the columns of each file."""
    data = json.loads((SOURCE / "studies" / "columns.json").read_text(encoding="utf-8"))
    parts = ["# Columns", "", "`smoothfem list --columns FILE` prints the columns of a file with their meaning. Sections, tables and equations are those of "
             "the thesis.", "", "## Files", ""]
    for name, file in data["files"].items():
        parts += [f"### {name}", "", markdown(file["content"]), "", "Columns: " + ", ".join(code(column) for column in file["columns"]) + ".", ""]
        if "here" in file:
            parts += ["In this file:", "", *(f"- {code(column)}: {markdown(text)}" for column, text in file["here"].items()), ""]
    rows = [(code(name), markdown(column["meaning"]), column.get("unit", ""), column.get("source", "")) for name, column in data["columns"].items()]
    parts += ["## All columns", "", table(("column", "meaning", "unit", "source"), rows)]
    return "\n".join(parts)


def markdown(text):
    """Returns a text of columns.json for a table cell; code stays code."""
    return "".join(part if k % 2 else re.sub(r"([|<>_*])", r"\\\1", part) for k, part in enumerate(re.split(r"(`[^`]*`)", text)))


def studies(program):
    """Returns studies.md: the studies of the program."""
    return "\n".join(("# Studies", "", "`smoothfem study NAME` runs a study of the program. `smoothfem study --list` prints the same.", "",
                      fenced(printed(program, "study", "--list"))))


def claims():
    """Returns claims.md: all claims of the thesis."""
    from plots.claims.overview import overview
    from plots.claims.reasons import reference

    return "\n".join(("# All claims", "", "[Fidelity](fidelity.md) has a summary and the causes. A letter after a claim's name (S1b) marks a later criterion, "
                      "which stands next to the first one. The numbers are made from `results/reference`.", "", overview(reference()), ""))


def pages(program):
    """Returns {path of a page: Markdown}."""
    listed = sections(program)
    made = {f"reference/{name.lower()}.md": named(name.capitalize(), *listed[name]) for name in ("METRICS", "DOMAINS", "SOLUTIONS", "FORMATS")}
    return {**made, "reference/commands.md": commands(program), "reference/study-keys.md": study_keys(program),
            "reference/methods.md": methods(listed["METHODS"][1]), "reference/solvers.md": solvers(listed["SOLVERS"][1]),
            "reference/presets.md": presets(*listed["PRESETS"]),
            "reference/columns.md": columns(), "reference/studies.md": studies(program), "explanation/claims.md": claims()}


def main(program, folder):
    """Writes the pages."""
    for name, text in pages(Path(program)).items():
        path = Path(folder) / name
        if path.exists() and (SOURCE / "docs" / name).exists():
            raise SystemExit(f"reference_pages.py: {name} is written manually, too")
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    sys.path.insert(0, str(SOURCE))
    main(*sys.argv[1:])
