"""Files of `view` taken by those whom they are for: the MaterialX library, Mitsuba 3, Blender's compiler of OSL.

Each is a package that may be missing; its tests then skip, and say so."""

import glob
import importlib
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["RERADIANT_BUILD"]) / "bin/reradiant"
PRESETS = ["red-lacquer", "car-paint", "house-paint", "multi-layer", "neon-orange-varnished", "fluorescent-orange-bare"]


def package(name):
    """The package, or a skip that names it."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise unittest.SkipTest(f"the Python package {name} is not here: its files are not tested by it") from None


class OtherRenderers(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def written(self, option, ending):
        for preset in PRESETS:
            file = pathlib.Path(self.folder.name) / f"{preset}{ending}"
            subprocess.run([PROGRAM, "view", "--preset", preset, option, file, "--quiet"], check=True)
            yield str(file)

    def test_materialx_is_valid(self):
        materialx = package("MaterialX")
        library = materialx.createDocument()
        materialx.loadLibraries(materialx.getDefaultDataLibraryFolders(), materialx.getDefaultDataSearchPath(), library)
        for file in self.written("--materialx", ".mtlx"):
            document = materialx.createDocument()
            materialx.readFromXmlFile(document, file)
            document.importLibrary(library)
            valid, message = document.validate()
            self.assertTrue(valid, f"{file}: {message}")
            for node in document.getNodes("open_pbr_surface"):
                definition = node.getNodeDef()
                self.assertIsNotNone(definition)
                unknown = [i.getName() for i in node.getInputs() if not definition.getActiveInput(i.getName())]
                self.assertEqual(unknown, [], file)

    def test_mitsuba_loads_it(self):
        mitsuba = package("mitsuba")
        mitsuba.set_variant("scalar_rgb")
        for file in self.written("--mitsuba", ".xml"):
            self.assertIsNotNone(mitsuba.load_file(file))

    def test_osl_compiles(self):
        bpy = package("bpy")
        sys.path += glob.glob(str(pathlib.Path(bpy.__file__).parent / "*/python/lib/*/site-packages"))
        bpy.context.scene.render.engine = "CYCLES"
        import _cycles
        for file in self.written("--osl", ".osl"):
            self.assertTrue(_cycles.osl_compile(file, file[:-1] + "o"), file)


if __name__ == "__main__":
    unittest.main()
