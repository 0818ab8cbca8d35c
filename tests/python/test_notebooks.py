"""The notebooks of tools/examples run from their folder and show what they end their cells with."""

import ast
import json
import os
import unittest

from scenes import EXAMPLES


def show(value):
    """Asks the last value of a cell for its display form, as a notebook does."""
    for name in ("_repr_html_", "_repr_png_"):
        method = getattr(value, name, None)
        if method is not None and method() is not None:
            return
    repr(value)


def run(file):
    """The code cells in their order, in one namespace."""
    namespace = {"__name__": "__main__"}
    for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] != "code":
            continue
        tree = ast.parse("".join(cell["source"]), f"{file.name}:{cell['id']}")
        last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, f"{file.name}:{cell['id']}", "exec"), namespace)
        if last is not None:
            expression = compile(ast.Expression(last.value), f"{file.name}:{cell['id']}", "eval")
            show(eval(expression, namespace))


class Notebooks(unittest.TestCase):
    def setUp(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(EXAMPLES)

    def test_varnished_orange(self):
        run(EXAMPLES / "varnished-orange.ipynb")

    def test_material_study(self):
        run(EXAMPLES / "material-study.ipynb")

    def test_brightened_paper(self):
        run(EXAMPLES / "brightened-paper.ipynb")

    def test_notebooks_carry_no_outputs(self):
        for file in EXAMPLES.glob("*.ipynb"):
            for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
                self.assertFalse(cell.get("outputs"), file)


if __name__ == "__main__":
    unittest.main()
