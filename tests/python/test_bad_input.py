"""Every wrong argument raises an exception that names it and says what would be right."""

import math
import pathlib
import subprocess
import sys
import unittest

import numpy as np

import reradiant as rr
from scenes import EXAMPLES, material_scene, sphere_scene

NM = np.arange(380, 781, 10)


def nested(depth):
    value = 1.0
    for _ in range(depth):
        value = [value]
    return value


class NAType:
    """Stands for the type of pandas.NA, which the module knows by its name."""


class BadInput(unittest.TestCase):
    def refused(self, words, call, *arguments, **options):
        with self.assertRaises(rr.InputError) as caught:
            call(*arguments, **options)
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertIsInstance(caught.exception, ValueError)
        return caught.exception

    def test_scene_of_another_kind(self):
        for scene in (None, 5, [1, 2], object(), b"scene.toml"):
            self.refused(["scene", "give a file name or a dict"], rr.render, scene)

    def test_unknown_keys_are_named_with_the_nearest(self):
        self.refused(['"widht"', '"width"'], rr.render,
                     sphere_scene(film={"widht": 4, "height": 4}))
        self.refused(["materail", "material"], rr.render, sphere_scene(materail=[]))

    def test_wrong_types_in_a_dict(self):
        self.refused(["width", "whole number"], rr.render,
                     sphere_scene(film={"width": "wide", "height": 4}))
        self.refused(["scene['film']['width']", "nan"], rr.render,
                     sphere_scene(film={"width": math.nan, "height": 4}))
        self.refused(["scene['film']['width']", "-9223372036854775808"], rr.render,
                     sphere_scene(film={"width": 2**70, "height": 4}))
        self.refused(["scene", "keys are str"], rr.render, {1: 2})
        self.refused(["scene['x']", "set"], rr.render, sphere_scene(x={1, 2}))
        self.refused(["nested more than"], rr.render, sphere_scene(film=nested(100000)))

    def test_arrays_in_a_dict(self):
        substrate = {"type": "lambert", "reflectance": {"nm": NM, "value": np.ones(3)}}
        self.refused(["value has 3 numbers and nm 41"], rr.render,
                     material_scene({"substrate": substrate}))
        substrate = {"type": "lambert",
                     "reflectance": {"nm": NM, "value": np.full(41, np.inf)}}
        self.refused(["['value']", "inf at [0]"], rr.render,
                     material_scene({"substrate": substrate}))
        substrate = {"type": "lambert", "reflectance": {"nm": NM, "value": np.ones((41, 1))}}
        self.refused(["['value']", "(41, 1)"], rr.render, material_scene({"substrate": substrate}))
        substrate = {"type": "lambert", "reflectance": {"nm": NM, "value": np.full(41, "a")}}
        self.refused(["['value']", "dtype"], rr.render, material_scene({"substrate": substrate}))

    def test_places_in_files(self):
        folder = self.enterContext(_folder())
        file = folder / "scene.toml"
        file.write_text("[film]\nwidth = 4\nheight = 4\nbands = 3\n")
        error = self.refused(["scene.toml:4:1", "bands"], rr.render, file)
        self.assertEqual((error.file, error.line, error.column), (str(file), 4, 1))
        error = self.refused(["no such file"], rr.render, folder / "none.toml")
        self.assertEqual((error.line, error.column), (None, None))

    def test_options_of_render(self):
        scene = sphere_scene()
        for option, value, words in [
                ("spp", 0, ["spp", "from 1"]), ("spp", 1.5, ["spp", "whole"]),
                ("spp", True, ["spp", "whole"]), ("seed", -1, ["seed", "from 0"]),
                ("seed", 2**32, ["seed"]), ("time", -1, ["time", "above 0"]),
                ("time", math.nan, ["time"]), ("error", "x", ["error", "number"]),
                ("model", "fast", ["model", "adding"]), ("model", 3, ["model", "str"]),
                ("wavelengths", "rainbow", ["rainbow", "comb"]),
                ("comb_phase", "left", ["comb_phase", "centre"]),
                ("bands", (300, 780), ["bands", "(from, to, step)"]),
                ("bands", (300, 785, 10), ["bands", "whole number of steps"]),
                ("bands", (300, math.inf, 10), ["bands", "inf"]),
                ("threads", -2, ["threads"]), ("device", "no such device", ["no such device"]),
                ("device", 1, ["device", "str"]), ("band_variance", 1, ["band_variance", "True"]),
                ("sample_range", (4, 4), ["sample_range[1]"]), ("folder", "/none", ["folder"])]:
            with self.subTest(option=option, value=value):
                with self.assertRaises(rr.Error) as caught:
                    rr.render(scene, **{"spp": 1, option: value})
                for word in words:
                    self.assertIn(word, str(caught.exception))

    def test_options_of_measure(self):
        grey = {"substrate": {"type": "lambert"}}
        for option, value, words in [
                ("theta_i", 90, ["theta_i", "below 90"]), ("theta_o", [-1], ["theta_o"]),
                ("theta_o", [], ["theta_o", "empty"]), ("phi", [[1]], ["phi", "(1, 1)"]),
                ("phi", [math.nan], ["phi", "nan"]), ("samples", -1, ["samples"]),
                ("hemispherical", "no", ["hemispherical"])]:
            with self.subTest(option=option):
                self.refused(words, rr.measure, grey, **{option: value})
        self.refused(["material", "is not given"], rr.measure)
        self.refused(["preset", "red-lacquer"], rr.measure, preset="red-laquer")

    def test_spectra(self):
        self.refused(["nm", "does not ascend"], rr.Spectrum, [500, 400], [0, 1])
        self.refused(["value", "has 1 numbers"], rr.Spectrum, [400, 500], [0])
        self.refused(["value", "nan at [1]"], rr.Spectrum, [400, 500], [0, math.nan])
        self.refused(["nm", "(1, 2)"], rr.Spectrum, [[400, 500]], [0, 1])
        self.refused(["nm", "different lengths"], rr.Spectrum, [[1], [1, 2]], [0, 1])
        self.refused(["value", "dtype"], rr.Spectrum, [400, 500], [1j, 0])
        self.refused(["D65"], rr.Spectrum.illuminant, "D66")
        self.refused(["red", "at most 1"], rr.Spectrum.rgb, 2, 0, 0)
        self.refused(["factor"], lambda: math.nan * rr.Spectrum.constant(1))

    def test_matrices(self):
        make = rr.Reradiation
        self.refused(["values", "(2, 2)", "(2, 3)"], make, np.eye(2), [400, 500], [400, 500, 600])
        self.refused(["values", "nan at [0, 1]"], make, [[0, math.nan], [0, 0]], [400, 500],
                     [400, 500])
        self.refused(["emission_nm", "equal steps"], make, np.eye(3), [400, 500, 610],
                     [400, 500, 600])
        self.refused(["values", "dtype bool"], make, np.eye(2, dtype=bool), [4, 5], [4, 5])
        self.refused(["quantity", "per-band"], make, np.eye(2), [400, 500], [400, 500],
                     quantity="per nm")
        self.refused(["fluorophores[0]"], make.from_fluorophores, [1], emission_nm=NM,
                     excitation_nm=NM)
        too_much = make(1.5 * np.eye(2), [400, 500], [400, 500])
        self.refused(["1.5"], too_much.repaired)
        self.refused(["rank"], too_much.factorise, 5)

    def test_missing_entries_of_what_is_whole(self):
        masked = np.ma.masked_array([0.1, 0.9], mask=[False, True])
        for value in (masked, [0.1, None], [0.1, np.ma.masked], (0.1, NAType())):
            with self.subTest(value=value):
                self.refused(["value", "[1]", "give every number"], rr.Spectrum, [400, 500], value)
                self.refused(["['value']", "[1]" if isinstance(value, np.ndarray) else "value"],
                             rr.render, material_scene({"substrate": {
                                 "type": "lambert",
                                 "reflectance": {"nm": [400, 500], "value": value}}}))
        self.refused(["nm", "masked at [1]"], rr.Spectrum, np.ma.masked_equal([400, 500], 500),
                     [0, 1])
        self.refused(["nm", "masked"], rr.Spectrum.constant(1).at, np.ma.masked)
        self.refused(["nm", "masked at [1]"], rr.Spectrum.constant(1), masked)
        self.refused(["values", "masked at [0, 0]"], rr.Reradiation,
                     [np.ma.masked_array([1.0, 0], [True, False]), [0, 1]], [400, 500], [400, 500])
        self.refused(["emission_nm", "masked"], rr.Reradiation, np.eye(2) / 2,
                     np.ma.masked_equal([400, 500], 500), [400, 500], measured=True)
        self.refused(["values", "masked"], rr.Image,
                     np.ma.masked_array(np.ones((1, 1, 2), np.float32), [[[0, 1]]]), [400, 500])
        glass = rr.Stack([{"ior": 1.5}])
        self.refused(["theta_deg", "masked"], glass.transmission, masked, 500)
        self.refused(["theta_i", "masked"], rr.measure, {"substrate": {"type": "lambert"}},
                     theta_i=masked)
        # Nothing is missing behind an empty mask.
        self.assertEqual(rr.Spectrum([400, 500], np.ma.masked_array([0.1, 0.9]))(500), 0.9)

    def test_missing_entries_of_measured_data(self):
        values = np.tril(np.full((3, 3), 0.1)) + 0.2 * np.eye(3)
        nm = [400, 500, 600]
        gap = np.zeros((3, 3), bool)
        gap[1, 0] = True
        with_nan = np.where(gap, math.nan, values)
        as_objects = values.astype(object)
        as_objects[1, 0] = None
        for given in (np.ma.masked_array(values, gap), with_nan, as_objects, as_objects.tolist(),
                      [list(row) for row in np.ma.masked_array(values, gap)],
                      np.where(gap, NAType(), values.astype(object))):
            with self.subTest(given=given):
                self.refused(["values", "[1, 0]"], rr.Reradiation, given, nm, nm)
                data = rr.Reradiation(given, nm, nm, measured=True)
                np.testing.assert_array_equal(data.values, with_nan)
                for call in (data.energy, data.photons, data.reflectance, data.fluorescent_part,
                             data.repaired, data.factorise, lambda: rr.colour(data),
                             lambda: rr.Stack([{"ior": 1.5}]).over(data),
                             lambda: rr.render(material_scene(
                                 {"substrate": {"type": "lambert", "reradiation": data}}))):
                    self.refused(["values", "missing at [1, 0]"], call)
                self.assertIn("Reradiation(", repr(data))
                self.assertIsNone(data._repr_html_())
        folder = self.enterContext(_folder())
        self.refused(["missing"], data.write, folder / "data.exr")
        data.write(folder / "data.csv")
        back = rr.BispectralData.read(folder / "data.csv")
        np.testing.assert_array_equal(back.matrix().values, with_nan)
        self.refused(["data.csv:7:5", "missing"], rr.Reradiation.read, folder / "data.csv")
        self.refused(["no entry was measured"], rr.fit,
                     rr.Reradiation(np.full((3, 3), math.nan), nm, nm, measured=True))
        self.refused(["values", "inf"], rr.Reradiation, np.full((3, 3), math.inf), nm, nm,
                     measured=True)

    def test_types_that_are_no_real_numbers(self):
        for value, words in [([1j, 0], "complex128"), ([True, False], "bool"), (["1", "2"], "<U1"),
                             ([2**70, 1], "object"), ([[1], [1, 2]], "lengths"),
                             (np.array(["2020", "2021"], "datetime64[Y]"), "datetime64"),
                             (np.zeros(2, [("a", float)]), "dtype"),
                             (np.ma.masked_array([1j, 0]), "complex128"),
                             (["1", None], "[1]")]:
            with self.subTest(value=value):
                self.refused(["value", words], rr.Spectrum, [400, 500], value)
        self.refused(["value", "inf"], rr.Spectrum, [400, 500],
                     np.array([1, np.finfo(np.longdouble).max], np.longdouble))

    def test_other_units(self):
        self.refused(["0.4 to 0.7", "micrometres"], rr.Spectrum, [0.4, 0.7], [0, 1])
        self.refused(["4000 to 7000", "nm"], rr.Spectrum, [4000, 7000], [0, 1])
        self.refused(["percent"], rr.Reradiation, 50 * np.eye(2), [400, 500], [400, 500])
        self.refused(["percent"], rr.Reradiation, 4 * np.eye(2), [400, 500], [400, 500])
        self.refused(["nm"], rr.Reradiation, np.eye(2), [0.4, 0.5], [0.4, 0.5])
        folder = self.enterContext(_folder())
        head = "# reradiation\n# quantity: per-band\n# orientation: rows-emission\n"
        (folder / "p.csv").write_text(head + "nm,400,410\n400,50,0\n410,3,60\n")
        for read in (rr.Reradiation.read, rr.colour, rr.fit):
            self.refused(["p.csv:5:5", "percent"], read, folder / "p.csv")
        (folder / "s.csv").write_bytes(b"PK\x03\x04")
        self.refused(["s.csv", "Zip"], rr.Spectrum.read, folder / "s.csv")

    def test_images(self):
        self.refused(["values", "dtype int64"], rr.Image, np.ones((2, 2, 2), int), [400, 500])
        self.refused(["values", "shape (2, 2)"], rr.Image, np.ones((2, 2), np.float32), [400])
        self.refused(["nm", "2 wavelengths", "3 bands"], rr.Image,
                     np.ones((1, 1, 3), np.float32), [400, 500])
        self.refused(["values", "[0, 0, 1]"], rr.Image,
                     np.array([[[1, math.nan]]], np.float32), [400, 500])
        image = rr.Image(np.ones((2, 2, 2), np.float32), [400, 500])
        other = rr.Image(np.ones((2, 2, 3), np.float32), [400, 500, 600])
        self.refused([], image.compare, other)
        self.refused(["reference", "Image"], image.compare, np.ones(3))
        self.refused(["display", "NoDisplay"], image.write_png, "x.png", display="NoDisplay")

    def test_fits(self):
        self.refused(["data", "file name"], rr.fit, 3)
        flat = rr.Reradiation(np.eye(41) * 0.5, NM, NM)
        for option, value, words in [
                ("model", "magic", ["model", "gaussians"]), ("rank", 0, ["rank"]),
                ("rank", 7, ["rank"]), ("loss", "l1", ["loss", "huber"]),
                ("stack", 1.5, ["stack", "Stack"]), ("unknown", "colour", ["unknown", "ior"]),
                ("most_seconds", 0, ["most_seconds"])]:
            with self.subTest(option=option):
                self.refused(words, rr.fit, flat, **{option: value})

    def test_recipes(self):
        self.refused(["fluorophore"], rr.synth, {})
        self.refused(["unknown key"], rr.synth, {"fluorophores": []})
        self.refused(["seed"], rr.synth, EXAMPLES / "synth-orange.toml", seed=-1)

    def test_dyes_in_layers_and_sheets(self):
        dye = {"absorption": 1, "emission": rr.Spectrum.gaussian(600, 20)}
        layer = {"ior": 1.5, "fluorophores": [dye]}
        white = {"type": "lambert", "reflectance": 0.9}
        self.refused(["dyes in layers"], rr.Stack, [layer])
        self.refused(["layer"], rr.measure, {"substrate": {"type": "none"}})
        self.refused(["lower face"], rr.measure,
                     {"layer": [layer], "substrate": white, "back": {"alpha": 0.1}})
        self.refused(["between the slabs"], rr.measure, {"layer": [layer], "substrate": white},
                     model="weidlich-wilkie")
        dye["concentration"] = -1
        self.refused(["concentration is -1"], rr.measure, {"layer": [layer], "substrate": white})

    def test_stacks(self):
        self.refused(["ior"], rr.Stack, [{"thickness": 1}])
        self.refused(["at least one"], rr.Stack, [])
        self.refused(["layers"], rr.Stack, 5)
        glass = rr.Stack([{"ior": 1.5}])
        self.refused(["theta_deg"], glass.transmission, 90, 500)
        self.refused(["nm"], glass.transmission, 0, -500)
        self.refused(["matrix"], glass.over, np.eye(3))

    def test_colours(self):
        flat = rr.Reradiation(np.eye(41) * 0.5, NM, NM)
        self.refused(["D65"], rr.colour, flat, "D66")
        self.refused(["lamps", "int", "str"], rr.colour, flat, [1])
        self.refused(["sample", "int"], rr.colour, 1)
        self.refused(["sample", "preset"], rr.colour)
        self.refused(["sample", "preset"], rr.colour, flat, preset="red-lacquer")
        self.refused(["sample", "ndarray", "Reradiation"], rr.colour, np.eye(41))
        table = np.column_stack([NM, np.ones(41)])
        for words, options in (
                (["observer", "1964-10"], {"observer": "10"}), (["observer"], {"observer": []}),
                (["geometry", "matrix"], {"geometry": "8/d"}), (["uv_cut"], {"uv_cut": 1000}),
                (["uv_cut"], {"uv_cut": "420"}), (["e308"], {"e308": 1}),
                (["lamps", "once"], {"lamps": ["D65", "D65"]}), (["lamps", "once"], {"lamps": {}}),
                (["lamps", "shape (3, 3)"], {"lamps": np.eye(3)}),
                (["lamps", "ascend"], {"lamps": table[::-1]}),
                (["lamps", "negative"], {"lamps": table * [1, -1]}),
                (["lamps['mine']", "int"], {"lamps": {"mine": 3}}),
                (["none.csv"], {"lamps": pathlib.Path("none.csv")}),
                (["none.csv"], {"polygons": "none.csv"}), (["none.csv"], {"against": "none.csv"}),
                (["none.csv"], {"covariance": "none.csv"}),
                (["covariance", "(41,)"], {"covariance": np.ones(41)}),
                (["independent", "(3, 3)"], {"covariance": np.ones((3, 3))}),
                (["independent", "negative"], {"covariance": -np.eye(41)}),
                (["preset"], {"sample": None, "preset": "none"})):
            with self.subTest(options=options):
                self.refused(words, rr.colour, **{"sample": flat, **options})
        self.refused(["95/0"], rr.colour, preset="red-lacquer", geometry="95/0")
        measured = rr.measure({"substrate": {"type": "lambert"}}, theta_i=45, bands=(400, 700, 10))
        self.refused(["sample: ", "8/d"], rr.colour, measured, geometry="8/d")

    def test_covariances(self):
        self.refused(["independent", "(2, 2)"], rr.Covariance, NM, NM, independent=np.eye(2))
        self.refused(["directions", "dimension"], rr.Covariance, NM, NM, directions=np.eye(41))
        self.refused(["emission_nm", "ascend"], rr.Covariance, [400, 410, 430], NM)
        self.refused(["independent", "negative", "[0, 0]"], rr.Covariance, NM, NM,
                     independent=-np.eye(41))
        small = rr.Covariance(NM[:40], NM[:40], independent=np.eye(40))
        self.refused(["bands"], rr.colour, rr.Reradiation(np.eye(41) * 0.5, NM, NM), covariance=small)

    def test_plots(self):
        self.refused(["curves", "dict"], rr.Plot, [[1, 2]])
        self.refused(["curves['a']", "pair"], rr.Plot, {"a": [1, 2, 3]})
        self.refused(["curves['a']", "2 x and 1 y"], rr.Plot, {"a": ([1, 2], [3])})

    def test_files_that_cannot_be_written(self):
        image = rr.Image(np.ones((2, 2, 2), np.float32), [400, 500])
        for name in ("/none/image.exr", pathlib.Path("/none/image.exr")):
            with self.assertRaises(rr.Error):
                image.write(name)
        flat = rr.Reradiation(np.eye(41) * 0.5, NM, NM)
        for write in (image.write, image.write_png, flat.write):
            self.refused(["nowhere/out.exr", "the folder nowhere does not exist"], write,
                         "nowhere/out.exr")
            self.refused(["/tmp", "is a folder"], write, "/tmp")
        for words, write, name in (
                (["x.png", "Image.write writes .exr", "Image.write_png makes a PNG"], image.write, "x.png"),
                (["x.exr", "Image.write_png writes .png"], image.write_png, "x.exr"),
                (["x.png", ".csv"], flat.write, "x.png"),
                (["x.exr", "Measurement.write writes .csv"],
                 rr.measure({"substrate": {"type": "lambert"}}, bands=(500, 520, 10)).write, "x.exr")):
            self.refused(words, write, name)
            self.assertFalse(pathlib.Path(name).exists())
        self.refused(["file", "empty"], image.write, "")
        self.refused(["file", "zero character"], image.write, "a\0b.exr")

    def test_the_interpreter_outlives_hostile_calls(self):
        """Objects whose own methods raise, and views that outlive what they look at."""
        program = """
import gc, numpy as np, reradiant as rr
class Hostile(dict):
    def items(self): raise RuntimeError("no")
try: rr.render(Hostile(film=1))
except RuntimeError: pass
values = rr.Image(np.ones((64, 64, 8), np.float32), np.arange(400, 480, 10)).values
matrix = rr.Reradiation(np.eye(3), [400, 500, 600], [400, 500, 600]).values
gc.collect()
assert values.sum() == 64 * 64 * 8 and matrix.trace() == 3
try: rr._library.Spectrum()
except TypeError: pass
print("alive")
"""
        done = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout.strip()), (0, "alive"), done.stderr)


def _folder():
    import contextlib
    import tempfile

    @contextlib.contextmanager
    def folder():
        with tempfile.TemporaryDirectory() as name:
            yield pathlib.Path(name)

    return folder()


if __name__ == "__main__":
    unittest.main()
