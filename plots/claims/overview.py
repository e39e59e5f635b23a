# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes an overview of all claims of the thesis from results/reference, as a page of the manual."""

import re
from dataclasses import dataclass

from ..results.data_folder import study_files
from ..results.printed_values import read_printed_tables
from ..results.same_numbers import is_of, read_records
from ..results.smoothing import read_provenance, read_results
from ..tables.formats import escape_markdown
from ..tables.number_format import MISSING
from .check import UNKNOWN, Outcome, check_claims, read_claims
from .reasons import REASONS
from .report import known_reasons, totals, verdict_cell

TITLE = re.compile(r"^set title\s*=\s*(.*?)\s*$", re.MULTILINE)
SHORT_COMMIT = 7  # digits


@dataclass(frozen=True)
class Study:
    """A study with claims, their outcomes, and the provenance of its run."""

    name: str
    title: str
    outcomes: list
    provenance: dict  # None: there are no results


def studies(folders):
    """Returns the studies with claims, by name; `folders` is the folder of results folders."""
    found = []
    for path in study_files().values():
        claims = read_claims(path.stem)
        if not claims:
            continue
        if (folders / path.stem).is_dir():
            results = read_results(folders / path.stem)
            printed = read_printed_tables(results.thesis_study, results.provenance)
            found.append(Study(path.stem, results.study_title, check_claims(claims, results, printed),
                               results.provenance))
        else:
            outcomes = [Outcome(claim, UNKNOWN, MISSING, MISSING) for claim in claims]
            found.append(Study(path.stem, TITLE.search(path.read_text(encoding="utf-8"))[1], outcomes, None))
    return found


def overview(folders):
    """All claims about all studies, as Markdown."""
    found = studies(folders)
    lines = [totals([outcome for study in found for outcome in study.outcomes]) + ".", "", *runs(found, folders), ""]
    for study in found:
        where = ("there are no results to check them with" if study.provenance is None
                 else f"the numbers are in `results/reference/{study.name}/tables/claims.md`")
        lines += [f"## {study.title}", "", f"{totals(study.outcomes)}; {where}.", "",
                  "| | Section | Claim | |", "|:--|:--|:--|:--|"]
        for outcome in study.outcomes:
            cells = (outcome.claim["id"], outcome.claim["section"], outcome.claim["statement"])
            lines.append("| " + " | ".join(escape_markdown(cell) for cell in cells)
                         + f" | {verdict_cell(outcome)} |")
        lines += known_reasons(study.outcomes) + [""]
    return "\n".join(lines)


def without_claims(found, folders):
    """The other runs with results, as studies without claims; runs that test reasons come last."""
    names = {path.parent.relative_to(folders).as_posix() for path in folders.rglob("provenance.json")}
    names -= {study.name for study in found}
    return [Study(name, name, [], read_provenance(folders / name / "provenance.json"))
            for name in sorted(names, key=lambda name: (name.startswith(REASONS), name))]


def runs(found, folders):
    """The run that each study's results come from, as lines of a Markdown table."""
    everything = [*found, *without_claims(found, folders)]
    again = read_records(folders)
    commits = {commit for study in everything for commit in commits_of(study)}
    commit, covered = most_covered([study for study in everything if study.provenance], again)
    lines = [f"The results come from {len(commits)} commits of the program; results of a study come from one commit. "
             f"{len(covered)} of the {len(everything)} studies belong to commit {commit}: it made them, or its program has the same "
             "sources, or it reproduces every number of their tables to the last digit, except times and memory. Times of "
             "different commits cannot be compared.", "",
             "| study | scale | written | commit | run again at, or the same program as | system |", "|:--|:--|:--|:--|:--|:--|"]
    for study in everything:
        run = study.provenance or {}
        cells = (f"`{study.name}`", run.get("scale", MISSING), run.get("written", MISSING)[:len("2026-11-22")],
                 ", ".join(commits_of(study)) or "no results", again_cell(again.get(study.name, {}), run),
                 run.get("machine", {}).get("system", MISSING))
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def again_cell(row, run):
    """Describes where a study was run again, and how many rows of its tables differ; or names the commit with the same
    program."""
    if not is_of(row, run):
        return MISSING
    if not row["rows"]:
        return f"{row['again'][:SHORT_COMMIT]}: same program"
    same = "same" if row["different"] == "0" else f"**{row['different']} of {row['rows']} rows differ**"
    return f"{row['again'][:SHORT_COMMIT]}: {same}"


def most_covered(found, again):
    """Returns (short commit, names of studies). The commit made, or reproduces the numbers of, the largest number of studies."""
    covered = {}
    for study in found:
        row = again.get(study.name, {})
        of = set(commits_of(study)) if len(commits_of(study)) == 1 else set()
        if is_of(row, study.provenance) and row["different"] == "0":
            of.add(row["again"][:SHORT_COMMIT])
        for commit in of:
            covered.setdefault(commit, []).append(study.name)
    return max(sorted(covered.items()), key=lambda item: len(item[1]), default=(MISSING, []))


def commits_of(study):
    """The short commits of the program of a run's sessions, and whether there were uncommitted changes; empty if there
    are no results."""
    sessions = (study.provenance or {}).get("sessions", [])
    return list(dict.fromkeys(session["commit"][:SHORT_COMMIT] + ("+" if session["uncommitted_changes"] else "")
                              for session in sessions))
