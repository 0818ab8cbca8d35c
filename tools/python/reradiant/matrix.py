"""Re-radiation (Donaldson) matrices."""

from __future__ import annotations

from typing import Any, List, Optional, Sequence, Tuple

import numpy as np

from . import _checks, _library
from .spectrum import Spectrum


def table_form(rows: Optional[str], quantity: Optional[str], scale: Any, decimal: Optional[str],
               kind: Optional[str], anti_stokes: bool) -> "_library.TableForm":
    """Checks the properties that a plain table does not say of itself, for the library."""
    def word(name: str, value: Optional[str], names: Sequence[str]) -> str:
        return "" if value is None else _checks.choice(name, value, names)

    if scale is None or isinstance(scale, str):
        factor = word("scale", scale, ["percent", "permille"])
    else:
        factor = repr(_checks.number("scale", scale, 0, above=True))
    return _library.TableForm(
        word("rows", rows, ["emission", "excitation", "rows-emission", "rows-excitation"]),
        word("quantity", quantity, ["per-band", "density", "density-per-nm"]), factor,
        word("decimal", decimal, ["comma", "point"]), word("kind", kind, ["measured", "model"]),
        _checks.flag("anti_stokes", anti_stokes))


class Reradiation:
    """A re-radiation matrix in per-band form: exitance[o] = sum over i of values[o, i] *
    irradiance[i], both spectral, per nm.

    Parameters
    ----------
    values : array_like, (emission, excitation)
        Unit 1; the entry where both wavelengths agree is the reflectance. Of a measurement, entries
        that are NaN, None, pandas.NA or masked were not measured: `fit` does without them.
    emission_nm, excitation_nm : array_like
        Centres of the bands in nm, in equal steps, in any order; they may be rounded (383.33,
        386.67, 390).
    quantity : "per-band" or "density-per-nm"
        What `values` are: a density (1/nm off the diagonal) is multiplied by the excitation step.
    measured : bool
        A measurement may hold noise; a model must conserve energy to be rendered.
    anti_stokes : bool
        Emission below the excitation is meant.

    Raises
    ------
    InputError
        For shapes that do not fit, uneven wavelengths, numbers that are not finite, and values or
        wavelengths that must be in another unit (percent, micrometres).

    Notes
    -----
    Bands and forms after CIE 17-21-101 and Donaldson 1954.

    Examples
    --------
    >>> m = Reradiation([[0.5, 0.0], [0.2, 0.6]], [400, 500], [400, 500])
    >>> m.values
    array([[0.5, 0. ],
           [0.2, 0.6]])
    >>> m.energy().round(3), m.photons().round(3)
    (array([0.7, 0.6]), array([0.75, 0.6 ]))
    """

    def __init__(self, values: Any, emission_nm: Any, excitation_nm: Any, *,
                 quantity: str = "per-band", measured: bool = False,
                 anti_stokes: bool = False) -> None:
        is_measured = _checks.flag("measured", measured)
        numbers = _checks.array("values", values, 2, gaps=is_measured)
        emission_nm, rows = _checks.sorted_axis("emission_nm", emission_nm)
        excitation_nm, columns = _checks.sorted_axis("excitation_nm", excitation_nm)
        emission = _checks.grid("emission_nm", emission_nm)
        excitation = _checks.grid("excitation_nm", excitation_nm)
        if numbers.shape != (emission[2], excitation[2]):
            raise _checks.refuse(
                "values", f"has shape {numbers.shape}",
                f"give (emission, excitation) = ({emission[2]}, {excitation[2]})")
        numbers = np.ascontiguousarray(numbers[np.ix_(rows, columns)])
        if _checks.choice("quantity", quantity,
                          ["per-band", "density", "density-per-nm"]) != "per-band":
            off = ~np.isclose(_checks.centres(emission)[:, None], _checks.centres(excitation)[None, :],
                              rtol=0, atol=1e-6 * min(emission[1], excitation[1]))
            numbers = np.where(off, numbers * excitation[1], numbers)
        self._matrix = _library.ReradiationMatrix(
            numbers, emission, excitation, is_measured, _checks.flag("anti_stokes", anti_stokes))

    @classmethod
    def _of(cls, matrix: "_library.ReradiationMatrix") -> "Reradiation":
        made = cls.__new__(cls)
        made._matrix = matrix
        return made

    def _whole(self) -> "_library.ReradiationMatrix":
        """The matrix for what needs every entry; InputError where one was not measured."""
        missing = np.isnan(self._matrix.values)
        if missing.any():
            at = [int(k) for k in np.argwhere(missing)[0]]
            raise _checks.refuse("values", f"is missing at {at}", "fit the data and use the result")
        return self._matrix

    @classmethod
    def read(cls, file: Any, *, rows: Optional[str] = None, quantity: Optional[str] = None,
             scale: Any = None, decimal: Optional[str] = None, kind: Optional[str] = None,
             anti_stokes: bool = False) -> "Reradiation":
        """Reads a re-radiation CSV, a .bfc of a Labsphere BFC-450 or a bispectral EXR; values are
        raw, nothing is repaired. What speaks against the reading is logged.

        Parameters
        ----------
        rows : "emission" or "excitation"
            What a row of a plain table belongs to. This and the others are for tables that do not
            say it themselves; where they do, both must agree.
        quantity : "per-band" or "density"
        scale : "percent", "permille" or float
            The factor that makes a white reflect 1.
        decimal : "comma" or "point"
            Told by itself where semicolons or tabs part the cells.
        kind : "measured" or "model"
        anti_stokes : bool
            Emission below the excitation is real.

        Raises
        ------
        InputError
            For a table that says too little, or other than the arguments.
        """
        form = table_form(rows, quantity, scale, decimal, kind, anti_stokes)
        return cls._of(_library.ReradiationMatrix.read(_checks.path("file", file), form))

    @classmethod
    def from_fluorophores(cls, fluorophores: Sequence[Tuple[Spectrum, Spectrum, float]],
                          reflectance: Optional[Spectrum] = None, *, emission_nm: Any,
                          excitation_nm: Any) -> "Reradiation":
        """The matrix of known dyes.

        Parameters
        ----------
        fluorophores : list of (excitation, emission, quantum yield)
            Share of the incident photons absorbed (0..1), relative radiant power per nm, and
            photons out over photons absorbed.
        """
        if isinstance(fluorophores, tuple) and fluorophores and isinstance(fluorophores[0], Spectrum):
            fluorophores = [fluorophores]  # one dye without its list
        parts = []
        for k, entry in enumerate(fluorophores):
            name = f"fluorophores[{k}]"
            if not isinstance(entry, (tuple, list)) or len(entry) != 3 or not all(
                    isinstance(s, Spectrum) for s in entry[:2]):
                raise _checks.refuse(name, "is not two spectra and a number",
                                     "give (excitation, emission, quantum yield)")
            parts.append((entry[0]._spectrum, entry[1]._spectrum,
                          _checks.number(f"{name}[2]", entry[2], 0, 1)))
        base = Spectrum.constant(0.0) if reflectance is None else reflectance
        if not isinstance(base, Spectrum):
            raise _checks.refuse("reflectance", f"is a {type(base).__name__}", "give a Spectrum")
        return cls._of(_library.ReradiationMatrix.from_fluorophores(
            parts, base._spectrum, _checks.grid("emission_nm", emission_nm),
            _checks.grid("excitation_nm", excitation_nm)))

    def write(self, file: Any) -> None:
        """Writes .csv, .bfc or .exr; whole or not at all. What was not measured fits into .csv only,
        which `BispectralData.read` takes."""
        name = _checks.path("file", file)
        matrix = self._matrix if name.lower().endswith(".csv") else self._whole()
        matrix.write(name)

    @property
    def values(self) -> np.ndarray:
        """(emission, excitation) float64, unit 1, a read-only view without a copy."""
        values = self._matrix.values
        values.flags.writeable = False
        return values

    @property
    def emission_nm(self) -> np.ndarray:
        """Centres of the emission bands in nm, (emission,)."""
        return _checks.centres(self._matrix.emission)

    @property
    def excitation_nm(self) -> np.ndarray:
        """Centres of the excitation bands in nm, (excitation,)."""
        return _checks.centres(self._matrix.excitation)

    @property
    def measured(self) -> bool:
        return self._matrix.measured

    def reflectance(self) -> Spectrum:
        """The diagonal."""
        return Spectrum._of(self._whole().reflectance())

    def fluorescent_part(self) -> np.ndarray:
        """`values` with the diagonal set to zero, (emission, excitation)."""
        return self._whole().fluorescent_part()

    def energy(self) -> np.ndarray:
        """Radiant power out over power in, per excitation band; at most 1 for a passive sample."""
        return self._whole().balance()[0]

    def photons(self) -> np.ndarray:
        """Photons out over photons in, per excitation band."""
        return self._whole().balance()[1]

    def repaired(self) -> Tuple["Reradiation", List[str]]:
        """The matrix as `render` uses it, and what was changed or is doubtful. InputError when it
        breaks energy."""
        matrix, warnings = self._whole().repaired()
        return Reradiation._of(matrix), warnings

    def factorise(self, rank: int = 4, tolerance: float = 1e-3) -> Tuple[np.ndarray, np.ndarray, float]:
        """Non-negative factors of the fluorescent part on the emission bands: (bands, K) emission,
        (bands, K) excitation with K <= `rank`, and the relative error of the masked product."""
        return self._whole().factorise(_checks.integer("rank", rank, 1, 4),
                                      _checks.number("tolerance", tolerance, 0, 1))

    def __repr__(self) -> str:
        emission, excitation = self.emission_nm, self.excitation_nm
        return (f"Reradiation({emission.size} x {excitation.size}, emission {emission[0]:g} to "
                f"{emission[-1]:g} nm, excitation {excitation[0]:g} to {excitation[-1]:g} nm)")

    def _repr_html_(self) -> Optional[str]:
        if np.isnan(self._matrix.values).any():
            return None  # the text has to do
        return self._matrix.plot("fluorescent part, per band")
