"""Tests of what reaches the package colour-science. It and OpenImageIO need not be there: the tests
have stand-ins for them."""

import sys
import types
import unittest
from unittest import mock

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


if __name__ == "__main__":
    unittest.main()
