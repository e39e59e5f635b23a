# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests links and options in README.md and the manual, without running their commands."""

import re
import unittest

from launcher.tests.build_folder import COMMANDS, DRAWING, SMOOTHFEM, SOURCE, run

from .pages import BLOCK, DOCS, pages

# Written at build time by docs/reference_pages.py.
MADE = {"reference/commands.md", "reference/study-keys.md", "reference/columns.md", "reference/methods.md", "reference/presets.md",
        "reference/metrics.md", "reference/domains.md", "reference/solutions.md", "reference/formats.md", "reference/studies.md",
        "explanation/claims.md"}
LINK = re.compile(r"\]\(([^)\s]+)\)")
# Options of external programs.
OTHERS = {"--at", "--clamp", "--exclusive", "--gtest", "--load", "--plane"}


def texts():
    """Returns {path: text without fenced blocks} of all pages, and of the READMEs that link to them."""
    paths = [*pages().values(), SOURCE / "results" / "README.md", SOURCE / "adapters" / "README.md", SOURCE / "studies" / "thesis" / "README.md",
             SOURCE / "studies" / "reasons" / "README.md"]
    return {path: BLOCK.sub("", path.read_text(encoding="utf-8")) for path in paths}


class Text(unittest.TestCase):
    def test_links_lead_to_files(self):
        made = {DOCS / name for name in MADE}
        n_links = 0
        for path, text in texts().items():
            for link in LINK.findall(text):
                if "://" in link or link.startswith(("#", "mailto:")):
                    continue
                n_links += 1
                target = (path.parent / link.partition("#")[0]).resolve()
                self.assertTrue(target.exists() or target in made, f"{path.relative_to(SOURCE)}: {link}")
                if path.is_relative_to(DOCS):  # the site has the folder docs only
                    self.assertTrue(target.is_relative_to(DOCS), f"{path.relative_to(SOURCE)}: {link}")
        self.assertGreater(n_links, 50)

    def test_options_exist(self):
        scripts = (SOURCE / "run", *(SOURCE / "tools").glob("*.py"), *(SOURCE / "tools" / "commands").iterdir())
        known = "".join(path.read_text(encoding="utf-8") for path in scripts)
        known += "".join(run(SMOOTHFEM, command, "--help").stdout for command in (*COMMANDS, *DRAWING))
        options = {option for text in texts().values() for option in re.findall(r"`(?:\./run \w+ )?(--[a-z][a-z-]*)", text)}
        self.assertGreater(len(options), 15)
        self.assertEqual({option for option in options - OTHERS if option not in known}, set())

    def test_pages_name_no_folder_of_a_machine(self):
        for path in (*pages().values(), SOURCE / "results" / "README.md"):
            self.assertNotRegex(path.read_text(encoding="utf-8"), r"(?<![\w.])/(home|root|work|tmp)/", path)


if __name__ == "__main__":
    unittest.main()
