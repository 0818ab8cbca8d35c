"""Renders, measures and fits layered materials that fluoresce.

`render`, `measure`, `synth`, `fit` and `colour` do what the program's commands of these names do,
on files or on dicts of the same form; `Spectrum`, `Reradiation`, `Stack` and `Image` hold what they
work on and show themselves in notebooks. Wavelengths are in nm, angles in degrees. The equations and
their sources are in host/README.md of the project.
"""

from ._compiled_part import load_compiled_part

_library = load_compiled_part()

from . import colour_science
from .colours import colour
from .covariance import Covariance
from .errors import Error, InputError, RunError
from .functions import devices, fit, measure, presets, render, synth
from .image import Image
from .matrix import Reradiation
from .plot import Plot
from .results import BispectralData, Fit, Measurement, Synthetic
from .spectrum import Spectrum
from .stack import Stack

__version__ = _library.version
__all__ = [
    "BispectralData", "Covariance", "Error", "Fit", "Image", "InputError", "Measurement", "Plot", "Reradiation", "RunError",
    "Spectrum", "Stack", "Synthetic", "colour", "colour_science", "devices", "fit", "measure",
    "presets", "render", "synth",
]
