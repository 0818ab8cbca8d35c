"""To and from the objects of the package colour-science, where it is installed."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _checks
from .errors import RunError
from .image import Image
from .matrix import Reradiation
from .spectrum import Spectrum


_MOST_CHANNELS = 1 << 22  # as many entries as the library reads of a matrix


def _colour() -> Any:
    try:
        import colour
    except ImportError:
        raise RunError("colour-science is not installed; install the package colour-science"
                       ) from None
    return colour


def is_object(value: Any, kind: str) -> bool:
    """True for an object of that class of the package, or of one that inherits from it."""
    return any(base.__name__ == kind and base.__module__.split(".")[0] == "colour"
               for base in type(value).__mro__)


def _raise_channel_limit() -> None:
    """OpenImageIO, by which colour-science reads images, refuses more than 1024 channels; a matrix
    of 49 x 49 bands has 1225."""
    try:
        import OpenImageIO
    except ImportError:
        raise RunError("OpenImageIO is not installed; install the package OpenImageIO") from None
    limit = OpenImageIO.get_int_attribute("limits:channels", 1024)
    OpenImageIO.attribute("limits:channels", max(limit, _MOST_CHANNELS))


def read_spectral_image(file: Any, **options: Any) -> Any:
    """Reads a spectral or bispectral EXR by colour.read_spectral_image_Fichet2021, whatever the
    number of its channels; `options` are those of that function. A bispectral image is {excitation in
    nm: (emissions in nm, values), "T": (wavelengths, the diagonal)}."""
    colour = _colour()
    _raise_channel_limit()
    return colour.read_spectral_image_Fichet2021(str(file), **options)


def write_spectral_image(components: Any, file: Any, **options: Any) -> Any:
    """Writes a spectral or bispectral EXR by colour.write_spectral_image_Fichet2021."""
    colour = _colour()
    _raise_channel_limit()
    return colour.write_spectral_image_Fichet2021(components, str(file), **options)


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
    """Returns the Reradiation of distributions such as `to_distributions` makes; `options` are those of
    Reradiation."""
    if not isinstance(distributions, _colour().MultiSpectralDistributions):
        raise _checks.refuse("distributions", f"is a {type(distributions).__name__}",
                             "give a colour.MultiSpectralDistributions")
    try:
        excitation = [float(label) for label in distributions.labels]
    except ValueError:
        raise _checks.refuse("distributions", "has labels that are no wavelengths",
                             "label each signal by its excitation in nm") from None
    return Reradiation(distributions.values, distributions.wavelengths, excitation, **options)


def radiance_factors(colour_of_lamp: Any) -> Any:
    """A colour.MultiSpectralDistributions with the signals beta_T, beta_R and beta_L of what
    `reradiant.colour` says of one lamp; NaN where the lamp is dark."""
    if not isinstance(colour_of_lamp, dict) or "beta_T" not in colour_of_lamp:
        raise _checks.refuse("colour_of_lamp", f"is a {type(colour_of_lamp).__name__} without radiance "
                             "factors", "give an entry of what colour() returns")
    names = ["beta_T", "beta_R", "beta_L"]
    return _colour().MultiSpectralDistributions(
        np.transpose(np.array([colour_of_lamp[name] for name in names], float)), colour_of_lamp["nm"], labels=names)


def to_image(image: Image) -> Any:
    """(values, colour.SpectralShape): the array of the image, not copied, and its wavelengths."""
    if not isinstance(image, Image):
        raise _checks.refuse("image", f"is a {type(image).__name__}", "give an Image")
    first, step, count = image._image.bands
    return image.values, _colour().SpectralShape(first, first + (count - 1) * step, step)
