"""The list of the documents' figures: what each says, where, and the command that gives it.

A file of list/ holds entries of three kinds.

[[claim]], figures in a sentence or a row:
    name      by which `tools/claims NAME` runs it
    document  path from the checkout
    text      the words of the document, a `{}` for every figure; line breaks do not matter
    figures   for every `{}` in order: shown = "0.596", and what is read
    command   a bash command line, run in the checkout; $OUT is a folder that goes afterwards
    through   a maker of document_tables.py that makes the document's form of what the command prints
    seconds   that it takes; those of at most 20 are run by every `tools/test`
    machine   true where the figure is of a machine (seconds, their ratios, bytes)
    recorded  when the figures were read; needed where machine is true
    requires  a command that fails where the claim cannot be run here; $RERADIANT_BUILD is the build folder
    kept      in place of command: why the figure cannot be had again

A figure is read from what the command prints (output = regular expression with one group; a last line `took N s` is
added), from JSON that it
prints or writes to $OUT/result.json (json = "key.key"), or from a file of the checkout (file = path, pattern =
regular expression), such as the bound in a test that the command runs. take = "first", "last", "least", "most",
"median", "sum" or "count" chooses among several, times scales the number to the document's unit. The document's
figure holds where the number read lies within = "0.01", "5 %" or "x2" (a factor; the default is half a unit of the last
digit shown), or where bound = "most" or "least" says that it must not be above or below.

[[table]], a whole table: name, document, command, through, seconds, machine, recorded, requires, kept likewise, and
    header    the beginning of its first line in the document
    within    by heading: tolerances as above; "any" leaves a column unchecked
The command prints the table in the document's form; what it printed last is kept in tables/NAME.md.

[[plain]], numbers that are no measurement: document, text (or header of a table), why.
"""

import pathlib
import tomllib
from dataclasses import dataclass, field

HERE = pathlib.Path(__file__).resolve().parent
QUICK_SECONDS = 20
TAKES = ("first", "last", "least", "most", "median", "sum", "count")


@dataclass
class Figure:
    shown: str
    output: str = ""
    json: str = ""
    file: str = ""
    pattern: str = ""
    take: str = "first"
    times: float = 1.0
    within: str = ""
    bound: str = ""


@dataclass
class Claim:
    """A [[claim]] or, where it has a header, a [[table]]."""

    name: str
    document: str
    source: pathlib.Path
    text: str = ""
    header: str = ""
    figures: list = field(default_factory=list)
    command: str = ""
    kept: str = ""
    through: str = ""
    seconds: float = 0.0
    machine: bool = False
    recorded: str = ""
    requires: str = ""
    within: dict = field(default_factory=dict)

    @property
    def is_quick(self):
        return bool(self.command) and self.seconds <= QUICK_SECONDS

    @property
    def is_of_suite(self):
        """Whether the command runs tests that the suite has: a quick run reads their bounds alone."""
        return "build/bin/test_" in self.command and all(figure.file for figure in self.figures)

    @property
    def record(self):
        """The table as its command printed it last."""
        return HERE / "tables" / f"{self.name}.md"


@dataclass
class Plain:
    document: str
    why: str
    text: str = ""
    header: str = ""


class WrongList(Exception):
    """An entry that is not as the list wants it."""


def claim_of(entry, source):
    figures = [Figure(**figure) for figure in entry.pop("figures", [])]
    claim = Claim(source=source, figures=figures, **entry)

    def want(holds, what):
        if not holds:
            raise WrongList(f"{source.name}: {claim.name}: {what}")

    want(bool(claim.command) != bool(claim.kept), "has either a command or a reason why it is kept")
    want(bool(claim.text) != bool(claim.header), "has either a text or the header of a table")
    want(claim.text.count("{}") == len(figures), "has as many figures as there are {} in its text")
    want(not claim.command or claim.seconds > 0, "says its seconds")
    want(claim.recorded or not (claim.machine or claim.kept), "says when it was recorded")
    for figure in figures:
        sources = [bool(figure.output), bool(figure.json), bool(figure.file and figure.pattern)]
        want(sum(sources) == (0 if claim.kept else 1), f"reads {figure.shown} from one source")
        want(figure.take in TAKES and figure.bound in ("", "most", "least"), f"has an unknown word at {figure.shown}")
    return claim


def load(folder=HERE / "list"):
    """Returns claims (tables among them) and plain entries. WrongList for what is wrong in one."""
    claims, plain = [], []
    for file in sorted(folder.glob("*.toml")):
        try:
            content = tomllib.loads(file.read_text())
            for entry in content.get("claim", []) + content.get("table", []):
                claims.append(claim_of(dict(entry), file))
            plain += [Plain(**entry) for entry in content.get("plain", [])]
        except (tomllib.TOMLDecodeError, TypeError) as error:
            raise WrongList(f"{file.name}: {error}") from error
    names = [claim.name for claim in claims]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise WrongList(f"names stand twice: {', '.join(twice)}")
    return claims, plain
