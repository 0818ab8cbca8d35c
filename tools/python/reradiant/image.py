"""Spectral images."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Dict, Optional

import numpy as np

from . import _checks, _library


class Image:
    """A spectral image, radiance in W m^-2 sr^-1 per nm.

    Parameters
    ----------
    values : array_like of float32, (height, width, band)
        Copied once; afterwards `values` is the image's own memory.
    nm : array_like
        Centres of the bands in nm, in equal steps.

    Attributes
    ----------
    statistics : dict
        Of a render: what `reradiant render --json` says, else empty.

    Examples
    --------
    >>> image = Image(np.ones((2, 3, 2), np.float32), [500, 510])
    >>> image
    Image(2 x 3, 2 bands, 500 to 510 nm)
    >>> image.values[0, 0] = 2
    >>> image.values[0, 0].tolist()
    [2.0, 2.0]
    """

    def __init__(self, values: Any, nm: Any) -> None:
        given = _checks.as_array("values", values)
        if given.dtype.kind not in "f" or given.dtype.itemsize > 8:
            raise _checks.refuse("values", f"has dtype {given.dtype}", "give float32")
        if given.ndim != 3 or 0 in given.shape:
            raise _checks.refuse("values", f"has shape {given.shape}",
                                 "give (height, width, band)")
        bands = _checks.grid("nm", nm)
        if bands[2] != given.shape[2]:
            raise _checks.refuse("nm", f"has {bands[2]} wavelengths and values {given.shape[2]} bands",
                                 "give one for each band")
        with np.errstate(over="ignore"):  # what is too large for float32 is refused below
            single = given.astype(np.float32, copy=False)
        if not np.isfinite(single).all():
            at = np.argwhere(~np.isfinite(single))[0].tolist()
            raise _checks.refuse("values", f"is not finite at {at}", "give finite float32 numbers")
        self._image = _library.SpectralImage(given.shape[0], given.shape[1], bands)
        self._image.values[...] = single
        self.statistics: Dict[str, Any] = {}

    @classmethod
    def _of(cls, image: "_library.SpectralImage", statistics: Dict[str, Any]) -> "Image":
        made = cls.__new__(cls)
        made._image = image
        made.statistics = statistics
        return made

    @classmethod
    def read(cls, file: Any) -> "Image":
        """Reads a spectral EXR (layout of Fichet, Pacanowski and Wilkie, JCGT 2021)."""
        return cls._of(_library.SpectralImage.read(_checks.path("file", file)), {})

    @property
    def values(self) -> np.ndarray:
        """float32 (height, width, band): a view of the image's memory, which it keeps alive."""
        return self._image.values

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> np.ndarray:
        return np.array(self.values, dtype=dtype, copy=True) if copy else np.asarray(self.values, dtype)

    @property
    def nm(self) -> np.ndarray:
        """Centres of the bands in nm, (band,)."""
        return _checks.centres(self._image.bands)

    @property
    def variance_y(self) -> Optional[np.ndarray]:
        """Variance of each pixel's mean Y, (height, width), or None."""
        return self._image.variance_y

    @property
    def variance(self) -> Optional[np.ndarray]:
        """Variance of each mean, (height, width, band), of renders with band_variance."""
        return self._image.variance_bands

    @property
    def sample_count(self) -> Optional[np.ndarray]:
        """Samples of each pixel, (height, width), or None."""
        return self._image.sample_count

    @property
    def attributes(self) -> Dict[str, str]:
        """Attributes by name that say what made the image, as its file has them."""
        return self._image.attributes

    def srgb(self) -> np.ndarray:
        """Linear sRGB, float32 (height, width, 3), not clamped; unit radiance has Y = 1."""
        return self._image.srgb()

    def write(self, file: Any, exposure: float = 0.0) -> None:
        """Writes a spectral EXR, whole or not at all; `exposure` (EV) is a hint for viewers."""
        self._image.write(_checks.path("file", file), _checks.number("exposure", exposure, -100, 100))

    def write_png(self, file: Any, exposure: float = 0.0, *, ocio: Any = "", display: str = "",
                  view: str = "") -> int:
        """Writes the display image through OpenColorIO (`ocio`: its configuration, else $OCIO, else
        sRGB) and returns how many pixels were out of gamut."""
        return self._image.write_png(
            _checks.path("file", file), _checks.path("ocio", ocio) if ocio else "",
            _checks.text("display", display), _checks.text("view", view),
            _checks.number("exposure", exposure, -100, 100))

    def png(self, exposure: float = 0.0) -> bytes:
        """The display image as bytes of a PNG file."""
        with tempfile.TemporaryDirectory(prefix="reradiant-") as folder:
            file = os.path.join(folder, "image.png")
            self.write_png(file, exposure)
            with open(file, "rb") as stream:
                return stream.read()

    def compare(self, reference: "Image") -> Dict[str, float]:
        """relmse, relmse_srgb, rmse, bias, bias_stderr, ciede2000 against a reference of the same
        size and bands; InputError else."""
        if not isinstance(reference, Image):
            raise _checks.refuse("reference", f"is a {type(reference).__name__}", "give an Image")
        return self._image.compare(reference._image)

    def _repr_png_(self) -> bytes:
        return self.png()

    def __repr__(self) -> str:
        height, width, bands = self.values.shape
        return f"Image({height} x {width}, {bands} bands, {self.nm[0]:g} to {self.nm[-1]:g} nm)"
