"""Runs the command of a claim and reads its figures; says which of them hold."""

import contextlib
import copy
import io
import json
import math
import os
import re
import shutil
import statistics
import subprocess
import tempfile
import time

from document_tables import MAKERS
from documents import NUMBER, ROOT, cells_of

BUILD = os.environ.get("RERADIANT_BUILD", str(ROOT / "build"))


class NotRead(Exception):
    """A command that failed, or a figure that is not in what it gave."""


class Output:
    """What a command printed and wrote, with the seconds that it took."""

    def __init__(self, command):
        folder = tempfile.mkdtemp(prefix="claims-")
        environment = dict(os.environ, OUT=folder, RERADIANT_BUILD=BUILD, PYTHONDONTWRITEBYTECODE="1")
        # Commands name the program as the documents do; the build may lie elsewhere.
        command = re.sub(r"(?<![\w/])build/bin/", f"{BUILD}/bin/", command)
        begin = time.monotonic()
        run = subprocess.run(["bash", "-eu", "-o", "pipefail", "-c", command], cwd=ROOT, env=environment,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
        self.seconds = time.monotonic() - begin
        self.text = f"{run.stdout.rstrip()}\ntook {self.seconds:.1f} s\n"
        written = os.path.join(folder, "result.json")
        self.json = open(written).read() if os.path.exists(written) else run.stdout
        shutil.rmtree(folder)
        if run.returncode != 0:
            raise NotRead(f"the command ends with {run.returncode}: {(run.stderr or run.stdout)[-600:].strip()}")


    def through(self, maker):
        """What a maker of document_tables.py makes of the text; the text itself where none is named."""
        if not maker:
            return self
        made, other = io.StringIO(), copy.copy(self)
        with contextlib.redirect_stdout(made):
            MAKERS[maker](self.text)
        other.text = made.getvalue()
        return other


def number(text):
    return float(str(text).replace(",", ""))


def chosen(values, take):
    if take == "count":
        return float(len(values))
    if not values:
        raise NotRead("nothing matches")
    return {"first": lambda: values[0], "last": lambda: values[-1], "least": lambda: min(values),
            "most": lambda: max(values), "median": lambda: statistics.median(values),
            "sum": lambda: math.fsum(values)}[take]()


def matches(pattern, text, take):
    found = [match[1] if match.re.groups else "1" for match in re.finditer(pattern, text, re.MULTILINE)]
    return found if take == "count" else [number(value) for value in found]


def read_figure(figure, output):
    """Returns the number that the figure should show, in the document's unit."""
    if figure.file:
        values = matches(figure.pattern, (ROOT / figure.file).read_text(), figure.take)
    elif figure.output:
        values = matches(figure.output, output.text, figure.take)
    else:
        try:
            value = json.loads(output.json)
            for key in figure.json.split("."):
                value = value[int(key) if isinstance(value, list) else key]
        except (ValueError, KeyError, IndexError, TypeError) as error:
            raise NotRead(f"no {figure.json} in the JSON: {error!r}") from error
        values = [number(item) for item in (value if isinstance(value, list) else [value])]
    return figure.times * chosen(values, figure.take)


def last_digit(shown):
    """One unit of the last digit that is shown."""
    mantissa, _, exponent = shown.replace(",", "").lower().partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


def holds(shown, value, within="", bound=""):
    """Returns whether a figure that a document shows is true of the number that was read."""
    wanted = number(shown)
    if not math.isfinite(value):
        return False
    if bound:
        return value <= wanted if bound == "most" else value >= wanted
    if within.startswith("x"):
        factor = float(within[1:])
        return value * wanted > 0 and 1 / factor <= value / wanted <= factor or value == wanted
    if within.endswith("%"):
        return abs(value - wanted) <= 0.01 * float(within[:-1]) * abs(wanted) + 0.5 * last_digit(shown)
    return abs(value - wanted) <= (float(within) if within else 0.501 * last_digit(shown))


def written_like(shown, value):
    """The number with as many digits as are shown."""
    mantissa, mark, _ = shown.lower().partition("e")
    digits = len(mantissa.partition(".")[2])
    if mark:
        mantissa, _, exponent = f"{value:.{digits}e}".partition("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:,.{digits}f}" if "," in shown else f"{value:.{digits}f}"


def table_differences(claim, recorded, printed):
    """Returns a sentence for every cell of a table that is not as recorded, within its column's tolerance."""
    old, new = cells_of(recorded), cells_of(printed)
    if len(old) != len(new) or old[0] != new[0]:
        return [f"the table has {len(new)} rows of {new[0] if new else 'nothing'}, recorded are {len(old)} of {old[0]}"]
    differences = []
    for row, row_now in zip(old[1:], new[1:]):
        for heading, cell, cell_now in zip(old[0], row, row_now):
            within = claim.within.get(heading, claim.within.get("*", ""))
            if within != "any" and not cell_agrees(cell, cell_now, within):
                differences.append(f"{row[0]}, {heading}: recorded is '{cell}', the command gives '{cell_now}'")
    return differences


def cell_agrees(cell, cell_now, within):
    if re.sub(NUMBER, "#", cell) != re.sub(NUMBER, "#", cell_now):
        return False
    return all(holds(a, number(b), within) for a, b in zip(re.findall(NUMBER, cell), re.findall(NUMBER, cell_now)))
