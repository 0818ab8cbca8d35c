"""Plots that notebooks show without another package."""

from __future__ import annotations

from typing import Any, Mapping

from . import _checks, _library


class Plot:
    """Curves over common axes as an SVG, which a notebook shows.

    Parameters
    ----------
    curves : dict of name and (x, y)
        Numbers of the same length; where one is NaN, the curve has a gap.
    title, x, y : str
        What stands above the plot and beside its axes.
    log_x, log_y : bool
        Logarithmic axes, on which values up to 0 are gaps.

    Raises
    ------
    InputError
        For curves whose x and y differ in length.

    Examples
    --------
    >>> Plot({"grey": ([400, 700], [0.2, 0.2])}, x="wavelength / nm").svg[:4]
    '<svg'
    """

    def __init__(self, curves: Mapping[str, Any], *, title: str = "", x: str = "", y: str = "",
                 log_x: bool = False, log_y: bool = False) -> None:
        if not isinstance(curves, Mapping) or not curves:
            raise _checks.refuse("curves", f"is {curves!r}", "give a dict of name and (x, y)")
        series = []
        for name, pair in curves.items():
            what = f"curves[{name!r}]"
            if not isinstance(pair, (tuple, list)) or len(pair) != 2:
                raise _checks.refuse(what, "is no pair", "give (x, y)")
            numbers = [_checks.array(what, given, 1, gaps=True) for given in pair]
            if numbers[0].size != numbers[1].size:
                raise _checks.refuse(what, f"has {numbers[0].size} x and {numbers[1].size} y",
                                     "give one y for each x")
            series.append((_checks.text("curves", name), *numbers))
        self.svg: str = _library.line_plot(
            _checks.text("title", title), _checks.text("x", x), _checks.text("y", y),
            _checks.flag("log_x", log_x), _checks.flag("log_y", log_y), series)

    def write(self, file: Any) -> None:
        """Writes the SVG."""
        with open(_checks.path("file", file), "w", encoding="utf-8") as stream:
            stream.write(self.svg)

    def _repr_html_(self) -> str:
        return self.svg
