#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built-in studies for results/reference: all at the scale `paper`, the gear on the published
meshes as it is, collections at their usual scale. Goes on where it was stopped: a study whose reference
is of this commit is left alone, one that was interrupted goes on by itself. Shortest ones first. With --compare
references stay as they are, with their times; whether this commit has the same numbers is kept in again.csv
beside them, and exit code 1 says that it has not. With --program-of nothing is run: which references were made by
the program of a commit, as others have the same sources, is kept there.

    make_reference.py SOURCE PROGRAM WORK [--compare | --program-of COMMIT] [STUDY...]

PROGRAM: bin/smoothfem, built from SOURCE without changes that are not committed; WORK: where studies run,
with their meshes and figures. What is kept of them is in results/reference of SOURCE. Needs plots on PYTHONPATH."""

import argparse
import lzma
import re
import shutil
import subprocess
import sys
from pathlib import Path

from plots.results import same_numbers
from plots.results.rows import packed, read_provenance

# What is kept of a study: its rows, packed, from which `smoothfem plot` makes tables and figures.
KEPT = ("iterations.csv", "summary.csv", "refined.csv", "solutions.csv", "thresholds.csv")
COLLECTIONS = ("field", "energy-corners", "energy-field", "energy-field-quadratic", "energy-robust")  # run at their usual scale
KEPT_OF_COLLECTIONS = ("members.csv", "summary.csv", "refined.csv")
TABLES = ("*.md", "*.csv")  # tables of collections, which need iterations.csv and metrics.csv: too large to be kept
REASONS = "reasons/"  # studies that test reasons: reasons/NAME; what they are is in their files
PUBLISHED = ("gear", "energy", "reasons/gear-mesquite", "reasons/gear-rounding")  # which are of the published meshes
SCALE = "subsection scale paper"
SOURCES = ("*.cc", "*.h", "cmake", "CMakeLists.txt", "CMakePresets.json", ":!*/tests/*", ":!*/bench/*")  # of the program
UNKNOWN_SECONDS = 1e9  # studies without a reference come last
SHOWN = 5  # rows that differ


def provenance(folder):
    """What provenance.json of a results folder says; empty if there is none."""
    return read_provenance(folder / "provenance.json")


def is_done(folder, commit):
    """Whether a folder has a study's whole results, made by the program of a commit."""
    found = provenance(folder)
    return found.get("status") == "complete" and made_by(found, commit)


def made_by(found, commit):
    """Whether results are of a commit's program."""
    program = found.get("program", {})
    return program.get("commit") == commit and not program.get("uncommitted_changes")


def seconds(folder):
    """How long the study took when it was last run."""
    return sum(provenance(folder).get("seconds", {}).values()) or UNKNOWN_SECONDS


def study_files(path):
    """A study's file, and those that it includes."""
    included = re.findall(r"^\s*include\s+(\S+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    return [path, *(file for name in included for file in study_files(path.parent / name))]


def known_studies(source):
    """The files of the built-in studies and of those that test reasons, by name."""
    studies = source / "studies"
    return {**{path.stem: path for path in studies.glob("catalogue/*/*.prm")},
            **{REASONS + path.stem: path for path in (studies / REASONS).glob("*.prm")}}


def has_paper_scale(path):
    """Whether a study file, or one that it includes, has the scale `paper`."""
    return any(SCALE in file.read_text(encoding="utf-8") for file in study_files(path))


def options(study):
    """How a study is run for the reference."""
    if study in PUBLISHED:
        return ["--published", "--no-figures"]
    scale = [] if study in COLLECTIONS or study.startswith(REASONS) else ["--scale", "paper"]
    return [*scale, "--no-figures"]


def keep(results, reference, study):
    """Replaces a study's reference by new results."""
    new = (reference / study).with_name(f".{Path(study).name}.new")
    shutil.rmtree(new, ignore_errors=True)
    new.mkdir(parents=True)
    shutil.copy2(results / "provenance.json", new)
    for name in KEPT_OF_COLLECTIONS if study in COLLECTIONS else KEPT:
        if (results / name).exists():
            packed(new / name).write_bytes(lzma.compress((results / name).read_bytes(), preset=9))
    if study in COLLECTIONS:
        (new / "tables").mkdir()
        for table in (path for pattern in TABLES for path in (results / "tables").glob(pattern)):
            shutil.copy2(table, new / "tables")
    shutil.rmtree(reference / study, ignore_errors=True)
    new.rename(reference / study)
    same_numbers.drop_record(reference, study)


def compare(results, reference, study):
    """Says and keeps whether results have the numbers of a study's reference; returns whether they have."""
    n_rows, different = same_numbers.differences(reference / study, results)
    commits = [provenance(folder)["program"]["commit"] for folder in (reference / study, results)]
    same_numbers.keep_record(reference, study, *commits, n_rows, len(different))
    print(f"{study}: {len(different)} of {n_rows} rows differ", *different[:SHOWN], sep="\n  ", flush=True)
    return not different


def is_compared(reference, study, commit):
    """Whether a study's reference was compared with what a commit gives."""
    record = same_numbers.read_records(reference).get(study, {})
    return same_numbers.is_of(record, provenance(reference / study)) and record["again"] == commit


def is_of_program(source, reference, study, commit):
    """Whether a study's reference was made by a program with the sources of a commit's, from the same study where that
    commit has it."""
    sessions = provenance(reference / study)["sessions"]
    for session in sessions:
        commit_named(source, session["commit"])
    files = [file.relative_to(source) for file in study_files(known_studies(source)[study])]
    return not any(session["uncommitted_changes"] or git(source, "diff", "--name-only", session["commit"], commit, "--", *SOURCES)
                   or git(source, "diff", "--name-only", "--diff-filter=M", session["commit"], commit, "--", *files)
                   for session in sessions)


def keep_program_of(source, reference, chosen, commit):
    """Says and keeps which references were made by a commit's program, although they are of another commit."""
    for study in chosen:
        found = provenance(reference / study)
        if (reference / study).is_dir() and not made_by(found, commit) and not is_compared(reference, study, commit) and \
                is_of_program(source, reference, study, commit):
            same_numbers.keep_same_program(reference, study, found["program"]["commit"], commit)
            print(f"{study}: of the program of {commit}")


def git(source, *words):
    """What git says of the sources."""
    return subprocess.run(["git", "-C", source, *words], capture_output=True, text=True, check=True).stdout.strip()


def commit_named(source, name):
    """The whole name of a commit; ends the program if there is none."""
    try:
        return git(source, "rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
    except subprocess.CalledProcessError:
        refuse(f"there is no commit '{name}' here; git log lists them, git fetch --unshallow brings those of a whole history")


def has_changes(source):
    """Whether there are changes beside the commit, but for what the reference itself writes."""
    return bool(git(source, "status", "--porcelain", "--", ".", ":!results/reference"))


def refuse(why):
    """Ends the program with one sentence; exit code 1 is for studies that differ."""
    print(f"reference: {why}", file=sys.stderr)
    sys.exit(2)


def chosen_studies(words, reference):
    """The studies to run, shortest ones first; ends the program where one cannot be."""
    known = [study for study, path in known_studies(words.source).items()
             if study in COLLECTIONS or study.startswith(REASONS) or has_paper_scale(path)]
    wrong = [study for study in words.studies if study not in known]
    if wrong:
        refuse(f"there is no study '{wrong[0]}' with a reference; choose of {', '.join(sorted(known))}")
    found = words.studies or known
    if words.compare:
        missing = [study for study in words.studies if not (reference / study).is_dir()]
        if missing:
            refuse(f"'{missing[0]}' has no reference to compare with; run it without --compare first")
        found = [study for study in found if (reference / study).is_dir()]
    return sorted(found, key=lambda study: seconds(reference / study))


def why_not(reference, study, commit, comparing):
    """Why a study need not be run, empty if it has to be."""
    if is_done(reference / study, commit):
        return "of this commit already"
    return "compared with this commit already" if comparing and is_compared(reference, study, commit) else ""


def main():
    """Runs what has to be run; returns the exit code."""
    parser = argparse.ArgumentParser(description="runs the studies of results/reference")
    for name in ("source", "program", "work"):
        parser.add_argument(name, type=Path)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--compare", action="store_true",
                      help="leave references as they are, and say whether this commit gives their numbers")
    what.add_argument("--program-of", metavar="COMMIT", help="run nothing, and say which references have that commit's program")
    parser.add_argument("studies", nargs="*")
    words = parser.parse_intermixed_args()  # --compare may stand before studies
    reference = words.source / "results" / "reference"
    chosen = chosen_studies(words, reference)
    if words.program_of:
        keep_program_of(words.source, reference, chosen, commit_named(words.source, words.program_of))
        return 0
    if has_changes(words.source):
        refuse("there are changes that are not committed; commit them first, so that the results can be made again")
    commit, same = git(words.source, "rev-parse", "HEAD"), True
    for study in chosen:
        reason = why_not(reference, study, commit, words.compare)
        print(f"{study}: {reason}" if reason else study, flush=True)
        if reason:
            continue
        results = words.work / study
        if not is_done(results, commit):
            found = provenance(results)
            other = ["--force"] if found and not made_by(found, commit) else []
            file = known_studies(words.source)[study] if study.startswith(REASONS) else study
            code = subprocess.run([words.program, "study", file, *options(study), "--out", results, *other],
                                  check=False).returncode
            if code != 0:
                return code
        if words.compare:
            same = compare(results, reference, study) and same
        else:
            keep(results, reference, study)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
