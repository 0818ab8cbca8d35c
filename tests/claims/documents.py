"""What the documents show: the words and figures of a claim, tables, and numbers that no claim covers."""

import pathlib
import re
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ["README.md", "host/README.md", "kernels/README.md", "spectra/README.md", "tests/README.md",
             "tools/bench/README.md",
             *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "tools/docs").glob("*.md"))]
NUMBER = r"[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?"
# What looks measured: digits behind a point, powers of ten, and whole numbers of what is measured.
MEASURED = re.compile(r"(?<![\w./:`@-])[-+]?(?:\d+\.\d+(?:e-?\d+)?|\d+e-?\d+|\d+(?:,\d{3})+|\d+(?= ?(?:%|times\b|s\b|"
                      r"seconds?\b|minutes?\b|hours?\b|million\b|thousand\b|[GM]i?B\b|KiB\b)))(?![\w])")
CODE = re.compile(r"^```.*?^```$|`[^`\n]*`|\]\([^)]*\)|<!--.*?-->", re.MULTILINE | re.DOTALL)


@dataclass
class Found:
    """Where a claim stands in a document: begin and end of the whole, and of every figure."""

    begin: int
    end: int
    figures: list


def pattern_of(text):
    words = [NUMBER.join(["(", ")"]) if part == "{}" else re.escape(part)
             for part in re.split(r"(\{\})", " ".join(text.split()))]
    return re.compile(r"\s+".join("".join(words).split(r"\ ")))


def find_text(document, text):
    """Returns every place where the words of a claim stand, whatever its figures."""
    return [Found(match.start(), match.end(), [match.span(k + 1) for k in range(match.re.groups)])
            for match in pattern_of(text).finditer(document)]


def find_table(document, header):
    """Returns begin and end of every table whose first line begins like that."""
    return [match.span() for match in
            re.finditer(rf"^{re.escape(header)}[^\n]*\n(?:\|[^\n]*\n)+", document, re.MULTILINE)]


def line_of(document, offset):
    return document.count("\n", 0, offset) + 1


def cells_of(table):
    """Rows of cells; the line of dashes is left out."""
    rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in table.strip().splitlines()]
    return [row for row in rows if not all(set(cell) <= set("-: ") and cell for cell in row)]


def uncovered(document, spans):
    """Returns line and text of every number that looks measured and stands in none of the spans, nor in code."""
    spans = spans + [match.span() for match in CODE.finditer(document)]
    return [(line_of(document, match.start()), match[0]) for match in MEASURED.finditer(document)
            if not any(begin <= match.start() < end for begin, end in spans)]
