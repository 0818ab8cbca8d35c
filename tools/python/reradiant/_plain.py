"""Scenes, materials and recipes as dicts: turned into plain Python values for the library."""

from __future__ import annotations

import contextlib
import math
import os
import tempfile
from typing import Any, Iterator, Mapping, Optional

import numpy as np

from . import _checks
from .matrix import Reradiation
from .spectrum import Spectrum

MOST_NESTING = 64


class _Plain:
    """Turns values into dict, list, str, int, float and bool; matrices become files of `folder`."""

    def __init__(self, folder: str) -> None:
        self._folder = folder
        self._files = 0

    def value(self, value: Any, name: str, depth: int = 0) -> Any:
        if depth > MOST_NESTING:
            raise _checks.refuse(name[:80], f"is nested more than {MOST_NESTING} deep", "flatten it")
        if isinstance(value, Spectrum):
            return value.scene_form()
        if isinstance(value, Reradiation):
            return self._matrix(value)
        if isinstance(value, np.ndarray):
            return self.value(_checks.array(name, value, 1).tolist(), name, depth)
        if isinstance(value, Mapping):
            return {self._key(key, name): self.value(entry, f"{name}[{key!r}]", depth + 1)
                    for key, entry in value.items()}
        if isinstance(value, (list, tuple)):
            return [self.value(entry, f"{name}[{k}]", depth + 1) for k, entry in enumerate(value)]
        return self._scalar(value, name)

    @staticmethod
    def _key(key: Any, name: str) -> str:
        if not isinstance(key, str):
            raise _checks.refuse(name, f"has the key {key!r}", "keys are str")
        return key

    @staticmethod
    def _scalar(value: Any, name: str) -> Any:
        if isinstance(value, (bool, np.bool_)):
            return bool(value)
        if isinstance(value, (int, np.integer)):
            return _checks.integer(name, value, -(2**63), 2**63 - 1)
        if isinstance(value, (float, np.floating)):
            if not math.isfinite(value):
                raise _checks.refuse(name, f"is {value}", "give a finite number")
            return float(value)
        if isinstance(value, (str, os.PathLike)):
            return _checks.text(name, os.fspath(value))
        raise _checks.refuse(
            name, f"is a {type(value).__name__}",
            "use dict, list, str, numbers, numpy arrays, Spectrum or Reradiation")

    def _matrix(self, matrix: Reradiation) -> dict:
        self._files += 1
        matrix._whole()
        file = os.path.join(self._folder, f"matrix-{self._files}.csv")
        matrix.write(file)
        return {"file": file}


@contextlib.contextmanager
def source(name: str, value: Any, folder: Optional[Any], root: Optional[str] = None) -> Iterator[Any]:
    """Yields the form in which the library takes a file name or a dict; it holds for as long as the
    context lasts. Relative paths in a dict start at `folder`, the working folder by default."""
    if isinstance(value, (str, os.PathLike)):
        yield _checks.path(name, value)
        return
    if not isinstance(value, Mapping):
        raise _checks.refuse(name, f"is a {type(value).__name__}", "give a file name or a dict")
    start = os.getcwd() if folder is None else _checks.path("folder", folder)
    if not os.path.isdir(start):
        raise _checks.refuse("folder", f"{start!r} is not a folder", "give one that exists")
    with tempfile.TemporaryDirectory(prefix="reradiant-") as temporary:
        plain = _Plain(temporary).value(value, name)
        if root is not None and root not in plain:
            plain = {root: plain}
        yield plain, os.path.join(start, f"<{name}>")
