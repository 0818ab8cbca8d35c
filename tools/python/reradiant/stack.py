"""Stacks of dielectric layers."""

from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np

from . import _checks, _library
from .matrix import Reradiation


class Stack:
    """Interfaces and slabs from the air down, what they let through by the model `adding`: every
    interreflection, in double precision.

    Parameters
    ----------
    layers : list of dict, or a file name
        Each as [[material.layer]] of a scene file: {"ior": 1.5, "thickness": 0.5, "absorption":
        Spectrum(...), "roughness_deg": 10}. A file is a MATERIAL.toml.

    Raises
    ------
    InputError
        For unknown keys and numbers out of range.

    Examples
    --------
    >>> varnish = Stack([{"ior": 1.5}])
    >>> round(float(varnish.internal_reflectance(550)), 6)
    0.596346
    >>> varnish.transmission([0, 60], [450, 550]).round(4)
    array([[0.96  , 0.96  ],
           [0.9108, 0.9108]])
    """

    def __init__(self, layers: Union[Sequence[dict], str]) -> None:
        from ._plain import source  # that module knows the classes
        given = layers
        if isinstance(layers, (list, tuple)):
            given = {"material": {"layer": list(layers)}}
        with source("layers", given, None) as plain:
            self._stack = _library.LayerStack.load(plain)

    def __len__(self) -> int:
        return self._stack.count

    def _angles_and_bands(self, theta_deg: Any, nm: Any) -> tuple:
        angles = _checks.as_array("theta_deg", theta_deg)
        bands = _checks.as_array("nm", nm)
        flat = _checks.array("nm", bands.reshape(-1), 1)
        if (flat <= 0).any():
            raise _checks.refuse("nm", f"holds {flat.min():g}", "wavelengths are above 0")
        return (_checks.angles("theta_deg", angles.reshape(-1), 90, False), flat,
                angles.shape + bands.shape)

    def transmission(self, theta_deg: Any, nm: Any) -> np.ndarray:
        """Share of the flux from these directions in air that arrives at the substrate, of shape
        (angles, wavelengths)."""
        angles, bands, shape = self._angles_and_bands(theta_deg, nm)
        return self._stack.transmission(angles, bands).reshape(shape)

    def specular_albedo(self, theta_deg: Any, nm: Any) -> np.ndarray:
        """Share that leaves again without having reached the substrate, (angles, wavelengths)."""
        angles, bands, shape = self._angles_and_bands(theta_deg, nm)
        return self._stack.specular_albedo(angles, bands).reshape(shape)

    def internal_reflectance(self, nm: Any) -> np.ndarray:
        """Share r of light emitted diffusely by the substrate that comes back to it."""
        _, bands, shape = self._angles_and_bands(0.0, nm)
        return self._stack.internal_reflectance(bands).reshape(shape)

    def over(self, matrix: Reradiation) -> np.ndarray:
        """M (I - diag(r) M)^-1 of a square matrix under this stack, all orders of interreflection:
        (bands, bands), rows = emission. InputError where the bands differ."""
        if not isinstance(matrix, Reradiation):
            raise _checks.refuse("matrix", f"is a {type(matrix).__name__}", "give a Reradiation")
        if matrix._matrix.emission != matrix._matrix.excitation:
            raise _checks.refuse("matrix", "has different emission and excitation bands",
                                 "give one whose bands agree")
        return _library.effective_matrix(matrix._whole().values,
                                         self.internal_reflectance(matrix.emission_nm))

    def __repr__(self) -> str:
        return f"Stack({len(self)} layer{'' if len(self) == 1 else 's'})"

    def _repr_html_(self) -> str:
        return self._stack.plot("", 380.0, 780.0)
