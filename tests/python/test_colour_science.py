"""Tests of what reaches the package colour-science. It and OpenImageIO need not be there: the tests
have stand-ins for them."""

import sys
import types
import unittest
from unittest import mock

import numpy as np

import reradiant as rr


class ChannelLimit(unittest.TestCase):
    def setUp(self):
        self.limits = {"limits:channels": 1024}
        self.limit_when_called = []
        images = types.ModuleType("OpenImageIO")
        images.get_int_attribute = lambda name, default: self.limits.get(name, default)
        images.attribute = self.limits.__setitem__
        colour = types.ModuleType("colour")
        colour.read_spectral_image_Fichet2021 = self.called
        colour.write_spectral_image_Fichet2021 = self.called
        self.enterContext(mock.patch.dict(sys.modules, {"OpenImageIO": images, "colour": colour}))

    def called(self, *arguments, **options):
        self.limit_when_called.append(self.limits["limits:channels"])
        return arguments, options

    def test_is_raised_before_a_file_is_read_or_written(self):
        read = rr.colour_science.read_spectral_image("m.exr", additional_data=True)
        self.assertEqual(read, (("m.exr",), {"additional_data": True}))
        self.limits["limits:channels"] = 1024
        self.assertEqual(rr.colour_science.write_spectral_image({}, "m.exr"), (({}, "m.exr"), {}))
        for limit in self.limit_when_called:
            self.assertGreaterEqual(limit, 5778)

    def test_is_never_lowered(self):
        self.limits["limits:channels"] = 1 << 30
        rr.colour_science.read_spectral_image("m.exr")
        self.assertEqual(self.limit_when_called, [1 << 30])

    def test_missing_image_library_is_said(self):
        with mock.patch.dict(sys.modules, {"OpenImageIO": None}):
            with self.assertRaisesRegex(rr.RunError, "OpenImageIO"):
                rr.colour_science.read_spectral_image("m.exr")
        self.assertEqual(self.limit_when_called, [])


class Signals:
    """As much of a distribution of colour-science as is looked at."""

    def __init__(self, values, wavelengths, labels=None, name=""):
        self.values, self.wavelengths, self.labels, self.name = values, wavelengths, labels, name


class Objects(unittest.TestCase):
    def setUp(self):
        colour = types.ModuleType("colour")
        for kind in ("SpectralDistribution", "MultiSpectralDistributions"):
            setattr(colour, kind, type(kind, (Signals,), {"__module__": "colour.colorimetry"}))
        self.enterContext(mock.patch.dict(sys.modules, {"colour": colour}))
        self.colour = colour

    def test_are_lamps_and_samples_of_colour(self):
        nm = np.arange(380, 781, 10.0)
        grey = rr.Reradiation(0.2 * np.eye(41), nm, nm)
        lamp = self.colour.SpectralDistribution(np.ones(41), nm, name="even")
        seen = rr.colour(rr.colour_science.to_distributions(grey), lamp)
        self.assertEqual(list(seen), ["even"])
        self.assertAlmostEqual(seen["even"]["XYZ"][1], 20.0)
        self.assertEqual(list(rr.colour(grey, {"mine": lamp})), ["mine"])

    def test_radiance_factors_become_signals(self):
        nm = np.arange(380, 781, 10.0)
        seen = rr.colour(rr.Reradiation(0.2 * np.eye(41), nm, nm))["D65"]
        signals = rr.colour_science.radiance_factors(seen)
        self.assertEqual(signals.labels, ["beta_T", "beta_R", "beta_L"])
        np.testing.assert_allclose(signals.values, np.tile([0.2, 0.2, 0.0], (41, 1)))
        np.testing.assert_array_equal(signals.wavelengths, nm)
        with self.assertRaisesRegex(rr.InputError, "colour_of_lamp"):
            rr.colour_science.radiance_factors({})


if __name__ == "__main__":
    unittest.main()
