"""What is uncertain about a re-radiation matrix."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _checks, _library


class Covariance:
    """The covariance of a re-radiation matrix's entries in per-band form: of two entries the sum over
    directions of the product of their values, and the square of the independent standard error more
    where both are the same entry.

    Parameters
    ----------
    emission_nm, excitation_nm : array_like
        Centres of the matrix's bands in nm, ascending in equal steps.
    independent : array_like, (emission, excitation)
        Standard errors that no other entry shares; zero when left out.
    directions : array_like, (K, emission, excitation)
        What one standard error of each of K independent causes adds to the matrix.

    Raises
    ------
    InputError
        For shapes that do not fit and negative standard errors.

    Examples
    --------
    >>> c = Covariance([400, 500], [400, 500], independent=[[0.003, 0], [0, 0.003]],
    ...                directions=[[[0.0, 0.0], [0.004, 0.0]]])
    >>> c.standard_errors
    array([[0.003, 0.   ],
           [0.004, 0.003]])
    """

    def __init__(self, emission_nm: Any, excitation_nm: Any, *, independent: Any = None,
                 directions: Any = None) -> None:
        emission = _checks.grid("emission_nm", emission_nm)
        excitation = _checks.grid("excitation_nm", excitation_nm)
        shape = (emission[2], excitation[2])
        own = np.zeros(shape) if independent is None else _checks.array("independent", independent, 2)
        if (own < 0).any():
            at = [int(k) for k in np.argwhere(own < 0)[0]]
            raise _checks.refuse("independent", f"is negative at {at}", "standard errors are at least 0")
        causes = (np.zeros((0, *shape)) if directions is None
                  else _checks.array("directions", directions, 3))
        for name, given in (("independent", own.shape), ("directions", causes.shape[1:])):
            if given != shape:
                raise _checks.refuse(name, f"has shape {given} of bands",
                                     f"the wavelengths ask for {shape}")
        self._covariance = _library.MatrixCovariance(emission, excitation, own, causes)

    @classmethod
    def _of(cls, covariance: "_library.MatrixCovariance") -> "Covariance":
        made = cls.__new__(cls)
        made._covariance = covariance
        return made

    @classmethod
    def read(cls, file: Any) -> "Covariance":
        """Reads the CSV of `reradiant fit --covariance`. InputError has the place of what is wrong."""
        return cls._of(_library.MatrixCovariance.read(_checks.path("file", file)))

    def write(self, file: Any) -> None:
        """Writes the CSV that `read` and `reradiant colour --covariance` take, whole or not at all."""
        self._covariance.write(_checks.path("file", file))

    @property
    def emission_nm(self) -> np.ndarray:
        """Centres of the emission bands in nm, (emission,)."""
        return _checks.centres(self._covariance.emission)

    @property
    def excitation_nm(self) -> np.ndarray:
        """Centres of the excitation bands in nm, (excitation,)."""
        return _checks.centres(self._covariance.excitation)

    @property
    def independent(self) -> np.ndarray:
        """Standard errors that no other entry shares, (emission, excitation); NaN: not known."""
        return self._covariance.independent

    @property
    def directions(self) -> np.ndarray:
        """(K, emission, excitation), a copy."""
        return self._covariance.directions

    @property
    def standard_errors(self) -> np.ndarray:
        """Standard error of every entry, (emission, excitation); NaN: not known."""
        return self._covariance.standard_errors()

    def __repr__(self) -> str:
        return (f"Covariance({self.emission_nm.size} x {self.excitation_nm.size}, "
                f"{len(self.directions)} directions)")


def covariance_of(value: Any, matrix: "_library.ReradiationMatrix"
                  ) -> Optional["_library.MatrixCovariance"]:
    """The covariance that an argument stands for, checked against its matrix."""
    if value is None:
        return None
    if isinstance(value, Covariance):
        found = value._covariance
    elif isinstance(value, (str, bytes)) or hasattr(value, "__fspath__"):
        found = Covariance.read(value)._covariance
    else:
        errors = _checks.as_array("covariance", value)
        if errors.ndim not in (2, 3):
            raise _checks.refuse("covariance", f"has shape {errors.shape}",
                                 "give a Covariance, a file, standard errors (emission, excitation) or "
                                 "directions (K, emission, excitation)")
        kind = "independent" if errors.ndim == 2 else "directions"
        found = Covariance(_checks.centres(matrix.emission), _checks.centres(matrix.excitation),
                           **{kind: errors})._covariance
    found.require_of(matrix)
    return found
