# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the commands of README.md and of the manual: the `sh` blocks of a page are one session of a shell.

A block after a line with a file name in backticks and a colon is a file. It is written first. ctest has an entry for each page."""

import os
import re
import stat
import tempfile
import unittest
from pathlib import Path

from launcher.tests.build_folder import BUILD, SOURCE, run
from launcher.tests.test_fetch_published import Server

from . import gear_results
from .pages import blocks, has_commands, pages, test_name

HERE = Path(__file__).resolve().parent
SHARED = Path(os.environ.get("SMOOTHFEM_MESHES", SOURCE.parent / "shared" / "meshes"))
PUBLISHED = ("gear_tri_initial.mesh", "gear_quad_initial.mesh")

# Commands that take minutes or hours -> the command that the test runs instead.
SHORTER = {
    "smoothfem study gear": "smoothfem study gear --dry-run",
    "smoothfem study gear --published": "begin_and_stop smoothfem study gear --published --quick --out results/published",
    "smoothfem study gear --mesh-dir FOLDER": f"smoothfem study gear --mesh-dir '{SHARED}' --dry-run",
    "smoothfem study collection --published mesquite": "smoothfem study collection --published mesquite --dry-run",
    "smoothfem study volume --scale paper --dry-run": "smoothfem study volume --scale quick --dry-run",
    "smoothfem study volume --scale paper": "begin_and_stop smoothfem study volume --scale paper",
    "smoothfem study all --scale quick": "begin_and_stop smoothfem study all --scale quick --out results/all",
    "smoothfem study subdivision --scale quick --quiet": "smoothfem study subdivision --scale quick --dry-run",
    "smoothfem plot merged --quiet": "smoothfem plot merged --quiet --no-figures",
    "smoothfem study energy-layer --scale quick": "begin_and_stop smoothfem study energy-layer --scale quick",
    "smoothfem study gear --quick --quiet --retime": "begin_and_stop smoothfem study gear --quick --retime",
    "smoothfem study polygons --quick --quiet": "begin_and_stop smoothfem study polygons --quick",
    # Coarser meshes and no optimization: test_new_smoother.py and test_installed.py in launcher/tests run the unchanged templates.
    "smoothfem study mine.prm --quiet": "sed -i '/edge scale/s/2/3/; /max_iterations/s/16/2/; /^subsection mesh quad/,/^end/d; /^set meshes/s/, quad//' mine.prm; "
                                        "smoothfem study mine.prm --quiet",
    "smoothfem study half-laplace.prm --quiet": "sed -i '/edge scale/s/2/3/; /^subsection mesh quad/,/^end/d; /^set meshes/s/, quad//' half-laplace.prm; "
                                                "smoothfem study half-laplace.prm --quiet",
    "smoothfem study heat-flow.prm --quiet --no-figures": "sed -i '/edge scale/s/2/3/' heat-flow.prm; smoothfem study heat-flow.prm --quiet --no-figures",
    "cmake -S . -B build": "cmake -S . -B build -DCMAKE_BUILD_TYPE=None",
}
# Commands above that are run whole with the long tests: minutes, not hours.
WHOLE = ("smoothfem study gear --published", "smoothfem study subdivision --scale quick --quiet", "smoothfem study polygons --quick --quiet",
         "smoothfem study energy-layer --scale quick")
NEED_PUBLISHED = ("--published", "--mesh-dir")
# `console` blocks are not run: {page: reason}.
CONSOLE = {
    "how-to/many-meshes": "mpirun across machines, SLURM and GNU parallel are not available; `--shard` and `merge` are run above them",
    "how-to/many-processes": "processes of mpirun; the tests in distributed/tests run this work on 1 to 7",
    "how-to/restart-and-mpi": "a study of hours on several processes; studies/tests/test_resume.cc runs studies with mpirun",
    "tutorials/smoother-in-python": "it runs until Ctrl-C; launcher/tests/test_watch.py changes a study that is watched",
    "how-to/latex": "LaTeX is optional; plots/tests/test_latex.py makes the figures and tables of this page and compiles its document",
    "how-to/cpp-libraries": "needs an installation; launcher/tests/test_installed.py builds and runs this program",
    "how-to/develop": "the fuzzers are built by clang in a folder of their own; plots/tests/test_manual.py checks the generated blocks",
}
# Listings that are neither files nor commands: {(page, language): reason}.
LISTINGS = {
    ("how-to/smoother-in-cpp", "cpp"): "studies/CMakeLists.txt compiles it into documented_smoother_test",
    ("how-to/solver-in-cpp", "cpp"): "two lines that need the class around them",
    ("explanation/architecture", "text"): "the data flow",
    ("how-to/second-order", "text"): "a part of a study; launcher/tests/test_adapters.py runs its program",
}
# Commands of one page: drawing all figures of a study takes 12 s, and launcher/tests/test_installed.py tests it.
SHORTER_ON_PAGE = {
    ("tutorials/first-study", "smoothfem study gear --quick --quiet"):
        "smoothfem study gear --quick --quiet --no-figures; smoothfem plot results/gear --only history --quiet",
}
# Texts in the output of the session of a page.
EXPECTED = {
    "readme": r"true errors, as factors",
    "tutorials/first-study": r"(?s)Nothing has been written.*iterations\.csv.*\.pdf.*Smart Laplace.*Peak resident memory",
    "tutorials/your-mesh-your-problem": r"Smart Laplace",
    "tutorials/smoother-in-python": r"(?s)To centroids.*mine",
    "how-to/smoother-in-cpp": r"(?s)100% tests passed.*\| HalfLaplace",
    "how-to/solver-in-cpp": r"(?s)100% tests passed.*records h1_error.*\| quad",
    "how-to/smoother-as-a-program": r"(?s)\$ .*exit code 0",
    "how-to/many-meshes": r"(?sm)^gear3\.smooth,complete,$",
    "how-to/latex": r"(?s)history\S*\.pdf.*tab:gear:",
    "how-to/pandas": r"(?m)^tri +1 ",
    "how-to/python": r"(?sm)^\d+/\d+ Quality\(q_min=0\.\d.*untangled \d+ .*python:Spring.*smoothfem\.Solution: degree 2.*getme",
    "how-to/restart-and-mpi": r"volume",
    "explanation/reducing-the-error": r"(?s)energy-descent.*\| moving \|",
}
# Files that have to exist after the session.
MADE = {
    "readme": ("out.vtu", "results/gear/summary.csv", ".local/bin/smoothfem"),
    "tutorials/first-study": ("results/gear/figures",),
    "how-to/latex": ("error.pdf", "quality.pdf", "errors.tex", "results/gear/report.html"),
    "how-to/keep-what-a-file-says": ("smoothed.msh", "moved.msh", "other.msh"),
    "how-to/check-and-repair": ("whole.vtk", "smoothed.vtk"),
    "how-to/second-order": ("better.vtu",),
    "how-to/untangle-and-slide": ("valid.vtk", "slid.vtu", "smooth-roof.vtu", "bad.vtu", "local.vtu"),
    "how-to/reproduce-the-thesis": ("out.msh", "tuned.msh"),
    "reference/result-files": ("counts.csv", "quality.png"),
}


def session(name, path):
    """Returns the lines of a page's commands, with replacements for long commands."""
    lines = ["set -eu"]
    for block in blocks(path):
        if block.language == "sh" and not block.file:
            for line in block.text.splitlines():
                command = re.sub(r" +#.*", "", line)
                lines.append(SHORTER_ON_PAGE.get((name, command)) or SHORTER.get(command, line))
    return lines


def published(test, lines, folder):
    """Returns the environment for lines that need the published meshes; removes these lines if the meshes are missing."""
    wanted = [line for line in lines if any(option in line for option in NEED_PUBLISHED) and "study collection" not in line]
    if not wanted:
        return {}
    if not all((SHARED / name).is_file() for name in PUBLISHED):
        print(f"SKIPPED: the published meshes are not in {SHARED} (SMOOTHFEM_MESHES): {'; '.join(wanted)}")
        lines[:] = [line for line in lines if line not in wanted]
        return {}
    server = Server({name: (SHARED / name).read_bytes() for name in PUBLISHED})
    test.addCleanup(server.close)
    return {"SMOOTHFEM_PUBLISHED_URL": server.url, "XDG_CACHE_HOME": folder / ".cache", "no_proxy": "*"}


class Pages(unittest.TestCase):
    """One test for each page with commands; add_test creates them."""

    maxDiff = None

    def play(self, name, path):
        """Runs the session of a page in an empty folder."""
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary)
            tools = folder / ".tools"
            tools.mkdir()
            (tools / "begin_and_stop").symlink_to(HERE / "begin_and_stop")
            (folder / "run").symlink_to(HERE / "run_stub")
            lines = session(name, path)
            if any("study gear --quick" in line or "results/gear" in line for line in lines):
                gear_results.copy_to(folder)
            for block in blocks(path):
                if block.file:
                    (folder / block.file).write_text(block.text, encoding="utf-8")
                    if block.text.startswith("#!"):
                        (folder / block.file).chmod(0o755)
            more = published(self, lines, folder)
            more["SMOOTHFEM_NO_FIGURES"] = "1"  # `plot` draws the figures of a page
            shown = run("bash", "-c", "\n".join(lines), folder=folder, HOME=folder, SMOOTHFEM_SOURCE=SOURCE, SMOOTHFEM_BUILD=BUILD,
                        PATH=os.pathsep.join((str(BUILD / "bin"), str(tools), os.environ["PATH"])),
                        PYTHONPATH=BUILD / "lib" / "python3" / "dist-packages", CMAKE_PREFIX_PATH=BUILD, **more).stdout
            self.assertRegex(shown, EXPECTED.get(name.lower(), "^"))
            for made in MADE.get(name.lower(), ()):
                self.assertTrue((folder / made).exists(), made)


def add_test(name, path):
    """Adds the test of a page."""
    def test(self):
        self.play(name, path)
    test.__doc__ = f"{path.relative_to(SOURCE)}: its commands."
    setattr(Pages, test_name(name), test)


for page_name, page_path in pages().items():
    if has_commands(page_path):
        add_test(page_name, page_path)


class WholeCommands(unittest.TestCase):
    def test_commands_that_pages_only_begin(self):
        """Each command ends, has a row for every method, and draws its figures."""
        for command in WHOLE:
            with self.subTest(command), tempfile.TemporaryDirectory() as temporary:
                folder = Path(temporary)
                lines = [command]
                more = published(self, lines, folder)
                if not lines:
                    continue
                run("bash", "-c", command, folder=folder, HOME=folder, PATH=os.pathsep.join((str(BUILD / "bin"), os.environ["PATH"])), **more)
                results, = (folder / "results").iterdir()
                self.assertTrue(list((results / "figures").glob("*.pdf")), results)
                self.assertTrue(list((results / "tables").glob("*.md")), results)
                self.assertIn('"status": "complete"', (results / "provenance.json").read_text(encoding="utf-8"))


class EveryBlock(unittest.TestCase):
    def test_is_run_or_has_a_reason(self):
        """Each fenced block is a command, a file, a directive, or listed with a reason."""
        consoles, listings = set(), set()
        for name, path in pages().items():
            for block in blocks(path):
                if block.language.startswith("{") or block.language == "sh":
                    continue
                if block.language == "console":
                    self.assertIn(name, CONSOLE)
                    consoles.add(name)
                elif block.file is None:
                    self.assertIn((name, block.language), LISTINGS)
                    listings.add((name, block.language))
        self.assertEqual((consoles, listings), (set(CONSOLE), set(LISTINGS)))

    def test_files_are_used(self):
        """A file that a page shows occurs in its commands, in another of its files, or has a test elsewhere."""
        for name, path in pages().items():
            for block in blocks(path):
                if block.file and name != "how-to/cpp-libraries":
                    others = [other.text for other in blocks(path) if other is not block]
                    self.assertTrue(any(block.file in text for text in others) or f"`{block.file}`" in path.read_text(encoding="utf-8"),
                                    f"{name}: {block.file}")

    def test_program_with_the_libraries_is_the_one_that_is_built(self):
        for block in blocks(pages()["how-to/cpp-libraries"]):
            if block.file:
                text = (SOURCE / "launcher" / "tests" / "installed_program" / block.file).read_text(encoding="utf-8")
                self.assertTrue(text.endswith(block.text), block.file)

    def test_shorter_commands_are_in_pages(self):
        lines = {re.sub(r" +#.*", "", line) for path in pages().values() for block in blocks(path) if block.language == "sh"
                 for line in block.text.splitlines()}
        self.assertLessEqual(set(WHOLE), set(SHORTER))
        self.assertLessEqual({*SHORTER, *(command for _, command in SHORTER_ON_PAGE)}, lines)

    def test_expectations_are_of_pages(self):
        names = {name.lower() for name, path in pages().items() if has_commands(path)}
        self.assertLessEqual({*EXPECTED, *MADE}, names)
        self.assertTrue(os.stat(HERE / "run_stub").st_mode & stat.S_IXUSR)

    def test_readme_has_the_two_commands(self):
        lines = (SOURCE / "README.md").read_text(encoding="utf-8").splitlines()
        self.assertLessEqual(len(lines), 120)
        self.assertIn("./run study gear", lines)
        self.assertIn("./run test", lines)


if __name__ == "__main__":
    unittest.main()
