# SPDX-License-Identifier: GPL-3.0-or-later
"""Criteria are dated, and none is changed without a trace."""

import json
import re
import subprocess
import sys
import unittest

from plots.claims.criteria import read_criteria
from plots.claims.report import criterion_of
from plots.results.data_folder import thesis_folder

CLAIMS = "studies/thesis/claims.json"
HOW_TO = "commit the claim, then write the commit's name and date to studies/thesis/criteria.csv"


def git(*arguments):
    """Output of git about the repository; raises CalledProcessError or OSError."""
    return subprocess.run(["git", "-C", str(thesis_folder()), *arguments], capture_output=True, text=True,
                          check=True).stdout.strip()


def claims_by_name(text):
    """Name -> claim."""
    return {claim["id"]: claim for claim in json.loads(text)}


def claims_at(commit):
    """The claims as they were then; none if there was no such file."""
    try:
        return claims_by_name(git("show", f"{commit}:{CLAIMS}"))
    except subprocess.CalledProcessError:
        return {}


def judged_by(claim):
    """The parts of a claim that decide about it, in words and for the program."""
    return claim["criterion"], claim["checks"]


class Criteria(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.claims = claims_by_name((thesis_folder() / "claims.json").read_text(encoding="utf-8"))
        cls.criteria = read_criteria()

    def test_every_claim_has_a_line(self):
        self.assertEqual(set(self.criteria), set(self.claims), HOW_TO)
        for claim_id, criterion in self.criteria.items():
            for date in filter(None, (criterion.written, criterion.changed)):
                self.assertRegex(date, r"^\d{4}-\d\d-\d\d$", claim_id)

    def test_revised_criteria_follow_the_first_one(self):
        ids = list(self.claims)
        for claim_id, claim in self.claims.items():
            if "revises" in claim:
                first = self.claims[claim["revises"]]
                self.assertEqual(ids.index(claim["revises"]) + 1, ids.index(claim_id), claim_id)
                self.assertEqual((claim["study"], claim["section"]), (first["study"], first["section"]))
                self.assertNotEqual(judged_by(claim), judged_by(first), claim_id)

    def test_tables_say_that_results_were_known(self):
        for claim_id, criterion in self.criteria.items():
            shown = criterion_of({**self.claims[claim_id], "history": criterion})
            self.assertEqual("our results were known" in shown, criterion.results_known)
            self.assertEqual(criterion.written in shown, "revises" in self.claims[claim_id]
                             or criterion.results_known or bool(criterion.changed))


class History(unittest.TestCase):
    """Against the commits, where they are at hand."""

    def setUp(self):
        try:
            reason = ("the history is shallow" if git("rev-parse", "--is-shallow-repository") == "true" else
                      "" if git("ls-files", "claims.json") else "the sources are not under git")
        except (OSError, subprocess.CalledProcessError) as error:
            reason = f"git does not answer ({getattr(error, 'stderr', '') or error})"
        if reason:
            print(f"\nNOT CHECKED: whether criteria were changed: {reason.strip()}.", file=sys.stderr)
            self.skipTest(reason)

    def test_criteria_are_those_of_their_commits(self):
        now = claims_by_name((thesis_folder() / "claims.json").read_text(encoding="utf-8"))
        criteria = read_criteria()
        for commit in {criterion.commit for criterion in criteria.values()}:
            then, before = claims_at(commit), claims_at(f"{commit}^")
            date = git("show", "--no-patch", "--format=%as", commit)
            for claim_id in (name for name, criterion in criteria.items() if criterion.commit == commit):
                criterion = criteria[claim_id]
                self.assertIn(claim_id, then, f"{commit}: {HOW_TO}")
                self.assertEqual(judged_by(now[claim_id]), judged_by(then[claim_id]), f"{claim_id}: {HOW_TO}")
                self.assertEqual(criterion.changed or criterion.written, date, f"{claim_id}: {HOW_TO}")
                self.assertEqual(claim_id in before, bool(criterion.changed), f"{claim_id} was written before")


class Words(unittest.TestCase):
    """Words on claims that do not hold."""

    # Numbers that are no measurements: sections, degrees, claims, what the thesis' text prints.
    NAMES = re.compile(r"\{[^{}]*\}|Sections? \d[\d.]*|Chapter \d|Fig\. [\d.]+|d = [12]|\b[A-Z]\d+b?\b|"
                       r"printed \d[\d.,]*\d|printed \d")

    def test_notes_and_guesses_have_no_numbers_of_their_own(self):
        claims = json.loads((thesis_folder() / "claims.json").read_text(encoding="utf-8"))
        for claim in claims:
            for key in ("note", "guess"):
                self.assertNotRegex(self.NAMES.sub("", claim.get(key, "")), r"\d", claim["id"])
            self.assertNotIn("{", claim.get("guess", ""), "a measured number is not a guess")
