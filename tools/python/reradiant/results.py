"""The results of `measure`, `synth` and `fit`."""

from __future__ import annotations

from typing import Any, Dict, List, NamedTuple, Optional, Tuple

import numpy as np

from . import _checks, _library
from .covariance import Covariance
from .matrix import Reradiation, table_form


class Measurement:
    """Rows of a virtual measurement, each attribute a column of the same length.

    Attributes
    ----------
    theta_i_deg, theta_o_deg, phi_deg, lambda_i_nm, lambda_o_nm : float64 (rows,)
    value : float64 (rows,)
        1/sr in per-band form without the cosine, or unit 1 when hemispherical.
    stderr : float64 (rows,)
        Standard error of `value` (0 for closed forms).
    part : str (rows,)
        "diffuse" (reached the substrate), "slab" (never did, but was scattered or re-emitted in a
        slab) or "specular" (neither); hemispherical rows of sheets also "transmitted",
        "transmitted-specular" and "guided".
    specular : bool (rows,)
        True where `part` is "specular", the gloss. `matrix` leaves it out unless it is asked for.
    """

    theta_i_deg: np.ndarray
    theta_o_deg: np.ndarray
    phi_deg: np.ndarray
    lambda_i_nm: np.ndarray
    lambda_o_nm: np.ndarray
    value: np.ndarray
    stderr: np.ndarray
    part: np.ndarray
    specular: np.ndarray

    def __init__(self, measurement: "_library.Measurement") -> None:
        self._measurement = measurement
        self.__dict__.update(measurement.columns())
        self.part = np.array(self.part, dtype=np.str_)

    @property
    def nm(self) -> np.ndarray:
        """Centres of the bands in nm."""
        return _checks.centres(self._measurement.bands)

    @property
    def model(self) -> str:
        """The model that was used."""
        return self._measurement.model

    @property
    def notes(self) -> List[str]:
        """Remarks that a reader of the values must know."""
        return self._measurement.notes

    def matrix(self, theta_i: float = 0.0, theta_o: float = 0.0, phi: float = 0.0,
               specular: bool = False, part: Optional[str] = None) -> np.ndarray:
        """(emission, excitation) values of one pair of directions; theta_o and phi do not count for
        hemispherical ones. InputError when it was not measured.

        The gloss is left out by default: these are the values of light that reached the substrate
        or that a slab scattered or re-emitted. With specular=True they are those of the gloss; the
        sum of the two is all light that comes back. (In directional measurements the mirror
        reflection of smooth surfaces is in neither, which `notes` says.) `part` asks for one part
        alone, by its name in the attribute `part`."""
        names = [part] if part is not None else ["specular"] if specular else ["diffuse", "slab"]
        rows = (self.theta_i_deg == theta_i) & np.isin(self.part, names)
        if not self._measurement.hemispherical:
            rows &= (self.theta_o_deg == theta_o) & (self.phi_deg == phi)
        if not rows.any():
            raise _checks.refuse("theta_i, theta_o, phi", f"= {theta_i}, {theta_o}, {phi} was not "
                                 "measured", "give a pair of directions that was")
        first, step, count = self._measurement.bands
        matrix = np.zeros((count, count))
        o = np.rint((self.lambda_o_nm[rows] - first) / step).astype(int)
        i = np.rint((self.lambda_i_nm[rows] - first) / step).astype(int)
        np.add.at(matrix, (o, i), self.value[rows])  # parts of one pair of wavelengths
        return matrix

    def write(self, file: Any) -> None:
        """Writes the CSV of `reradiant measure`."""
        self._measurement.write(_checks.path("file", file))

    def __len__(self) -> int:
        return len(self.value)

    def __repr__(self) -> str:
        return f"Measurement({len(self)} rows, model {self.model})"


class BispectralData:
    """Measured data: one matrix for each pair of directions, or one of a bare Lambertian sample."""

    def __init__(self, data: "_library.BispectralData") -> None:
        self._data = data

    @classmethod
    def read(cls, file: Any, *, rows: Optional[str] = None, quantity: Optional[str] = None,
             scale: Any = None, decimal: Optional[str] = None, kind: Optional[str] = None,
             anti_stokes: bool = False) -> "BispectralData":
        """Reads a re-radiation CSV (`nan`: not measured), a CSV of `measure`, .bfc or .exr. The
        keywords are for plain tables, as those of `Reradiation.read`."""
        form = table_form(rows, quantity, scale, decimal, kind, anti_stokes)
        return cls(_library.BispectralData.read(_checks.path("file", file), form))

    @classmethod
    def of(cls, data: Any) -> "BispectralData":
        """From data, a matrix of a bare sample, or a file name."""
        if isinstance(data, BispectralData):
            return data
        if isinstance(data, Reradiation):
            return cls(_library.BispectralData.from_matrix(data._matrix, "data"))
        return cls.read(_checks.path("data", data))

    @property
    def emission_nm(self) -> np.ndarray:
        return _checks.centres(self._data.emission)

    @property
    def excitation_nm(self) -> np.ndarray:
        return _checks.centres(self._data.excitation)

    def blocks(self) -> List[Tuple[Optional[tuple], np.ndarray, np.ndarray]]:
        """(theta_i, theta_o, phi) in degrees or None, values and standard errors (emission,
        excitation); NaN is "not measured" and "not known"."""
        return self._data.blocks()

    def matrix(self) -> Reradiation:
        """The data of a bare sample as a measured matrix; InputError for others."""
        blocks = self.blocks()
        if len(blocks) != 1 or blocks[0][0] is not None:
            raise _checks.refuse("data", "are not of a bare sample", "use blocks()")
        return Reradiation(blocks[0][1], self.emission_nm, self.excitation_nm, measured=True,
                           anti_stokes=self._data.anti_stokes_allowed)

    def write(self, file: Any) -> None:
        """Writes the CSV that `read` takes."""
        self._data.write(_checks.path("file", file))

    def __repr__(self) -> str:
        return (f"BispectralData({len(self.blocks())} x {self.emission_nm.size} x "
                f"{self.excitation_nm.size})")

    def _repr_html_(self) -> Optional[str]:
        blocks = self.blocks()
        bare = len(blocks) == 1 and blocks[0][0] is None and np.isfinite(blocks[0][1]).all()
        return self.matrix()._repr_html_() if bare else None


class Synthetic(NamedTuple):
    """Synthetic data, the matrix behind them, the largest fluorescent entry without noise and the
    root mean square of the noise off the diagonal."""

    data: BispectralData
    truth: Reradiation
    peak: float
    noise_rms: float


class Fit:
    """A fitted re-radiation matrix."""

    def __init__(self, fit: "_library.Fit") -> None:
        self._fit = fit

    @property
    def matrix(self) -> Reradiation:
        """The model on the data's grid, with the data's diagonal, lowered within its noise where
        more photons would leave than arrive."""
        return Reradiation._of(self._fit.matrix)

    @property
    def sigma(self) -> np.ndarray:
        """Standard error of every entry, (emission, excitation); NaN: unknown."""
        return self._fit.sigma

    @property
    def covariance(self) -> Covariance:
        """What is uncertain about `matrix`: the noise of the data through the model, and of the
        diagonal. InputError for the model "matrix", whose entries have `sigma` alone."""
        found = self._fit.covariance
        if found is None:
            raise _checks.refuse("covariance", "is not known of the model matrix",
                                 "fit factors or gaussians")
        return Covariance._of(found)

    @property
    def masked(self) -> np.ndarray:
        """True for entries that `mask` took as not measured, (emission, excitation)."""
        return self._fit.masked > 0

    @property
    def emission(self) -> np.ndarray:
        """(bands, terms), each with integral 1 over the emission, 1/nm; empty for `matrix`."""
        return self._fit.emission

    @property
    def excitation(self) -> np.ndarray:
        """(bands, terms): share of the irradiance that a term would emit untruncated."""
        return self._fit.excitation

    @property
    def summary(self) -> Dict[str, Any]:
        """The summary that `reradiant fit --json` writes: rank, relative_rmse, quantum_yield, ...

        quantum_yield is a list of {value, low, high}, one a term: photons emitted over photons that
        the sample absorbs, by its dye or by anything else. A dye's own yield, over the photons that
        the dye absorbs, is as high or higher."""
        return self._fit.summary()

    def write_report(self, file: Any) -> None:
        """Writes the HTML report."""
        self._fit.write_report(_checks.path("file", file))

    def __repr__(self) -> str:
        found = self.summary
        return (f"Fit({found['model']}, {found['rank']} terms, relative RMSE "
                f"{found['relative_rmse']:.4f})")

    def _repr_html_(self) -> str:
        return self.matrix._repr_html_()
