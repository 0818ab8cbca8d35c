"""Scenes and helpers that several tests share."""

import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "tools" / "examples"
SPECTRA = ROOT / "spectra"
PROGRAM = os.environ["RERADIANT_PROGRAM"]


def sphere_scene(**changes):
    """A grey sphere under a white sky."""
    scene = {
        "film": {"width": 16, "height": 12},
        "camera": {"origin": [0, 0, 5], "target": [0, 0, 0]},
        "light": [{"type": "environment", "radiance": 1.0}],
        "shape": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "grey"}],
        "material": [{"name": "grey", "substrate": {"type": "lambert", "reflectance": 0.5}}],
    }
    scene.update(changes)
    return scene


def material_scene(material):
    """The sphere of another material."""
    return sphere_scene(material=[dict(material, name="grey")])
