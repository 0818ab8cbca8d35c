"""The examples of the docstrings."""

import doctest
import importlib
import pkgutil
import unittest

import reradiant


def load_tests(_loader, tests, _pattern):
    for module in pkgutil.iter_modules(reradiant.__path__, "reradiant."):
        if module.name != "reradiant._library":
            tests.addTests(doctest.DocTestSuite(importlib.import_module(module.name)))
    return tests


if __name__ == "__main__":
    unittest.main()
