"""Files of `view` taken by those whom they are for: the MaterialX library, Mitsuba 3, Blender with its OSL.

Each is a package that may be missing; its tests then skip, and say so."""

import glob
import importlib
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["RERADIANT_BUILD"]) / "bin/reradiant"
SUN = math.radians(20)
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

    def test_osl_compiles_and_renders(self):
        """A flat sample that faces sun and camera: what its closures send back is known where no lobe is seen."""
        bpy = package("bpy")
        sys.path += glob.glob(bpy.utils.resource_path("LOCAL") + "/python/lib/*/site-packages")
        for file in self.written("--osl", ".osl"):
            seen = rendered_by_blender(bpy, file, file[:-3] + "exr")
            self.assertTrue(all(value >= 0.0 for value in seen), f"{file}: {seen}")
            if "fluorescent-orange-bare" in file:
                colour = last_colour(file)
                for value, expected in zip(seen, colour):
                    self.assertAlmostEqual(value, max(expected, 0.0), delta=0.01 * max(colour), msg=file)
            if "neon-orange-varnished" in file:
                # n = 1.5: 1 - 0.04 out along the normal, 1 - 0.0918 of diffuse light in
                colour = last_colour(file)
                self.assertAlmostEqual(seen[0], 0.96 * 0.9082 * colour[0], delta=0.01 * colour[0], msg=file)


def last_colour(file):
    """The colour of the substrate, which comes last in a shader."""
    return [float(x) for x in re.findall(r"color\(([^)]*)\)", pathlib.Path(file).read_text())[-1].split(",")]


def rendered_by_blender(bpy, shader, picture):
    """Linear colour of the middle of a square plane with the shader, the sun 20 degrees beside the camera, which is
    above it; the sun's irradiance is pi along its direction."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.shading_system = True
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 8
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = picture
    bpy.ops.mesh.primitive_plane_add(size=2)
    plane = bpy.context.object
    material = bpy.data.materials.new("shader")
    material.use_nodes = True
    plane.data.materials.append(material)
    nodes = material.node_tree.nodes
    nodes.clear()
    script = nodes.new("ShaderNodeScript")
    script.mode, script.filepath = "EXTERNAL", shader
    script.update()
    material.node_tree.links.new(script.outputs["Out"], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale, camera.location = "ORTHO", 1.0, (0.0, 0.0, 3.0)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = math.pi / math.cos(SUN), 0.0
    sun.rotation_euler = (SUN, 0.0, 0.0)
    for thing in (camera, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(picture)
    image.colorspace_settings.is_data = True
    pixels = list(image.pixels)
    return pixels[4 * 36:4 * 36 + 3]


if __name__ == "__main__":
    unittest.main()
