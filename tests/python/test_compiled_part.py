"""A package whose compiled part is missing or does not fit says so, and which command makes it."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import reradiant
from reradiant._compiled_part import require_numpy_of

PACKAGE = pathlib.Path(reradiant.__file__).parent
COMPILED = pathlib.Path(reradiant._library.__file__).name


class CompiledPart(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.package = self.folder / "reradiant"
        shutil.copytree(PACKAGE, self.package, ignore=shutil.ignore_patterns("_library.*", "__pycache__"))

    def refused(self, words):
        """Checks that `import reradiant` of the copy raises an ImportError with these words."""
        result = subprocess.run([sys.executable, "-B", "-c", "import reradiant"], cwd=self.folder,
                                env={**os.environ, "PYTHONPATH": str(self.folder)},
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 1, result.stderr)
        said = result.stderr.strip().splitlines()[-1]
        for word in ("ImportError", *words):
            self.assertIn(word, said)
        self.assertNotIn("circular", result.stderr)

    def test_not_built(self):
        self.refused(["is not in", str(self.package), "tools/build release python",
                      "pip install ./tools/python"])

    def test_built_for_another_python(self):
        (self.package / "_library.cpython-35m-x86_64-linux-gnu.so").write_bytes(b"")
        version = ".".join(map(str, sys.version_info[:2]))
        self.refused(["_library.cpython-35m-x86_64-linux-gnu.so", f"Python {version}", sys.executable,
                      "tools/build release python"])

    def test_does_not_load(self):
        (self.package / COMPILED).write_bytes(b"no library")
        self.refused(["does not load", COMPILED, "tools/setup", "tools/build release python"])

    def test_without_numpy(self):
        (self.folder / "numpy.py").write_text("raise ImportError('not in this interpreter')")
        self.refused(["needs numpy", sys.executable, "pip install numpy"])

    def test_numpy_of_another_interface(self):
        # Without the check the interpreter dies: seen with pybind11 2.10 and numpy 2.4.
        require_numpy_of((2, 10), "1.24.2")
        require_numpy_of((2, 12), "2.0.0")
        require_numpy_of((3, 0), "2.4.6")
        with self.assertRaises(ImportError) as caught:
            require_numpy_of((2, 11), "2.4.6")
        for word in ("2.11", "2.4.6", "pip install"):
            self.assertIn(word, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
