"""To and from the objects of the package colour-science, where it is installed."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _checks
from .errors import RunError
from .image import Image
from .matrix import Reradiation
from .spectrum import Spectrum


def _colour() -> Any:
    try:
        import colour
    except ImportError:
        raise RunError("colour-science is not installed; install the package colour-science"
                       ) from None
    return colour


def to_distribution(spectrum: Spectrum, nm: Any) -> Any:
    """A colour.SpectralDistribution with the values at wavelengths in nm."""
    if not isinstance(spectrum, Spectrum):
        raise _checks.refuse("spectrum", f"is a {type(spectrum).__name__}", "give a Spectrum")
    wavelengths = _checks.array("nm", nm, 1)
    return _colour().SpectralDistribution(spectrum.at(wavelengths), wavelengths)


def from_distribution(distribution: Any) -> Spectrum:
    """A Spectrum, linear between the wavelengths of a colour.SpectralDistribution."""
    if not isinstance(distribution, _colour().SpectralDistribution):
        raise _checks.refuse("distribution", f"is a {type(distribution).__name__}",
                             "give a colour.SpectralDistribution")
    return Spectrum(distribution.wavelengths, distribution.values)


def to_distributions(matrix: Reradiation) -> Any:
    """A colour.MultiSpectralDistributions over the emission wavelengths, one signal for each
    excitation band, labelled by its nm."""
    if not isinstance(matrix, Reradiation):
        raise _checks.refuse("matrix", f"is a {type(matrix).__name__}", "give a Reradiation")
    return _colour().MultiSpectralDistributions(
        np.array(matrix._whole().values), matrix.emission_nm,
        labels=[f"{nm:g}" for nm in matrix.excitation_nm])


def from_distributions(distributions: Any, **options: Any) -> Reradiation:
    """The other way round; `options` are those of Reradiation."""
    if not isinstance(distributions, _colour().MultiSpectralDistributions):
        raise _checks.refuse("distributions", f"is a {type(distributions).__name__}",
                             "give a colour.MultiSpectralDistributions")
    try:
        excitation = [float(label) for label in distributions.labels]
    except ValueError:
        raise _checks.refuse("distributions", "has labels that are no wavelengths",
                             "label each signal by its excitation in nm") from None
    return Reradiation(distributions.values, distributions.wavelengths, excitation, **options)


def to_image(image: Image) -> Any:
    """(values, colour.SpectralShape): the array of the image, not copied, and its wavelengths."""
    if not isinstance(image, Image):
        raise _checks.refuse("image", f"is a {type(image).__name__}", "give an Image")
    first, step, count = image._image.bands
    return image.values, _colour().SpectralShape(first, first + (count - 1) * step, step)
