"""The functions give what the program gives."""

import csv
import json
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import reradiant as rr
from scenes import EXAMPLES, PROGRAM, SPECTRA, material_scene, sphere_scene


class AgainstTheProgram(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))

    def program(self, *arguments):
        subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], check=True, cwd=self.folder,
                       stdout=subprocess.DEVNULL)

    def test_render(self):
        scene = EXAMPLES / "fluorescent-smooth.toml"
        self.program("render", scene, "-o", "a.exr", "--spp", 2, "--seed", 7, "--json", "a.json",
                     "--bands", "300:780:40", "--variance", "bands")
        image = rr.render(scene, spp=2, seed=7, bands=(300, 780, 40), band_variance=True)
        file = rr.Image.read(self.folder / "a.exr")
        np.testing.assert_array_equal(image.values, file.values)
        np.testing.assert_array_equal(image.variance, file.variance)
        np.testing.assert_array_equal(image.nm, np.arange(300, 781, 40))
        told = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(told.keys(), image.statistics.keys())
        self.assertEqual(told["left_out"], image.statistics["left_out"])
        image.write(self.folder / "b.exr")
        again = rr.Image.read(self.folder / "b.exr")
        np.testing.assert_array_equal(again.values, file.values)
        self.assertEqual(again.attributes["reradiant:sceneHash"],
                         file.attributes["reradiant:sceneHash"])
        self.assertEqual(image.compare(file)["relmse"], 0.0)

    def test_display_image(self):
        image = rr.render(sphere_scene(), spp=1, bands=(400, 700, 100))
        png = image._repr_png_()
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        image.write_png(self.folder / "a.png")
        self.assertEqual(png, (self.folder / "a.png").read_bytes())
        self.assertEqual(image.srgb().shape, (12, 16, 3))

    def test_measure(self):
        self.program("measure", "--preset", "fluorescent-orange-smooth", "-o", "m.csv",
                     "--theta-i", "0,45", "--theta-o", "20", "--phi", "180", "--bands",
                     "300:780:40")
        found = rr.measure(preset="fluorescent-orange-smooth", theta_i=[0, 45], theta_o=20, phi=180,
                           bands=(300, 780, 40))
        with open(self.folder / "m.csv", newline="") as stream:
            rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
        self.assertEqual(len(rows), len(found))
        np.testing.assert_allclose([float(row["value"]) for row in rows], found.value, rtol=1e-11)
        np.testing.assert_array_equal([row["part"] == "specular" for row in rows], found.specular)
        matrix = found.matrix(45, 20, 180)
        self.assertEqual(matrix.shape, (13, 13))
        self.assertTrue((np.triu(matrix, 1) == 0).all() and (np.tril(matrix, -1) > 0).any())
        with self.assertRaises(rr.InputError):
            found.matrix(46, 20, 180)

    def test_synth_fit_and_colour(self):
        recipe = EXAMPLES / "synth-orange.toml"
        self.program("synth", recipe, "-o", "d.csv", "--truth", "t.csv", "--seed", 3)
        made = rr.synth(recipe, seed=3)
        np.testing.assert_allclose(made.truth.values,
                                   rr.Reradiation.read(self.folder / "t.csv").values, rtol=1e-15)
        made.data.write(self.folder / "d2.csv")
        self.assertEqual((self.folder / "d.csv").read_bytes(), (self.folder / "d2.csv").read_bytes())
        self.program("fit", "d.csv", "-o", "f.csv", "--rank", 1, "--json", "f.json")
        fitted = rr.fit(self.folder / "d.csv", rank=1)
        np.testing.assert_allclose(fitted.matrix.values,
                                   rr.Reradiation.read(self.folder / "f.csv").values, rtol=1e-12)
        self.assertFalse(fitted.masked.any())
        told = json.loads((self.folder / "f.json").read_text())
        self.assertEqual(told["quantum_yield"], fitted.summary["quantum_yield"])
        self.assertEqual(fitted.emission.shape, (41, 1))
        self.program("colour", "f.csv", "--illuminant", "D65,A", "--json", "c.json")
        self.assertEqual(json.loads((self.folder / "c.json").read_text()),
                         rr.colour(fitted.matrix, ["D65", "A"]))
        for one, other in ((rr.colour(fitted.matrix, illuminant="A"), rr.colour(fitted.matrix, "A")),
                           (rr.colour(fitted.matrix, {"D65": rr.Spectrum.illuminant("D65")}),
                            rr.colour(fitted.matrix))):
            self.assertEqual(one, other)
        html = fitted._repr_html_()
        self.assertTrue(html.startswith("<svg") and html.rstrip().endswith("</svg>"))


    def test_colours_of_every_kind_of_sample(self):
        """Names of files, objects and dicts are the same samples as on the command line."""
        self.program("measure", "--preset", "neon-orange-varnished", "-o", "m.csv", "--theta-i", "45")
        for arguments, options in (
                (["m.csv"], {"sample": self.folder / "m.csv"}),
                (["m.csv"], {"sample": rr.measure(preset="neon-orange-varnished", theta_i=45)}),
                (["--preset", "neon-orange-varnished", "--geometry", "8/de"],
                 {"preset": "neon-orange-varnished", "geometry": "8/de"}),
                ([SPECTRA / "reradiation/neon-orange.csv", "--uv-cut", "400", "--against",
                  SPECTRA / "reradiation/neon-yellow.csv"],
                 {"sample": rr.Reradiation.read(SPECTRA / "reradiation/neon-orange.csv"), "uv_cut": 400,
                  "against": SPECTRA / "reradiation/neon-yellow.csv"})):
            with self.subTest(arguments=arguments):
                self.program("colour", *arguments, "--illuminant", "D65,FL11", "--observer",
                             "1931-2,1964-10", "--json", "c.json")
                told = json.loads((self.folder / "c.json").read_text())
                found = rr.colour(**options, lamps=["D65", "FL11"], observer=["1931-2", "1964-10"])
                self.assertEqual(list(told), list(found))
                for key in told:
                    for name in ("XYZ", "Lab", "beta_T"):
                        np.testing.assert_allclose(  # None, where the lamp is dark, becomes NaN
                            np.array(found[key][name], float), np.array(told[key][name], float),
                            rtol=1e-9)
                    self.assertEqual(found[key].get("delta_e"), told[key].get("delta_e"))
                    self.assertEqual(found[key].get("metamerism"), told[key].get("metamerism"))

    def test_lamps_of_every_kind(self):
        orange = rr.Reradiation.read(SPECTRA / "reradiation/neon-orange.csv")
        nm = np.arange(300, 831, 5.0)
        light = rr.Spectrum.illuminant("D65").at(nm)
        expected = rr.colour(orange)["D65"]["XYZ"]
        for lamps in ({"mine": rr.Spectrum(nm, light)}, {"mine": np.column_stack([nm, light])},
                      {"mine": "D65"}, rr.Spectrum(nm, light), np.column_stack([nm, light]),
                      SPECTRA / "illuminants/D65.csv"):
            [found] = rr.colour(orange, lamps).values()
            np.testing.assert_allclose(found["XYZ"], expected, rtol=1e-6)

    def test_intervals(self):
        self.program("synth", EXAMPLES / "synth-orange.toml", "-o", "d.csv", "--seed", 3)
        self.program("fit", "d.csv", "-o", "f.csv", "--rank", 1, "--covariance", "v.csv")
        self.program("colour", "f.csv", "--covariance", "v.csv", "--json", "c.json")
        told = json.loads((self.folder / "c.json").read_text())["D65"]["intervals"]
        fitted = rr.fit(self.folder / "d.csv", rank=1)
        errors = fitted.covariance.standard_errors
        self.assertTrue((errors >= fitted.sigma * (1 - 1e-6)).all())
        read = rr.Covariance.read(self.folder / "v.csv")
        np.testing.assert_allclose(read.standard_errors, errors, rtol=1e-4, atol=1e-12)
        directions = fitted.covariance.directions
        np.testing.assert_allclose((directions ** 2).sum(0) + fitted.covariance.independent ** 2,
                                   errors ** 2, rtol=1e-9, atol=1e-20)
        for sample, options in ((fitted, {}), (fitted.matrix, {"covariance": read}),
                                (fitted.matrix, {"covariance": fitted}),
                                (self.folder / "f.csv", {"covariance": self.folder / "v.csv"})):
            found = rr.colour(sample, **options)["D65"]["intervals"]
            self.assertEqual(list(found["linearised"]), list(told["linearised"]))
            for end in ("low", "high", "standard_error"):
                np.testing.assert_allclose(found["linearised"]["Lab"][end],
                                           told["linearised"]["Lab"][end], rtol=1e-3)
        same = rr.Covariance(read.emission_nm, read.excitation_nm, independent=read.independent,
                             directions=read.directions)
        same.write(self.folder / "w.csv")
        self.assertEqual(rr.colour(fitted.matrix, covariance=self.folder / "w.csv"),
                         rr.colour(fitted.matrix, covariance=same))
        with self.assertRaises(rr.InputError):
            rr.fit(self.folder / "d.csv", model="matrix").covariance

    def test_fit_with_a_mask(self):
        emission, excitation = np.arange(400, 800, 10), np.arange(300, 400, 10)
        values = 0.05 * np.exp(-0.5 * (((emission[:, None] - 460) / 30) ** 2
                                       + ((excitation - 340) / 40) ** 2))
        line = emission[:, None] == 2 * excitation
        values[line] += 0.05
        data = rr.Reradiation(values, emission, excitation)
        fitted = rr.fit(data, rank=1)
        np.testing.assert_array_equal(fitted.masked, line)
        self.assertEqual(fitted.summary["mask"]["rules"], "auto,second:5")
        self.assertLess(fitted.summary["relative_rmse"], 1e-3)
        self.assertGreater(rr.fit(data, rank=1, mask="none").summary["relative_rmse"], 0.1)
        boxes = rr.fit(data, rank=1, mask="second:5,box:300-320x400-420")
        self.assertEqual(boxes.masked.sum(), 19)
        with self.assertRaises(rr.InputError):
            rr.fit(data, mask="secnd:5")
        with self.assertRaises(rr.InputError):
            rr.fit(data, mask=5)


class Objects(unittest.TestCase):
    def test_matrix_in_a_scene_is_what_the_file_is(self):
        nm = np.arange(380, 781, 20)
        orange = rr.Reradiation.from_fluorophores(
            [(0.8 * rr.Spectrum.gaussian(440, 40), rr.Spectrum.gaussian(580, 25), 0.9)],
            rr.Spectrum.constant(0.05), emission_nm=nm, excitation_nm=nm)
        scene = material_scene({"substrate": {"type": "lambert", "reradiation": orange}})
        from_object = rr.render(scene, spp=1, seed=2)
        with tempfile.TemporaryDirectory() as folder:
            orange.write(pathlib.Path(folder) / "orange.csv")
            scene["material"][0]["substrate"]["reradiation"] = {"file": "orange.csv"}
            from_file = rr.render(scene, spp=1, seed=2, folder=folder)
        np.testing.assert_array_equal(from_object.values, from_file.values)

    def test_matrix_in_a_layer_is_the_shares_of_a_dye(self):
        nm = np.arange(400, 701, 50)
        shares = rr.Reradiation.from_fluorophores(
            [(rr.Spectrum.constant(1), rr.Spectrum.gaussian(580, 25), 0.9)],
            emission_nm=nm, excitation_nm=nm)
        dye = {"absorption": rr.Spectrum.gaussian(450, 30), "shares": shares}
        sheet = {"layer": [{"ior": 1.5, "fluorophores": [dye]}], "substrate": {"type": "none"}}
        np.testing.assert_array_equal(rr.measure(sheet, hemispherical=True).nm, nm)

    def test_spectrum_in_a_scene(self):
        lamp = rr.Spectrum([400, 600, 700], [1, 3, 2]) + rr.Spectrum.line(546, 1, 50)
        bands = (400, 700, 10)
        sky = rr.render(sphere_scene(light=[{"type": "environment", "radiance": lamp}], shape=[]),
                        spp=1, bands=bands)
        found = sky.values[0, 0]
        expected = [lamp.average(nm - 5, nm + 5) for nm in sky.nm]
        # One sample of a band's wavelengths: linear between, so within the change over a band.
        np.testing.assert_allclose(found, expected, atol=0.11)

    def test_values_are_views(self):
        image = rr.Image(np.zeros((2, 3, 4), np.float32), [400, 410, 420, 430])
        image.values[1, 2, 3] = 5
        self.assertEqual(image.values[1, 2, 3], 5)
        self.assertEqual(image.values.dtype, np.float32)
        self.assertTrue(np.shares_memory(image.values, image.values))
        matrix = rr.Reradiation(np.eye(2), [400, 500], [400, 500])
        self.assertTrue(np.shares_memory(matrix.values, matrix.values))
        with self.assertRaises(ValueError):
            matrix.values[0, 0] = 2

    def test_axes_may_descend_and_be_rounded(self):
        third = rr.Reradiation(np.diag([0.1, 0.2, 0.3]), [383.33, 386.67, 390], [383.33, 386.67, 390])
        self.assertAlmostEqual(third.emission_nm[0], 383 + 1 / 3, places=12)
        self.assertEqual(third.emission_nm[2], 390)
        single = np.array([383.33, 386.67, 390], np.float32)
        np.testing.assert_array_equal(
            rr.Reradiation(np.eye(3), single, single).emission_nm, third.emission_nm)
        values = np.array([[0.5, 0.0], [0.2, 0.6]])
        turned = rr.Reradiation(values[::-1, ::-1], [500, 400], [500, 400])
        np.testing.assert_array_equal(turned.values, values)
        self.assertEqual(turned.emission_nm.tolist(), [400, 500])

    def test_density_form(self):
        nm = np.arange(400, 441, 10)
        density = np.diag(np.full(5, 0.3)) + np.tril(np.full((5, 5), 0.002), -1)
        per_band = rr.Reradiation(density, nm, nm, quantity="density-per-nm").values
        np.testing.assert_allclose(per_band, np.where(np.eye(5) > 0, 0.3, 10 * density))

    def test_stack_over_a_matrix_solves_the_series(self):
        nm = np.arange(400, 601, 50)
        matrix = rr.Reradiation(0.6 * np.eye(5) + np.tril(np.full((5, 5), 0.05), -1), nm, nm)
        glass = rr.Stack([{"ior": 1.5}])
        r = np.diag(glass.internal_reflectance(nm))
        series, term = np.zeros((5, 5)), np.array(matrix.values)
        for _ in range(200):
            series, term = series + term, matrix.values @ r @ term
        np.testing.assert_allclose(glass.over(matrix), series, rtol=1e-12)

    def test_plain_tables_are_told_what_they_hold(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        file = folder / "export.csv"
        file.write_text(";400;410\n400;50,0;\n410;2,5;60,0\n")
        with self.assertRaisesRegex(rr.InputError, "--rows emission --quantity per-band"):
            rr.Reradiation.read(file)
        told = {"rows": "emission", "quantity": "per-band", "scale": "percent"}
        np.testing.assert_allclose(rr.Reradiation.read(file, **told).values,
                                   [[0.5, 0.0], [0.025, 0.6]], rtol=1e-15)
        told.update(quantity="density", scale=0.01, decimal="comma", kind="measured")
        matrix = rr.Reradiation.read(file, **told)
        self.assertTrue(matrix.measured)
        np.testing.assert_allclose(matrix.values, [[0.5, 0.0], [0.25, 0.6]], rtol=1e-15)
        np.testing.assert_array_equal(rr.BispectralData.read(file, **told).matrix().values,
                                      matrix.values)
        for wrong in ({"rows": "both"}, {"scale": 0}, {"scale": "much"}, {"decimal": ";"}):
            with self.assertRaisesRegex(rr.InputError, next(iter(wrong))):
                rr.Reradiation.read(file, **{**told, **wrong})

    def test_a_misreading_reaches_the_logger(self):
        orange = rr.Reradiation.read(EXAMPLES.parents[1] / "spectra" / "reradiation" /
                                     "synthetic-orange.csv")
        with self.assertLogs("reradiant", "WARNING") as logs:
            rr.Reradiation(orange.values.T, orange.excitation_nm, orange.emission_nm,
                           measured=True)
        self.assertIn("exchanged", logs.output[0])

    def test_warnings_reach_the_logger(self):
        scene = sphere_scene(light=[{"type": "environment",
                                     "radiance": {"nm": [450, 600], "value": [1, 1]}}])
        with self.assertLogs("reradiant", "WARNING") as logs:
            rr.render(scene, spp=1, bands=(400, 700, 100))
        self.assertIn("450", logs.output[0])


if __name__ == "__main__":
    unittest.main()
