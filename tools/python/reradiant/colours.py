"""The colour of matrices, materials and measurements."""

from __future__ import annotations

import os
import tempfile
from typing import Any, Dict, List, Mapping, Optional

import numpy as np

from . import _checks, _library, colour_science
from ._plain import source
from .covariance import covariance_of
from .errors import InputError
from .matrix import Reradiation
from .results import BispectralData, Fit, Measurement
from .spectrum import Spectrum

OBSERVERS = ["1931-2", "1964-10", "2015-2", "2015-10"]


def colour(sample: Any = None, lamps: Any = "D65", *, preset: Optional[str] = None,
           observer: Any = "1931-2", geometry: Optional[str] = None, uv_cut: Optional[float] = None,
           against: Any = None, covariance: Any = None, polygons: Any = None,
           e308: Optional[bool] = None, seed: int = 0, folder: Any = None,
           illuminant: Any = None) -> Dict[str, Dict[str, Any]]:
    """The colour of a sample as laboratories report it: what `reradiant colour --json` says.

    Parameters
    ----------
    sample, against : Reradiation, Fit, BispectralData, Measurement, dict or file name
        A matrix (also a colour.MultiSpectralDistributions), bare measured data, what `measure` saw, or a
        material as `measure` takes it. `against` is the reference of differences.
    preset : str
        Instead of a sample: one of `presets()`.
    lamps : str, Spectrum, array, colour.SpectralDistribution, list or dict of these
        A str is a CIE name or "D:KELVIN", "P:KELVIN", "L:NM[:WIDTH]", a sum such as "D65+30*L:365",
        "M0", "M1", "M2"; an unknown one lists all. A path is a file of a spectrum. An array (n, 2)
        has the columns nm and relative irradiance, and is dark outside them. A dict gives names.
    observer : str or list of str
        1931-2, 1964-10, 2015-2, 2015-10.
    geometry : str
        Of materials and measurements: "45/0" (where none is given), "0/45", "8/d", "d/8", "8/de",
        "de/8", or "THETA_I:THETA_O[:PHI]" in degrees.
    uv_cut : float
        The lamps have no light below this, nm.
    covariance : Covariance, Fit, file name or array
        What is uncertain about the matrix: gives `intervals`. An array (emission, excitation) holds
        independent standard errors, (K, emission, excitation) is `Covariance.directions`. A `Fit` as
        the sample brings its own.
    polygons : file name
        CSV of chromaticity regions that are tested, as `--polygons`.
    e308 : bool
        Sums over 1 nm (ASTM E308, E2022), or plain sums over the bands (ASTM E2152). By default the
        latter, unless they misjudge the lamp itself by over 0.2 %; "sums" tells.
    seed : int
        Of the drawn matrices of `intervals`.
    folder : path
        Where relative paths of a dict start; the working folder by default.
    illuminant
        The former name of `lamps`.

    Returns
    -------
    dict
        Lamp (or "lamp/observer", where there are several observers) -> XYZ (perfect diffuser Y = 100),
        xy, Lab, LCh, whiteness_cie, tint_cie, r457, whiteness_e313 and yellowness_e313 where the lamp
        defines them, uv_excluded (without the fluorescence that light below 420 nm excites), delta_e
        and metamerism with `against`, intervals with `covariance`, nm, beta_T, beta_R, beta_L, warnings
        and more.

    Raises
    ------
    InputError
        For what is no sample, lamp, observer or geometry, a geometry for a matrix, which has that of
        its instrument, and a covariance of another matrix.

    Notes
    -----
    CIE 15:2018, ISO 2470, ASTM E308 and E313; tools/docs/colour.md of the project names them all.

    Examples
    --------
    >>> nm = np.arange(380, 781, 10)
    >>> grey = Reradiation(0.2 * np.eye(41), nm, nm)
    >>> round(colour(grey)["D65"]["XYZ"][1], 6)
    20.0
    >>> seen = colour(grey, ["D65", "A"], observer="1964-10", covariance=0.002 * np.eye(41))
    >>> np.round(seen["A"]["intervals"]["linearised"]["Lab"]["standard_error"], 2)
    array([0.06, 0.14, 0.16])
    >>> gloss = colour(preset="red-lacquer", geometry="8/d")["D65"]
    >>> matt = colour(preset="red-lacquer", geometry="8/de")["D65"]
    >>> bool(gloss["Lab"][0] > matt["Lab"][0])
    True
    """
    if (sample is None) == (preset is None):
        raise _checks.refuse("sample", "and preset are both given" if preset else "is not given",
                             "give one of sample and preset")
    if preset is not None:
        sample = {"preset": _checks.choice("preset", preset, _library.preset_names())}
    if isinstance(sample, Fit) and covariance is None and sample._fit.covariance is not None:
        covariance = sample.covariance
    matrix = _matrix("sample", sample, geometry, folder)
    reference = None if against is None else _matrix("against", against, geometry, folder, True)
    if isinstance(covariance, Fit):
        covariance = covariance.covariance
    return _library.colour(matrix, {
        "lamps": _lamps(lamps if illuminant is None else illuminant, uv_cut),
        "observers": _observers(observer),
        "e308": None if e308 is None else _checks.flag("e308", e308),
        "against": reference,
        "covariance": covariance_of(covariance, matrix),
        "polygons": None if polygons is None else _checks.path("polygons", polygons),
        "seed": _checks.seed(seed),
    })


def _observers(observer: Any) -> List[str]:
    names = [observer] if isinstance(observer, str) else observer
    if not isinstance(names, (list, tuple)) or not names:
        raise _checks.refuse("observer", f"is {observer!r}", f"use of: {', '.join(OBSERVERS)}")
    return [_checks.choice("observer", name, OBSERVERS) for name in names]


def _is_file(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _matrix(name: str, value: Any, geometry: Optional[str], folder: Any,
            is_reference: bool = False) -> "_library.ReradiationMatrix":
    """The radiance factors of a sample."""
    asked = "45/0" if geometry is None else _checks.text("geometry", geometry)
    if _is_file(value) and str(_checks.path(name, value)).lower().endswith((".toml", ".xml")) \
            or isinstance(value, Mapping):
        with source(name, value, folder, root="material") as given:
            return _library.matrix_of_material(given, asked)
    if isinstance(value, Measurement):
        with tempfile.TemporaryDirectory(prefix="reradiant-") as temporary:
            file = os.path.join(temporary, f"{name}.csv")
            value.write(file)
            try:
                return _library.matrix_of_measurement(file, asked)
            except InputError as error:
                raise InputError(str(error).replace(file, name)) from None
    if _is_file(value) and _holds_directions(value):
        return _library.matrix_of_measurement(_checks.path(name, value), asked)
    if geometry is not None and not is_reference:
        raise _checks.refuse("geometry", "is given for a matrix, which has that of its instrument",
                             "leave it out, or give a material or a Measurement")
    return _declared(name, value)._whole()


def _declared(name: str, value: Any) -> Reradiation:
    """The matrix that an object holds or a file says to be one."""
    if isinstance(value, Reradiation):
        return value
    if isinstance(value, Fit):
        return value.matrix
    if isinstance(value, BispectralData):
        return value.matrix()
    if colour_science.is_object(value, "MultiSpectralDistributions"):
        return colour_science.from_distributions(value)
    if not _is_file(value):
        raise _checks.refuse(name, f"is a {type(value).__name__}",
                             "give a Reradiation, a Fit, a Measurement, a material as dict, or a file name")
    return Reradiation.read(value)


def _holds_directions(file: Any) -> bool:
    """True for a CSV of `measure`: its headings begin with the angle of incidence."""
    try:
        with open(file, encoding="utf-8", errors="replace") as stream:
            heads = (line for line in stream if line.strip() and not line.startswith("#"))
            return next(heads, "").startswith("theta_i_deg")
    except OSError:
        return False  # the library says what is wrong with it


def _lamps(given: Any, uv_cut: Optional[float]) -> List["_library.Lamp"]:
    if isinstance(given, Mapping):
        lamps = [_lamp(light, _checks.text("lamps", name)) for name, light in given.items()]
    else:
        lamps = [_lamp(light) for light in (given if isinstance(given, (list, tuple)) else [given])]
    names = [lamp.name for lamp in lamps]
    if not lamps or len(set(names)) < len(names):
        raise _checks.refuse("lamps", f"are {names}", "give at least one, every name once; a dict of "
                             "name and lamp names them")
    if uv_cut is None:
        return lamps
    return [lamp.without_ultraviolet(_checks.number("uv_cut", uv_cut, 200, 780)) for lamp in lamps]


def _lamp(light: Any, name: Optional[str] = None) -> "_library.Lamp":
    """A lamp from any form of it, by its own name where none is given."""
    if isinstance(light, str):
        lamp = _library.Lamp.from_text(_checks.text("lamps", light))
    elif isinstance(light, os.PathLike):
        lamp = _library.Lamp.read(_checks.path("lamps", light))
    elif isinstance(light, Spectrum):
        lamp = _library.Lamp.from_light("lamp", light._spectrum)
    elif colour_science.is_object(light, "SpectralDistribution"):
        lamp = _library.Lamp.from_table(str(light.name), *_table(
            np.column_stack([light.wavelengths, light.values])))
    elif isinstance(light, (np.ndarray, list)):
        lamp = _library.Lamp.from_table("lamp", *_table(light))
    else:
        raise _checks.refuse("lamps" if name is None else f"lamps[{name!r}]",
                             f"is a {type(light).__name__}", "give a str, a Spectrum, an array (n, 2) of "
                             "nm and value, a colour.SpectralDistribution, or a list or dict of these")
    if name is not None:
        lamp.name = name
    return lamp


def _table(given: Any) -> List[np.ndarray]:
    table = _checks.array("lamps", given, 2)
    if table.shape[1] != 2 or len(table) < 2:
        raise _checks.refuse("lamps", f"has shape {table.shape}", "give two columns, nm and value")
    if (np.diff(table[:, 0]) <= 0).any() or table[0, 0] <= 0:
        raise _checks.refuse("lamps", "has wavelengths that do not ascend from above 0",
                             "give each in nm once, in order")
    if (table[:, 1] < 0).any() or not table[:, 1].any():
        raise _checks.refuse("lamps", "is dark or negative", "a lamp's light is at least 0")
    return [np.ascontiguousarray(column) for column in table.T]
