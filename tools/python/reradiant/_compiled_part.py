"""The compiled part of the package: loaded, or an ImportError that names the command that makes it."""

from __future__ import annotations

import importlib
import importlib.machinery
import pathlib
import sys
from types import ModuleType
from typing import Sequence, Tuple

REMEDY = ("in a checkout `tools/build release python` builds it into build/python (for PYTHONPATH), and "
          "`pip install ./tools/python` into the environment of the interpreter that runs pip")


def require_numpy() -> str:
    """The version of numpy; ImportError where there is none."""
    try:
        import numpy
    except ImportError as error:
        raise ImportError(f"reradiant needs numpy, which {sys.executable} does not have ({error}); "
                          f"`apt install python3-numpy` brings it for /usr/bin/python3, `pip install "
                          f"numpy` for an environment") from error
    return numpy.__version__


def require_built(folder: pathlib.Path,
                  suffixes: Sequence[str] = tuple(importlib.machinery.EXTENSION_SUFFIXES)) -> None:
    """ImportError unless the folder holds a compiled part that ends as this interpreter's do."""
    built = sorted(file.name for file in folder.glob("_library.*") if file.suffix in (".so", ".pyd"))
    if any("_library" + suffix in built for suffix in suffixes):
        return
    if not built:
        raise ImportError(f"the compiled part of reradiant is not in {folder}: {REMEDY}")
    version = ".".join(map(str, sys.version_info[:2]))
    raise ImportError(f"the compiled part of reradiant, {folder / built[0]}, is for another interpreter "
                      f"than Python {version} ({sys.executable}): start the one that its name tells, or "
                      f"build it for this one: {REMEDY}")


def require_numpy_of(pybind11: Tuple[int, int], numpy_version: str) -> None:
    """Raises ImportError where a module built with this pybind11 would crash on its first array.

    pybind11 knows the binary interface of numpy 2 from its version 2.12 on.
    """
    if int(numpy_version.split(".")[0]) >= 2 and pybind11 < (2, 12):
        built_with = ".".join(map(str, pybind11))
        raise ImportError(f"this module was built with pybind11 {built_with}, which knows numpy 1 and not "
                          f"{numpy_version}; use an interpreter with numpy 1, or pip install ./tools/python")


def load_compiled_part() -> ModuleType:
    """The module `reradiant._library`; ImportError that says what is missing and what makes it."""
    numpy_version = require_numpy()
    require_built(pathlib.Path(__file__).parent)
    try:
        library = importlib.import_module("reradiant._library")
    except ImportError as error:
        raise ImportError(f"the compiled part of reradiant does not load: {error}; tools/setup installs "
                          f"the libraries that it needs; {REMEDY}") from error
    require_numpy_of(library.pybind11_version, numpy_version)
    return library
