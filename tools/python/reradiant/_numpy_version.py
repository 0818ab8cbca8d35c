"""Which numpy the module can work with."""

from __future__ import annotations

from typing import Tuple

import numpy


def require_numpy_of(pybind11: Tuple[int, int], numpy_version: str = numpy.__version__) -> None:
    """Raises ImportError where a module built with this pybind11 would crash on its first array.

    pybind11 knows the binary interface of numpy 2 from its version 2.12 on.
    """
    if int(numpy_version.split(".")[0]) >= 2 and pybind11 < (2, 12):
        built_with = ".".join(map(str, pybind11))
        raise ImportError(f"this module was built with pybind11 {built_with}, which knows numpy 1 and not "
                          f"{numpy_version}; use an interpreter with numpy 1, or pip install ./tools/python")
