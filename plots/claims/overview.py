# SPDX-License-Identifier: GPL-3.0-or-later
"""python3 -m plots.claims.overview: writes what holds of the thesis' claims into results/README.md,
from the results in results/reference."""

import sys

from ..results.data_folder import data_folder
from ..results.printed_values import read_printed_tables
from ..results.rows import ResultsError
from ..results.smoothing import read_results
from ..results.write_files import write_atomically
from ..tables.formats import escape_markdown
from .check import FAILS, HOLDS, UNKNOWN, check_claims, read_claims
from .report import emphasized, known_reasons

# The lines around the overview.
BEGIN, END = "<!-- made by python3 -m plots.claims.overview -->", "<!-- end of what it made -->"


def reference():
    """The folder of results folders that come with the program."""
    return data_folder() / "results" / "reference"


def readme():
    """The file with the overview."""
    return data_folder() / "results" / "README.md"


def results_folders(folders):
    """The folders of results in a folder, by name."""
    return sorted(path for path in folders.iterdir() if path.is_dir())


def overview(folders):
    """All claims about the studies in a folder of results folders, as Markdown."""
    outcomes = {folder: outcomes_of(folder) for folder in results_folders(folders)}
    lines = []
    for folder, (title, found) in outcomes.items():
        if not found:
            continue
        counts = ", ".join(count_phrase(sum(o.verdict == verdict for o in found), *words) for verdict, words in
                           ((HOLDS, ("holds", "hold")), (FAILS, ("does not hold", "do not hold")),
                            (UNKNOWN, ("cannot be checked", "cannot be checked"))))
        table = f"reference/{folder.name}/tables/claims.md"
        lines += [f"### {title}", "", f"Of {len(found)} claims {counts}; the numbers are in [{table}]({table}).", "",
                  "| | Section | Claim | |", "|:--|:--|:--|:--|"]
        for outcome in found:
            cells = (outcome.claim["id"], outcome.claim["section"], outcome.claim["statement"])
            lines.append("| " + " | ".join(escape_markdown(cell) for cell in cells)
                         + f" | {emphasized(outcome.verdict)} |")
        lines += known_reasons(found) + [""]
    return "\n".join(lines)


def count_phrase(number, of_one, of_many):
    """A number and what is said of so many."""
    return f"{number} {of_one if number == 1 else of_many}"


def outcomes_of(folder):
    """A study's title and the outcomes of its claims."""
    results = read_results(folder)
    printed = read_printed_tables(results.thesis_study, results.provenance)
    return results.study_title, check_claims(read_claims(results.thesis_study), results, printed)


def with_overview(text, made):
    """A text with what stands between the two lines replaced; ResultsError if they are not there."""
    before, begin, rest = text.partition(BEGIN + "\n")
    _, end, after = rest.partition(END + "\n")
    if not begin or not end:
        raise ResultsError(f"{readme()}: the lines `{BEGIN}` and `{END}` are not there.")
    return f"{before}{begin}\n{made}\n{end}{after}"


def main():
    """Writes the file anew; returns the exit code."""
    try:
        path = readme()
        text = path.read_text(encoding="utf-8")
        write_atomically(path, with_overview(text, overview(reference())))
    except (OSError, ResultsError) as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
