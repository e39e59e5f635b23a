# SPDX-License-Identifier: GPL-3.0-or-later
"""The manual page has the options of the program's help."""

import re
import unittest

from .build_folder import COMMANDS, DRAWING, SMOOTHFEM, SOURCE, run

PAGE = SOURCE / "launcher" / "smoothfem.1"
OPTION = re.compile(r"(?<![\w-])--?[a-z][a-z-]*")


def sections():
    """Returns the page's text on each command."""
    text = PAGE.read_text(encoding="utf-8").replace("\\-", "-").replace("\\fR", " ")
    parts = re.split(r"^\.S[SH] (.*)$", text, flags=re.MULTILINE)
    return {title.split()[1]: body for title, body in zip(parts[1::2], parts[2::2]) if title.startswith("smoothfem ")}


class Manual(unittest.TestCase):
    def test_has_each_command_with_its_options(self):
        self.assertEqual(sorted(sections()), sorted((*COMMANDS, *DRAWING)))
        program = SMOOTHFEM.parents[1] / "libexec" / "smoothfem" / "smoothfem"
        for command in (*COMMANDS, *DRAWING):
            shown = set(OPTION.findall(" ".join(
                line for line in run(SMOOTHFEM if command in DRAWING else program, command,
                                     "--help").stdout.splitlines() if line.startswith("  -"))))
            shown = {option for option in shown if not option.startswith("-h") and option != "--help"}
            described = set(OPTION.findall(sections()[command]))
            self.assertEqual({option for option in shown if option.startswith("--")} - described, set(), command)
            self.assertEqual({option for option in described if option.startswith("--")} - shown, set(), command)

    def test_renders_without_warnings(self):
        outcome = run("man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", PAGE, MANWIDTH="80", LC_ALL="C.UTF-8")
        self.assertEqual(outcome.stderr, "")
        self.assertIn("smoothfem - find out", outcome.stdout.replace("‐", "-").replace("−", "-"))


if __name__ == "__main__":
    unittest.main()
