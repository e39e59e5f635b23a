# SPDX-License-Identifier: GPL-3.0-or-later
"""Every method gives the same bits whatever vector registers the library is compiled for: the
program with its own library, and with one for processors without AVX."""

import tempfile
import unittest
from pathlib import Path

from .build_folder import BUILD, SMOOTHFEM, method_names, run

OTHER = BUILD / "lib" / "registers"
MESHES = {  # one of each kind of mesh and element
    "triangles": ("gear", "--elements", "triangles", "--edge-scale", "3", "--distort-to", "0.4"),
    "quadrilaterals": ("gear", "--elements", "quadrilaterals", "--edge-scale", "3", "--distort-to", "0.45"),
    "surface": ("roof", "--distort-to", "0.6"),
    "tetrahedra": ("sphere", "--distort-to", "0.5"),
    "hexahedra": ("nonuniform-grid",),
    "mixed": ("ring", "--distort-to", "0.6"),
}


class Registers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.folder = Path(cls.temporary.name)
        own, other = (run(SMOOTHFEM, "--version", LD_LIBRARY_PATH=path).stdout for path in (None, OTHER))
        if "SSE2" not in other:
            raise AssertionError(f"the library in {OTHER} is not the one used: {other}")
        if own == other:
            raise unittest.SkipTest("this machine has no wider registers than SSE2: nothing to compare")
        for name, words in MESHES.items():
            for path in (None, OTHER):
                run(SMOOTHFEM, "generate", *words, "-o", cls.folder / cls.file(name, path), LD_LIBRARY_PATH=path)

    @staticmethod
    def file(name, library):
        """The name of a mesh made with a library."""
        return f"{name}_{'other' if library else 'own'}.vtk"

    def same(self, name):
        """Asserts that both programs wrote the same file."""
        own, other = ((self.folder / self.file(name, path)).read_bytes() for path in (None, OTHER))
        self.assertTrue(own == other, f"{name} differs")

    def test_generation_and_distortion(self):
        for name in MESHES:
            self.same(name)

    def test_methods(self):
        n_compared = 0
        for method in method_names():
            for name in MESHES:
                outcomes = [run(SMOOTHFEM, "smooth", self.folder / self.file(name, None), "-m", method, "-o",
                                self.folder / self.file(f"{name}_{method}", path), LD_LIBRARY_PATH=path, check=False)
                            for path in (None, OTHER)]
                self.assertEqual(outcomes[0].returncode, outcomes[1].returncode)
                if outcomes[0].returncode != 0:  # not for meshes of this kind, or not without a problem to solve
                    self.assertRegex(outcomes[0].stderr, "does not support|works only in a study with a solution")
                    continue
                with self.subTest(method=method, mesh=name):
                    self.same(f"{name}_{method}")
                n_compared += 1
        self.assertGreaterEqual(n_compared, 40)


if __name__ == "__main__":
    unittest.main()
