# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests an installation in an empty folder: it runs, draws, completes names, and other programs are built with it."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

from .build_folder import BUILD, SOURCE, run
from .test_new_smoother import Study, make

ABI_MARK = b"smoothfem plugin types:\0"
PROGRAM = Path(__file__).with_name("installed_program")
STUDY = """set title   = Small
set meshes  = square
set methods = laplace, getme
set degrees = 1
subsection mesh square
  set domain     = gear
  set elements   = triangles
  set edge scale = 6
  set distort to = 0.5
end
subsection solution
  set name = gear
end
"""


class Installed(Study, unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.prefix = Path(cls.temporary.name) / "usr"
        cls.folder = Path(cls.temporary.name) / "work"
        cls.folder.mkdir()
        run("cmake", "--install", BUILD, "--prefix", cls.prefix)
        cls.smoothfem = cls.prefix / "bin" / "smoothfem"

    def smoothfem_run(self, *words, **more):
        """Runs the installed program in an empty folder."""
        return run(self.smoothfem, *words, folder=self.folder, **more)

    def test_names_no_folder_of_the_build(self):
        """Libraries and scripts do not contain paths of the sources."""
        for path in self.prefix.rglob("*"):
            if path.is_file():
                self.assertNotIn(str(SOURCE).encode(), path.read_bytes(), path)

    def test_links_of_the_manual_lead_to_installed_files(self):
        """Each link of each installed page, also of the pages that the program makes."""
        manual = self.prefix / "share" / "doc" / "smoothfem"
        for name in ("README.md", "CONTRIBUTING.md", "packages.txt", "docs/index.md", "docs/tutorials/first-study.md",
                     "docs/reference/commands.md", "docs/explanation/claims.md"):
            self.assertTrue((manual / name).is_file(), name)
        n_links = 0
        for page in self.prefix.rglob("*.md"):
            for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)):
                if "://" not in link and not link.startswith(("#", "mailto:")):
                    n_links += 1
                    self.assertTrue((page.parent / link.partition("#")[0]).exists(), f"{page.relative_to(self.prefix)}: {link}")
        self.assertGreater(n_links, 50)

    def test_smooths_and_draws(self):
        self.assertRegex(self.smoothfem_run("--version").stdout, r"^smoothfem \d+\.\d+\.\d+ \(vector registers: \w+\)$")
        self.smoothfem_run("generate", "gear", "-o", "in.msh", "--edge-scale", "4", "--distort-to", "0.45")
        self.smoothfem_run("smooth", "in.msh", "-m", "getme", "--preset", "thesis-6.3", "-o", "out.vtu")
        self.smoothfem_run("quality", "out.vtu", "--histogram", "out.png")
        self.assertEqual((self.folder / "out.png").read_bytes()[:4], b"\x89PNG")

    def test_runs_a_study_here(self):
        (self.folder / "small.prm").write_text(STUDY)
        for name in ("copy.py", "numpy.py"):  # of the user, not of Python
            (self.folder / name).write_text("raise ImportError\n")
            self.addCleanup((self.folder / name).unlink)
        link = self.folder / "linked"
        link.symlink_to(self.smoothfem)
        run(link, "study", "small.prm", "--quiet", folder=self.folder)
        results = self.folder / "results" / "small"
        for name in ("iterations.csv", "provenance.json"):
            self.assertTrue((results / name).is_file(), name)
        self.assertTrue(list((results / "tables").glob("*.md")))
        self.assertTrue(list((results / "figures").glob("*.pdf")))
        self.assertEqual(list(self.prefix.rglob("__pycache__")), [])
        self.smoothfem_run("plot", "results/small", "--quiet", "--only", "history", "--format", "svg")
        self.assertTrue((results / "figures" / "history.svg").is_file())
        refused = run(self.smoothfem, "plot", "results/small", "--only", "histroy", folder=self.folder, check=False)
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (2, 1), refused.stderr)
        self.assertIn("did you mean 'history'?", refused.stderr)

    def test_python_module(self):
        """The installed module gives the results of the installed program, also with a smoother in Python."""
        packages = self.prefix / "lib" / "python3" / "dist-packages"
        self.smoothfem_run("generate", "gear", "-o", "py.vtu", "--edge-scale", "4", "--distort-to", "0.45")
        (self.folder / "mine.py").write_text("class Mine:\n    def step(self, mesh):\n        mesh.points[mesh.free] *= 1 + 1e-9\n")
        method = "python:mine.py:Mine"
        self.smoothfem_run("smooth", "py.vtu", "-m", method, "-o", "theirs.vtu")
        told = run(os.environ.get("SMOOTHFEM_PYTHON", "/usr/bin/python3"), "-B", "-c", "import smoothfem\n"
                   f"mesh = smoothfem.read('py.vtu')\nsmoothfem.smooth(mesh, '{method}')\n"
                   "same = smoothfem.read('theirs.vtu').points == mesh.points\nprint(smoothfem.__file__, same.all())",
                   folder=self.folder, PYTHONPATH=packages).stdout
        self.assertEqual(told.split(), [str(packages / "smoothfem" / "__init__.py"), "True"])
        self.assertEqual(list(self.prefix.rglob("__pycache__")), [])

    def test_completion(self):
        script = self.prefix / "share" / "bash-completion" / "completions" / "smoothfem"

        def complete(*words):
            quoted = " ".join(f"'{word}'" for word in (self.smoothfem, *words))
            return run("bash", "-c", f"source '{script}'; COMP_WORDS=({quoted}); COMP_CWORD={len(words)}; "
                       "_smoothfem; printf '%s\\n' \"${COMPREPLY[@]}\"").stdout.split()

        self.assertEqual(complete("gen"), ["generate"])
        self.assertIn("plot", complete(""))
        self.assertIn("getme-adaptive", complete("smooth", "in.vtu", "-m", "getme"))
        self.assertNotIn("laplace", complete("smooth", "in.vtu", "-m", "getme"))
        self.assertEqual(complete("smooth", "in.vtu", "--preset", "thesis-6"), ["thesis-6.3"])
        self.assertEqual(complete("study", "nonu"), ["nonuniform-grid"])
        self.assertEqual(complete("list", "preset"), ["presets"])
        self.assertEqual(complete("list", "smart"), ["smart-laplace"])
        self.assertEqual(complete("list", "--study-keys", "coll"), ["collection"])
        self.assertEqual(complete("generate", "fl"), ["flange"])
        self.assertEqual(complete("smooth", "--untan"), ["--untangle"])
        self.assertEqual(complete("plot", "results/gear", "--wid"), ["--width"])
        self.assertEqual(complete("plot", "results/gear", "--format", "s"), ["svg"])

    def test_headers_are_complete(self):
        include = self.prefix / "include" / "smoothfem"
        headers = list(include.rglob("*.h"))
        self.assertGreater(len(headers), 50)
        for header in headers:
            for name in re.findall(r'#include "(.*)"', header.read_text(encoding="utf-8")):
                self.assertTrue((include / name).is_file(), f"{header} includes {name}")

    def test_program_of_somebody_else(self):
        build = self.folder / "build"
        run("cmake", "-S", PROGRAM, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=Debug")
        run("cmake", "--build", build)
        self.smoothfem_run("generate", "gear", "-o", "gear.msh", "--edge-scale", "4", "--distort-to", "0.45")
        told = run(build / "quarter_laplace", "gear.msh", "getme", "mine.mesh", folder=self.folder).stdout
        before, after = map(float, re.search(r"error (\S+) -> (\S+)", told).groups())
        self.assertLess(after, before)
        self.smoothfem_run("smooth", "gear.msh", "-m", "getme", "-o", "theirs.mesh")
        self.assertEqual((self.folder / "mine.mesh").read_bytes(), (self.folder / "theirs.mesh").read_bytes())

    @classmethod
    def plugin(cls):
        """The folder of a smoother in C++ that new-smoother has made, built once against the installation alone."""
        if not hasattr(cls, "built"):
            cls.built = make(cls.folder, "ab-cd", smoothfem=cls.smoothfem)
            run("cmake", "-S", ".", "-B", "build", "-DCMAKE_BUILD_TYPE=Debug", folder=cls.built)
            run("cmake", "--build", "build", folder=cls.built)
        return cls.built

    def test_plugin_of_somebody_else(self):
        folder = self.plugin()
        cache = (folder / "build" / "CMakeCache.txt").read_text(encoding="utf-8")
        for other in (SOURCE, BUILD):
            self.assertNotIn(f"{other}/", cache)
        self.assertIn("100% tests passed", run("ctest", "--test-dir", "build", folder=folder).stdout)
        self.assertIn("\n  ab-cd: AbCd\n", run(self.smoothfem, "list", "--plugin", "./libab_cd.so", folder=folder).stdout)
        self.study(folder, "ab-cd")
        provenance = (folder / "results" / "ab-cd" / "provenance.json").read_text()
        self.assertRegex(provenance, r'"name": "libab_cd.so",\s+"sha256": "[0-9a-f]{64}"')
        self.assertNotIn(str(folder), provenance)

    def test_refuses_other_files_as_plugins(self):
        self.assertIn("there is no plugin none.so", self.refused("list", "--plugin", "none.so"))
        (self.folder / "text.so").write_text("text")
        self.assertIn("is not a shared library", self.refused("list", "--plugin", "text.so"))
        other = next(self.prefix.rglob("libsmoothfem_python_host.so*"))
        self.assertIn("is not a plugin of smoothfem", self.refused("list", "--plugin", other))
        library = self.plugin() / "libab_cd.so"
        good = library.read_bytes()
        at = good.index(ABI_MARK) + len(ABI_MARK)
        (self.folder / "old.so").write_bytes(re.sub(re.escape(good[at - len(ABI_MARK):at + 4]),
                                                    ABI_MARK + b"\xff\0\0\0", good))
        self.assertIn("was built against another smoothfem", self.refused("list", "--plugin", "old.so"))
        (self.folder / "half.so").write_bytes(good[:len(good) * 3 // 4])
        self.assertIn("is incomplete", self.refused("list", "--plugin", "half.so"))
        copy = self.folder / "copy.so"
        copy.write_bytes(good)
        self.assertIn("'ab-cd'", self.refused("list", "--plugin", library, "--plugin", copy))

    def test_reports_a_missing_python(self):
        # No interpreter starts with this home.
        outcome = subprocess.run([self.prefix / "libexec" / "smoothfem" / "find_python"], text=True,
                                 capture_output=True, check=False, stdin=subprocess.DEVNULL,
                                 env={"PATH": os.environ["PATH"], "PYTHONHOME": "/nonexistent"})
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("python3-matplotlib", outcome.stderr)
        self.assertEqual(len(outcome.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
