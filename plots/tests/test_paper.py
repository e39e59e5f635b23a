# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper: references, figures, length and generated blocks."""

import re
import unittest

from plots.results.data_folder import data_folder

PAPER = data_folder() / "paper"
WORDS = (750, 1750)  # of the Journal of Open Source Software
SECTIONS = ("Summary", "Statement of need", "State of the field", "Functionality", "How it is tested", "Results", "Availability",
            "Acknowledgements", "References")


def body():
    """The text without its header and comments."""
    text = (PAPER / "paper.md").read_text(encoding="utf-8")
    _, header, rest = text.split("---\n", 2)
    assert "title:" in header
    return re.sub(r"<!--.*?-->", "", rest, flags=re.DOTALL)


def entries():
    """{key: text} of the references."""
    text = (PAPER / "paper.bib").read_text(encoding="utf-8")
    return {match[1]: match[2] for match in re.finditer(r"^@\w+\{(\w+),\n(.*?)^\}$", text, re.MULTILINE | re.DOTALL)}


class Paper(unittest.TestCase):
    def test_references_are_cited_and_the_other_way_round(self):
        cited = set(re.findall(r"@([a-z]\w*)", body()))
        self.assertEqual(cited, set(entries()))
        self.assertEqual(len(entries()), (PAPER / "paper.bib").read_text(encoding="utf-8").count("\n@"))

    def test_references_can_be_found(self):
        for key, entry in entries().items():
            self.assertRegex(entry, r"(?m)^  (doi|url|note) +=", key)
            self.assertNotRegex(entry, r"doi += \{(?!10\.\d{4,}/)", key)
        self.assertIn("10.1201/9780429399626", entries()["getme"])

    def test_figures_exist_and_have_captions(self):
        figures = re.findall(r"!\[([^\]]*)\]\(([^)]+)\)", body())
        self.assertGreater(len(figures), 0)
        for caption, path in figures:
            self.assertTrue((PAPER / path).is_file(), path)
            self.assertTrue(caption.endswith("."), path)

    def test_length(self):
        text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", body())
        n_words = len(re.findall(r"\w[^\s]*", text))
        self.assertTrue(WORDS[0] <= n_words <= WORDS[1], n_words)

    def test_sections(self):
        self.assertEqual(tuple(re.findall(r"^# (.*)$", body(), re.MULTILINE)), SECTIONS)

    def test_numbers_of_results_are_generated(self):
        """test_manual.py compares the blocks with the results. No other line of the section has a number."""
        text = (PAPER / "paper.md").read_text(encoding="utf-8")
        results = text.partition("# Results\n")[2].partition("# Availability\n")[0]
        rest, n_blocks = re.subn(r"<!-- begin (\S+): made by .*?<!-- end \1 -->", "", results, flags=re.DOTALL)
        self.assertEqual(n_blocks, 2)
        self.assertNotRegex(rest, r"\d")


if __name__ == "__main__":
    unittest.main()
