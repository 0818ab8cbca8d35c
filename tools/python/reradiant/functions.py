"""The commands of the program as functions. Ctrl-C ends each of them with KeyboardInterrupt;
the interpreter's lock is released while they work; warnings go to the logger "reradiant"."""

from __future__ import annotations

import math
from typing import Any, List, Optional, Sequence

from . import _checks, _library
from ._plain import source
from .errors import RunError
from .image import Image
from .matrix import Reradiation
from .results import BispectralData, Fit, Measurement, Synthetic
from .stack import Stack

MODELS = ["auto", "adding", "weidlich-wilkie", "walk"]
MOST_SAMPLES = 1 << 30


def render(scene: Any, *, spp: Optional[int] = None, seed: int = 0, time: Optional[float] = None,
           error: Optional[float] = None, model: str = "auto", wavelengths: str = "comb",
           comb_phase: str = "random", bands: Any = None, sample_range: Any = None, threads: int = 0,
           adaptive: bool = False, device: str = "", band_variance: bool = False,
           all_features: bool = False, memory_limit: int = 0, folder: Any = None) -> Image:
    """Path traces a scene.

    Parameters
    ----------
    scene : file name or dict
        A scene file (TOML, or Mitsuba's XML), or a dict of the same form; spectra may be `Spectrum`
        or numpy arrays, `reradiation` a `Reradiation`. Lengths are in the scene's own unit.
    spp : int
        Samples a pixel; 64 unless `time` or `error` is given.
    time, error : float
        Stop after so many seconds, set-up included, or at this estimated relMSE, whichever is met
        first.
    model : "auto", "adding", "weidlich-wilkie" or "walk"
        Instead of every material's own.
    wavelengths : "comb", "comb:N", "hero" or "hero:N"
    comb_phase : "random" or "centre"
        Wavelengths anywhere in a band, or at the band centres only.
    bands : (from, to, step) in nm
        Centres of the film's bands instead of the scene's.
    sample_range : (first, end)
        Only these samples of every pixel, to be merged with others.
    adaptive : bool
        More samples where the error is; `spp` is then the mean over pixels.
    folder : path
        Where relative paths of a dict start; the working folder by default.

    Returns
    -------
    Image
        Radiance in W m^-2 sr^-1 per nm, float32 (height, width, band), with `statistics`.

    Raises
    ------
    InputError
        For a wrong argument or scene, with file, line and column where it has them.
    RunError
        When there is no OpenCL device or it fails.

    Examples
    --------
    >>> scene = {"film": {"width": 4, "height": 2},
    ...          "camera": {"origin": [0, 0, 5], "target": [0, 0, 0]},
    ...          "light": [{"type": "environment", "radiance": 1.0}],
    ...          "shape": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "grey"}],
    ...          "material": [{"name": "grey", "substrate": {"type": "lambert", "reflectance": 0.5}}]}
    >>> image = render(scene, spp=4, seed=1, bands=(500, 520, 10))
    >>> image.values.shape, image.values.dtype.name
    ((2, 4, 3), 'float32')
    >>> render({"film": {"width": 4}}) # doctest: +IGNORE_EXCEPTION_DETAIL
    Traceback (most recent call last):
    reradiant.errors.InputError: ...[film] has no "height"; add height = ...
    """
    samples = 64 if time is None and error is None else MOST_SAMPLES
    if spp is not None:
        samples = _checks.integer("spp", spp, 1, MOST_SAMPLES)
    first = 0
    if sample_range is not None:
        if not isinstance(sample_range, (tuple, list)) or len(sample_range) != 2:
            raise _checks.refuse("sample_range", f"is {sample_range!r}", "give (first, end)")
        first = _checks.integer("sample_range[0]", sample_range[0], 0, 2**32 - 2)
        end = _checks.integer("sample_range[1]", sample_range[1], first + 1, 2**32 - 1)
        samples = end - first
    phase = _checks.choice("comb_phase", comb_phase, ["random", "centre"])
    if phase == "centre" and wavelengths.startswith("comb:"):
        raise _checks.refuse("comb_phase", "is 'centre' but wavelengths counts its own",
                             "use wavelengths='comb'")
    options = {
        "samples": samples,
        "first_sample": first,
        "time": math.inf if time is None else _checks.number("time", time, 0, above=True),
        "error": 0.0 if error is None else _checks.number("error", error, 0, above=True),
        "seed": _checks.seed(seed),
        "threads": _checks.integer("threads", threads, 0, 65536),
        "model": _checks.choice("model", model, MODELS),
        "wavelengths": _checks.text("wavelengths", wavelengths),
        "centred": phase == "centre",
        "bands": _checks.bands(bands),
        "device": _checks.text("device", device),
        "adaptive": _checks.flag("adaptive", adaptive),
        "band_variance": _checks.flag("band_variance", band_variance),
        "all_features": _checks.flag("all_features", all_features),
        "memory_limit": _checks.integer("memory_limit", memory_limit, 0, 2**63 - 1),
    }
    with source("scene", scene, folder) as given:
        image, statistics = _library.render(given, options)
    return Image._of(image, statistics)


def measure(material: Any = None, *, preset: Optional[str] = None, theta_i: Any = 0.0,
            theta_o: Any = 0.0, phi: Any = 0.0, hemispherical: bool = False, model: str = "auto",
            bands: Any = None, samples: int = 0, seed: int = 0, threads: int = 0,
            folder: Any = None) -> Measurement:
    """A virtual bispectral goniophotometer.

    Parameters
    ----------
    material : file name or dict
        MATERIAL.toml, or what stands in its [material]: {"layer": [...], "substrate": {...}}.
    preset : str
        Instead of a material: one of `presets()`.
    theta_i, theta_o, phi : float or array_like
        Degrees; phi is the azimuth of the outgoing from the incident direction, 180 is the mirror
        side. Thetas above 90 lie beneath a sheet.
    hemispherical : bool
        The directional-hemispherical matrix (unit 1) instead of the BRRDF (1/sr, without cosine).
    samples : int
        Paths for each theta_i, of the walk only.

    Returns
    -------
    Measurement
        Its `matrix()` is of the light that reached the substrate or that a slab spread;
        `matrix(specular=True)` is the gloss on top of it.

    Examples
    --------
    >>> m = measure({"substrate": {"type": "lambert", "reflectance": 0.5}}, bands=(500, 520, 10))
    >>> m.value.round(6)
    array([0.159155, 0.159155, 0.159155, 0.      , 0.      , 0.      ])
    >>> m.specular
    array([False, False, False,  True,  True,  True])
    """
    if (material is None) == (preset is None):
        raise _checks.refuse("material", "and preset are both given" if preset else "is not given",
                             "give one of material and preset")
    if preset is not None:
        material = {"material": {"preset": _checks.choice("preset", preset, presets())}}
    options = {
        "theta_i": _checks.polar_angles("theta_i", theta_i),
        "theta_o": _checks.polar_angles("theta_o", theta_o),
        "phi": _checks.angles("phi", phi, 360, True),
        "hemispherical": _checks.flag("hemispherical", hemispherical),
        "model": _checks.choice("model", model, MODELS),
        "bands": _checks.bands(bands),
        "samples": _checks.integer("samples", samples, 0, 2**62),
        "seed": _checks.seed(seed),
        "threads": _checks.integer("threads", threads, 0, 65536),
    }
    with source("material", material, folder, root="material") as given:
        return Measurement(_library.measure(given, options))


def synth(recipe: Any, *, seed: int = 0, folder: Any = None) -> Synthetic:
    """Synthetic bispectral data of known fluorophores, with an instrument's noise.

    Parameters
    ----------
    recipe : file name or dict
        As tools/examples/synth-orange.toml.

    Returns
    -------
    Synthetic
        `data` for `fit`, and `truth`, the substrate's matrix.

    Examples
    --------
    >>> dye = {"excitation": {"peak_nm": 450, "width_nm": 80}, "absorptance": 0.8,
    ...        "emission": {"peak_nm": 580, "width_nm": 60}, "quantum_yield": 0.9}
    >>> synth({"fluorophore": [dye]}).truth
    Reradiation(41 x 49, emission 380 to 780 nm, excitation 300 to 780 nm)
    """
    with source("recipe", recipe, folder) as given:
        data, truth, peak, noise = _library.synthesise(given, _checks.seed(seed))
    return Synthetic(BispectralData(data), Reradiation._of(truth), peak, noise)


def fit(data: Any, *, model: str = "factors", rank: Optional[int] = None,
        smooth_nm: Optional[float] = None, spill_nm: Optional[float] = None, loss: str = "none",
        mask: str = "auto", stack: Optional[Stack] = None, unknown: Sequence[str] = (),
        anti_stokes: bool = False, seed: int = 0, most_seconds: float = 60.0,
        most_iterations: int = 400, threads: int = 1) -> Fit:
    """Fits a re-radiation matrix to bispectral data, bare or through a stack.

    Parameters
    ----------
    data : file name, BispectralData or Reradiation
    model : "factors", "gaussians" or "matrix"
    rank : int
        Terms, 1 to 4 factors or 1 to 24 gaussians; by evidence when left out.
    mask : str
        Entries that count as not measured: "auto" (scatter of the monochromators that stands out),
        "none", or a list such as "first:20,second:15,third:10,half:10" (+- nm about emission = 1,
        2, 3, 1/2 x excitation; never the diagonal) and "box:300-350x500-560" (excitation x
        emission).
    stack : Stack
        What lay above the sample; `unknown` of "thickness", "absorption", "ior" is fitted too.
    most_seconds, most_iterations
        Limits of one minimisation.

    Returns
    -------
    Fit
        `matrix` on the data's grid, `summary` and more. Where the residuals are not noise,
        `summary["within_noise"]` is False, `summary["shortfall"]` says by how much, and the logger
        warns.

    Raises
    ------
    RunError
        When no minimisation converged, or a check of the result failed.
    """
    options = {
        "model": _checks.choice("model", model, ["factors", "gaussians", "matrix"]),
        "rank": None if rank is None else _checks.integer("rank", rank, 1, 24),
        "smooth_nm": None if smooth_nm is None else _checks.number("smooth_nm", smooth_nm, 0),
        "spill_nm": None if spill_nm is None else _checks.number("spill_nm", spill_nm, 0),
        "loss": _checks.choice("loss", loss, ["none", "huber", "cauchy"]),
        "mask": _checks.text("mask", mask),
        "stack": _stack(stack),
        "unknown": [_checks.choice(f"unknown[{k}]", name, ["thickness", "absorption", "ior"])
                    for k, name in enumerate([unknown] if isinstance(unknown, str) else unknown)],
        "anti_stokes": _checks.flag("anti_stokes", anti_stokes),
        "seed": _checks.seed(seed),
        "most_seconds": _checks.number("most_seconds", most_seconds, 0, above=True),
        "most_iterations": _checks.integer("most_iterations", most_iterations, 1, 2**31 - 1),
        "threads": _checks.integer("threads", threads, 0, 65536),
    }
    result = Fit(_library.fit(BispectralData.of(data)._data, options))
    if result._fit.failure:
        raise RunError(f"data: {result._fit.failure}; try another model or rank, or loss='huber' "
                       "for outliers")
    return result


def _stack(stack: Any) -> Any:
    if stack is None:
        return None
    if not isinstance(stack, Stack):
        raise _checks.refuse("stack", f"is a {type(stack).__name__}", "give a Stack")
    return stack._stack


def presets() -> List[str]:
    """Names of the materials that `preset` takes.

    >>> "red-lacquer" in presets()
    True
    """
    return _library.preset_names()


def devices() -> List[str]:
    """Names of the OpenCL devices; `device` takes part of one, or its index as str."""
    return _library.devices()
