"""Checks of arguments. Every message begins with the argument's name and ends with a remedy."""

from __future__ import annotations

import math
import numbers
import os
from typing import Any, Optional, Sequence, Tuple

import numpy as np

from . import _library
from .errors import InputError

LARGEST_SEED = 2**32 - 1


def refuse(name: str, what: str, remedy: str) -> InputError:
    return InputError(f"{name} {what}; {remedy}")


def _is_number(value: Any) -> bool:
    return isinstance(value, (numbers.Real, np.integer, np.floating)) and not isinstance(
        value, (bool, np.bool_))


def number(name: str, value: Any, low: float = -math.inf, high: float = math.inf,
           above: bool = False) -> float:
    """A finite number from `low` (beyond it if `above`) to `high`."""
    if not _is_number(value):
        raise refuse(name, f"is {_kind(value)}", "give a number")
    try:
        given = float(value)
    except OverflowError:
        given = math.inf
    if not math.isfinite(given) or given < low or given > high or (above and given == low):
        bounds = [f"{'above' if above else 'at least'} {low:g}"] if low > -math.inf else []
        bounds += [f"at most {high:g}"] if high < math.inf else []
        raise refuse(name, f"is {given}", f"it must be {' and '.join(bounds) or 'finite'}")
    return given


def integer(name: str, value: Any, low: int, high: int) -> int:
    if not _is_number(value) or not isinstance(value, (numbers.Integral, np.integer)):
        raise refuse(name, f"is {_kind(value)}", "give a whole number")
    if not low <= int(value) <= high:
        raise refuse(name, f"is {value}", f"it must be from {low} to {high}")
    return int(value)


def seed(value: Any) -> int:
    return integer("seed", value, 0, LARGEST_SEED)


def flag(name: str, value: Any) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise refuse(name, f"is {_kind(value)}", "give True or False")
    return bool(value)


def text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise refuse(name, f"is {_kind(value)}", "give a str")
    if "\0" in value:
        raise refuse(name, "holds a zero character", "leave it out")
    return value


def choice(name: str, value: Any, names: Sequence[str]) -> str:
    if text(name, value) not in names:
        raise refuse(name, f"is {value!r}", f"use one of: {', '.join(names)}")
    return value


def path(name: str, value: Any) -> str:
    if not isinstance(value, (str, os.PathLike)):
        raise refuse(name, f"is {_kind(value)}", "give a file name (str or pathlib.Path)")
    file = os.fspath(value)
    if isinstance(file, bytes):
        file = os.fsdecode(file)
    if not file:
        raise refuse(name, "is empty", "give a file name")
    return text(name, file)


def _split_masks(value: Any) -> Tuple[Any, Any]:
    """(data, mask) of a masked array, or of lists that hold some."""
    if isinstance(value, (list, tuple)):
        parts = [_split_masks(entry) for entry in value]
        return [data for data, _ in parts], [mask for _, mask in parts]
    return np.ma.getdata(value), np.ma.getmaskarray(value)


def _holds_masks(value: Any) -> bool:
    return isinstance(value, np.ma.MaskedArray) or (
        isinstance(value, (list, tuple)) and any(_holds_masks(entry) for entry in value))


def _is_missing(value: Any) -> bool:
    """True for None and for the marks of pandas, which need not be installed."""
    return value is None or type(value).__name__ in ("NAType", "NaTType")


def as_array(name: str, value: Any, gaps: bool = False) -> np.ndarray:
    """The array of a value of any shape and type. Entries that a mask, None or pandas.NA marks as
    missing are refused, or with `gaps` NaN."""
    try:
        data, missing = _split_masks(value) if _holds_masks(value) else (value, None)
        given = np.asarray(data)
        missing = None if missing is None else np.asarray(missing, dtype=bool)
    except (ValueError, RecursionError):
        raise refuse(name, "has rows of different lengths", "give a rectangular array") from None
    mark = "masked"
    if missing is None and given.dtype.kind == "O":
        missing = np.reshape([_is_missing(entry) for entry in given.flat], given.shape)
        mark = "None or NA"
    if missing is None or not missing.any():
        return given
    at = tuple(int(k) for k in np.argwhere(missing)[0])
    if not gaps:
        raise refuse(name, f"is {mark} at {list(at)}" if at else f"is {mark}", "give every number")
    if given.dtype.kind == "O" and all(_is_number(entry) for entry in given[~missing]):
        given = np.where(missing, math.nan, given).astype(np.float64)
    return np.where(missing, math.nan, given) if given.dtype.kind in "iuf" else given


def array(name: str, value: Any, dimensions: int, gaps: bool = False) -> np.ndarray:
    """Finite real numbers as float64, with `gaps` NaN where one is missing; a copy only where the
    type or the layout asks for one."""
    given = as_array(name, value, gaps)
    if given.dtype.kind not in "iuf":
        raise refuse(name, f"has dtype {given.dtype}", "give real numbers")
    if given.ndim != dimensions:
        raise refuse(name, f"has shape {given.shape}", f"give {dimensions} dimension(s)")
    if given.size == 0:
        raise refuse(name, "is empty", "give at least one number")
    with np.errstate(over="ignore"):  # what is too large for float64 is refused below
        doubles = np.ascontiguousarray(given, dtype=np.float64)
    usable = np.isfinite(doubles) | np.isnan(doubles) if gaps else np.isfinite(doubles)
    if not usable.all():
        at = tuple(int(k) for k in np.argwhere(~usable)[0])
        raise refuse(name, f"is {given[at]} at {list(at)}", "give finite numbers")
    return doubles


def angles(name: str, value: Any, high: float, high_is_allowed: bool) -> np.ndarray:
    """Degrees from 0 to `high`; one number is a list of one."""
    given = array(name, [value] if _is_number(value) else value, 1)
    outside = (given < 0) | (given > high if high_is_allowed else given >= high)
    if outside.any():
        raise refuse(name, f"holds {given[outside][0]}",
                     f"angles are degrees from 0 {'to' if high_is_allowed else 'to below'} {high:g}")
    return given


def polar_angles(name: str, value: Any) -> np.ndarray:
    """Degrees from the normal, those beneath a sheet too; the material says whether it is one."""
    given = angles(name, value, 180, True)
    if (given == 90).any():
        raise refuse(name, "holds 90, which is along the surface",
                     "angles are degrees from 0 to below 90, and beneath a sheet above 90 to 180")
    return given


def grid(name: str, centres: Any) -> tuple:
    """(first centre, step, count) of centres in nm that ascend in equal steps, perhaps rounded."""
    nm = array(name, _as_written(centres), 1)
    if nm.size == 1:
        return float(nm[0]), 1.0, 1
    rounding = min(_half_last_digit(x) for x in nm)
    ascends = (np.diff(nm) > 0).all() and nm[0] > 0
    found = _library.rounded_grid(nm, rounding) if ascends else None
    if found is None:
        raise refuse(name, "does not ascend in equal steps from above 0",
                     "give the centres of equal bands in nm")
    return found


def sorted_axis(name: str, centres: Any) -> Tuple[np.ndarray, np.ndarray]:
    """Centres in nm that ascend, and the order that the values along them must be taken in."""
    nm = array(name, _as_written(centres), 1)
    order = np.argsort(nm, kind="stable")
    return nm[order], order


def _as_written(centres: Any) -> Any:
    """Single precision as the decimals that it stands for: 383.33 rather than 383.32998657."""
    given = np.asarray(centres) if hasattr(centres, "dtype") else None
    if given is None or given.dtype != np.float32 or np.ma.isMaskedArray(centres):
        return centres
    return np.array([float(str(x)) for x in given.ravel()]).reshape(given.shape)


def _half_last_digit(number: float) -> float:
    """0.005 for 383.33."""
    digits = np.format_float_positional(number, trim="-")
    return 0.5 * 10.0 ** -len(digits.partition(".")[2])


def bands(value: Any) -> Optional[tuple]:
    """(from, to, step) in nm, both ends centres of bands, as (from, step, count)."""
    if value is None:
        return None
    given = array("bands", value, 1)
    if given.size != 3:
        raise refuse("bands", f"has {given.size} numbers", "give (from, to, step) in nm")
    first, last, step = (float(x) for x in given)
    if not step > 0 or not first > 0 or last < first:
        raise refuse("bands", f"is ({first:g}, {last:g}, {step:g})",
                     "from must be above 0, to at least from, and step above 0")
    count = round((last - first) / step) + 1
    if abs(first + (count - 1) * step - last) > 1e-6 * step or count > 100000:
        raise refuse("bands", f"from {first:g} to {last:g} is no whole number of steps of {step:g}",
                     "from and to are centres, a whole number of steps apart")
    return first, step, count


def centres(numbers: tuple) -> np.ndarray:
    """The centres in nm of (first centre, step, count)."""
    first, step, count = numbers
    return first + step * np.arange(count)


def _kind(value: Any) -> str:
    kind = type(value).__name__
    return f"an {kind}" if kind[:1] in "aeiou" else f"a {kind}"
