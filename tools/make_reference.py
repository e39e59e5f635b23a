#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built-in studies for results/reference, shortest ones first.

    make_reference.py SOURCE PROGRAM WORK [--compare | --program-of COMMIT] [STUDY...]

All studies run at the scale `paper`, except the gear on the published meshes, some collections, which run at
their default scale, and those of OTHER_SCALES. The script resumes after an interruption: it skips studies whose reference is of this commit, and an interrupted study
resumes. With --compare, references do not change. The script then records in results/reference/again.csv whether this
commit gives the same numbers; exit code 1 means that numbers differ. With --program-of nothing is run. The script then
records which references were made by a program with the same sources as that commit.

PROGRAM: bin/smoothfem, built from SOURCE without uncommitted changes. WORK: folder in which studies run, with their
meshes and figures. The references are in results/reference of SOURCE. Needs plots on PYTHONPATH."""

import argparse
import lzma
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from plots.results import same_numbers
from plots.results.rows import packed, read_provenance

# Files kept of a study: its packed rows, from which `smoothfem plot` makes tables and figures.
KEPT = ("iterations.csv", "summary.csv", "refined.csv", "solutions.csv", "thresholds.csv")
FIELDS = ("field", "field-volume", "field-large")
SETS = ("collection-hexalab", "collection-mesquite", "collection-sfepy")  # of published meshes
# Run at their default scale.
COLLECTIONS_AS_THEY_ARE = (*SETS, "orders", "orders-volume", "energy-corners", "energy-field", "energy-field-quadratic", "energy-robust", "curved", "curved-angles", "curved-straight")
COLLECTIONS = (*FIELDS, *COLLECTIONS_AS_THEY_ARE)
KEPT_OF_COLLECTIONS = ("members.csv", "summary.csv", "refined.csv")
TABLES = ("*.md", "*.csv")  # tables of collections: they need iterations.csv and metrics.csv, which are too large to keep
REASONS = "reasons/"  # studies that test reasons: reasons/NAME
PUBLISHED = (*SETS, "gear", "energy", "reasons/gear-converged", "reasons/gear-mesquite", "reasons/gear-rounding")  # studies on the published meshes
OTHER_SCALES = {"volume-huge": ("volume", "huge")}  # references of a study at another scale than `paper`
SCALE = "subsection scale paper"
SOURCES = ("*.cc", "*.h", "cmake", "CMakeLists.txt", "CMakePresets.json", ":!*/tests/*", ":!*/bench/*")  # of the program
UNKNOWN_SECONDS = 1e9  # studies without a reference run last
SHOWN = 5  # number of different rows to print


def provenance(folder):
    """Returns the content of provenance.json of a results folder; empty if there is no such file."""
    return read_provenance(folder / "provenance.json")


def is_done(folder, commit):
    """Returns True if a folder has complete results of a study, made by the program of a commit."""
    found = provenance(folder)
    return found.get("status") == "complete" and made_by(found, commit)


def made_by(found, commit):
    """Returns True if the program of a commit made the results."""
    program = found.get("program", {})
    return program.get("commit") == commit and not program.get("uncommitted_changes")


def seconds(folder):
    """Returns the duration of the study's last run."""
    return sum(provenance(folder).get("seconds", {}).values()) or UNKNOWN_SECONDS


def study_files(path):
    """Returns a study's file, and the files that it includes."""
    included = re.findall(r"^\s*include\s+(\S+)", path.read_text(encoding="utf-8"), re.MULTILINE)
    return [path, *(file for name in included for file in study_files(path.parent / name))]


def known_studies(source):
    """Returns the files of the built-in studies and of studies that test reasons, by name."""
    studies = source / "studies"
    built_in = {path.stem: path for path in studies.glob("catalogue/*/*.prm")}
    return {**built_in, **{REASONS + path.stem: path for path in (studies / REASONS).glob("*.prm")},
            **{name: built_in[study] for name, (study, _) in OTHER_SCALES.items() if study in built_in}}


def has_paper_scale(path):
    """Returns True if a study file, or a file that it includes, has the scale `paper`."""
    return any(SCALE in file.read_text(encoding="utf-8") for file in study_files(path))


def options(study):
    """Returns the options of a study's run for the reference."""
    if study in PUBLISHED:
        return ["--published", "--no-figures"]
    if study in OTHER_SCALES:
        return ["--scale", OTHER_SCALES[study][1], "--no-figures"]
    scale = [] if study in COLLECTIONS_AS_THEY_ARE or study.startswith(REASONS) else ["--scale", "paper"]
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
    """Prints, records and returns whether results have the numbers of a study's reference."""
    n_rows, different = same_numbers.differences(reference / study, results)
    commits = [provenance(folder)["program"]["commit"] for folder in (reference / study, results)]
    same_numbers.keep_record(reference, study, *commits, n_rows, len(different))
    print(f"{study}: {len(different)} of {n_rows} rows differ", *different[:SHOWN], sep="\n  ", flush=True)
    return not different


def is_compared(reference, study, commit):
    """Returns True if a study's reference was compared with the results of a commit."""
    record = same_numbers.read_records(reference).get(study, {})
    return same_numbers.is_of(record, provenance(reference / study)) and record["again"] == commit


def is_of_program(source, reference, study, commit):
    """Returns True if a program with the sources of a commit made a study's reference. If that commit has the study, it must be
    the same one."""
    sessions = provenance(reference / study)["sessions"]
    for session in sessions:
        commit_named(source, session["commit"])
    files = [file.relative_to(source) for file in study_files(known_studies(source)[study])]
    return not any(session["uncommitted_changes"] or git(source, "diff", "--name-only", session["commit"], commit, "--", *SOURCES)
                   or any_changed(source, session["commit"], commit, files) for session in sessions)


def any_changed(source, old, new, files):
    """Returns True if one of the files differs between two commits, under its old name if it was moved. A new file does not."""
    names = {os.path.normpath(file) for file in files}
    lines = git(source, "diff", "--name-status", "--find-renames", "--diff-filter=MR", old, new, "--", "*.prm").splitlines()
    return any(words[-1] in names and words[0] != "R100" for words in (line.split("\t") for line in lines))


def keep_program_of(source, reference, chosen, commit):
    """Prints and records the references of other commits that a program with the sources of this commit made."""
    for study in chosen:
        found = provenance(reference / study)
        if (reference / study).is_dir() and not made_by(found, commit) and not is_compared(reference, study, commit) and \
                is_of_program(source, reference, study, commit):
            same_numbers.keep_same_program(reference, study, found["program"]["commit"], commit)
            print(f"{study}: made by the program of {commit}")


def git(source, *words):
    """Returns the output of git about the sources."""
    return subprocess.run(["git", "-C", source, *words], capture_output=True, text=True, check=True).stdout.strip()


def commit_named(source, name):
    """Returns the full name of a commit; ends the program if there is no such commit."""
    try:
        return git(source, "rev-parse", "--verify", "--quiet", f"{name}^{{commit}}")
    except subprocess.CalledProcessError:
        refuse(f"there is no commit '{name}' here; git log lists commits, and git fetch --unshallow fetches the whole history")


def has_changes(source):
    """Returns True if there are uncommitted changes outside results/reference."""
    return bool(git(source, "status", "--porcelain", "--", ".", ":!results/reference"))


def refuse(why):
    """Ends the program with one sentence and exit code 2, as exit code 1 means that studies differ."""
    print(f"reference: {why}", file=sys.stderr)
    sys.exit(2)


def chosen_studies(words, reference):
    """Returns the studies to run, shortest ones first; ends the program if a study cannot be run."""
    known = [study for study, path in known_studies(words.source).items()
             if study in COLLECTIONS or study.startswith(REASONS) or has_paper_scale(path)]
    wrong = [study for study in words.studies if study not in known]
    if wrong:
        refuse(f"there is no study '{wrong[0]}' with a reference; choose from {', '.join(sorted(known))}")
    found = words.studies or known
    if words.compare:
        missing = [study for study in words.studies if not (reference / study).is_dir()]
        if missing:
            refuse(f"'{missing[0]}' has no reference to compare with; run it without --compare first")
        found = [study for study in found if (reference / study).is_dir()]
    return sorted(found, key=lambda study: seconds(reference / study))


def why_not(reference, study, commit, comparing):
    """Returns the reason why a study need not be run; empty if it has to run."""
    if is_done(reference / study, commit):
        return "the reference is of this commit"
    return "the reference was compared with this commit" if comparing and is_compared(reference, study, commit) else ""


def main():
    """Runs the necessary studies; returns the exit code."""
    parser = argparse.ArgumentParser(description="runs the studies of results/reference")
    for name in ("source", "program", "work"):
        parser.add_argument(name, type=Path)
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--compare", action="store_true",
                      help="do not change references; report whether this commit gives their numbers")
    what.add_argument("--program-of", metavar="COMMIT", help="run nothing; report which references have the program of that commit")
    parser.add_argument("studies", nargs="*")
    words = parser.parse_intermixed_args()  # --compare may come before studies
    reference = words.source / "results" / "reference"
    chosen = chosen_studies(words, reference)
    if words.program_of:
        keep_program_of(words.source, reference, chosen, commit_named(words.source, words.program_of))
        return 0
    if has_changes(words.source):
        refuse("there are uncommitted changes; commit them first, so that the results can be reproduced")
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
            file = known_studies(words.source)[study] if study.startswith(REASONS) else OTHER_SCALES.get(study, [study])[0]
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
