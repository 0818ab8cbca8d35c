"""Spectra as functions of the wavelength."""

from __future__ import annotations

from typing import Any, Union

import numpy as np

from . import _checks, _library


class Spectrum:
    """A spectral quantity: the sum of a constant, linear tables, Gaussians, blackbodies and lines.

    Parameters
    ----------
    nm : array_like, (n,)
        Wavelengths in nm, strictly ascending.
    value : array_like, (n,)
        Values there; linear between, constant outside. The unit is that of what it is used for.

    Raises
    ------
    InputError
        For wavelengths that do not ascend or of which none is from 200 to 1000 nm, other lengths, and
        numbers that are masked, missing or not finite.

    Examples
    --------
    >>> s = Spectrum([400, 500], [0.0, 1.0])
    >>> s([425, 450, 600])
    array([0.25, 0.5 , 1.  ])
    >>> round(s.average(400, 500), 12)
    0.5
    >>> (2 * s + Spectrum.constant(1))(500)
    3.0
    """

    def __init__(self, nm: Any, value: Any) -> None:
        wavelengths = _checks.array("nm", nm, 1)
        values = _checks.array("value", value, 1)
        if wavelengths.size != values.size:
            raise _checks.refuse("value", f"has {values.size} numbers and nm {wavelengths.size}",
                                 "give one for each wavelength")
        if (np.diff(wavelengths) <= 0).any():
            raise _checks.refuse("nm", "does not ascend", "give each wavelength once, in order")
        self._spectrum = _library.Spectrum.table(wavelengths, values)

    @classmethod
    def _of(cls, spectrum: "_library.Spectrum") -> "Spectrum":
        made = cls.__new__(cls)
        made._spectrum = spectrum
        return made

    @classmethod
    def constant(cls, value: float) -> "Spectrum":
        """A spectrum with the same value at every wavelength."""
        return cls._of(_library.Spectrum.constant(_checks.number("value", value)))

    @classmethod
    def gaussian(cls, nm: float, sigma_nm: float, peak: float = 1.0) -> "Spectrum":
        """A Gaussian of wavelength with its `peak` at `nm`.

        >>> Spectrum.gaussian(600, 20).at(600)
        1.0
        """
        return cls._of(_library.Spectrum.gaussian(
            _checks.number("nm", nm, 0, above=True),
            _checks.number("sigma_nm", sigma_nm, 1e-3, 1e4), _checks.number("peak", peak)))

    @classmethod
    def line(cls, nm: float, width_nm: float = 1.0, integral: float = 1.0) -> "Spectrum":
        """A narrow line: a box of `width_nm` with this integral (value times nm)."""
        return cls._of(_library.Spectrum.line(
            _checks.number("nm", nm, 0, above=True),
            _checks.number("width_nm", width_nm, 1e-3, 1e4), _checks.number("integral", integral)))

    @classmethod
    def blackbody(cls, kelvin: float, value_at_560_nm: float = 1.0) -> "Spectrum":
        """Planck's law, scaled to a value at 560 nm."""
        return cls._of(_library.Spectrum.blackbody(
            _checks.number("kelvin", kelvin, 500, 1e6),
            _checks.number("value_at_560_nm", value_at_560_nm, 0)))

    @classmethod
    def illuminant(cls, name: str) -> "Spectrum":
        """A CIE standard illuminant (A, C, D50 to D75, E, FL1 to FL12, FL3.1 to FL3.15, HP1 to
        HP5, LED-B1 and so on) as its CIE table has it. An unknown name lists them all.

        >>> float(Spectrum.illuminant("D65").at(560))
        100.0
        """
        return cls._of(_library.Spectrum.illuminant(_checks.text("name", name)))

    @classmethod
    def rgb(cls, red: float, green: float, blue: float) -> "Spectrum":
        """A smooth reflectance with the colour of linear sRGB (0..1) under D65 (Mallett and Yuksel
        2019)."""
        given = [_checks.number(name, value, 0, 1)
                 for name, value in (("red", red), ("green", green), ("blue", blue))]
        return cls._of(_library.Spectrum.rgb(*given))

    @classmethod
    def read(cls, file: Any) -> "Spectrum":
        """Reads a table of two columns (.csv, .spd), JCAMP-DX, CGATS or IES TM-27 (.spdx)."""
        return cls._of(_library.Spectrum.read(_checks.path("file", file)))

    def at(self, nm: Any) -> Union[float, np.ndarray]:
        """Values at wavelengths in nm, of the shape of `nm`."""
        given = _checks.as_array("nm", nm)
        flat = _checks.array("nm", given.reshape(-1), 1)
        values = self._spectrum.at(flat)
        return float(values[0]) if given.ndim == 0 else values.reshape(given.shape)

    __call__ = at

    def average(self, from_nm: float, to_nm: float) -> float:
        """Mean over a range of wavelengths."""
        first = _checks.number("from_nm", from_nm)
        return self._spectrum.average(first, _checks.number("to_nm", to_nm, first, above=True))

    def xyz(self) -> np.ndarray:
        """CIE 1931 XYZ, (3,), in the scale where unit spectral radiance has Y = 1."""
        return np.array(self._spectrum.xyz())

    def scene_form(self) -> Any:
        """The spectrum as a scene file has it; curves are sampled each nm from 200 to 1000."""
        return self._spectrum.scene_form()

    def __add__(self, other: "Spectrum") -> "Spectrum":
        if not isinstance(other, Spectrum):
            return NotImplemented
        return Spectrum._of(self._spectrum.add(other._spectrum))

    def __mul__(self, factor: float) -> "Spectrum":
        return Spectrum._of(self._spectrum.scaled(_checks.number("factor", factor)))

    __rmul__ = __mul__

    def __repr__(self) -> str:
        values = ", ".join(f"{self.at(nm):.4g}" for nm in (400, 500, 600, 700))
        return f"Spectrum({values} at 400, 500, 600, 700 nm)"

    def _repr_html_(self) -> str:
        return self._spectrum.plot("", 300.0, 780.0)
