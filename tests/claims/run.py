"""Runs the figures of the documents; see tools/claims and claim_list.py.

    run.py [--quick | --documents] [--write] [NAME...]
"""

import argparse
import datetime
import difflib
import fnmatch
import os
import re
import subprocess
import sys
import time

import claim_list
from documents import DOCUMENTS, ROOT, find_table, find_text, line_of, uncovered
from readings import BUILD, NotRead, Output, holds, read_figure, table_differences, written_like


def parse():
    parser = argparse.ArgumentParser(prog="tools/claims", description="Runs the commands of the documents' figures "
                                     "and compares; names may hold * and ?. Exits with 1 where a figure does not hold.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these; default: all")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--quick", action="store_true", help="only those that take at most "
                       f"{claim_list.QUICK_SECONDS} s")
    which.add_argument("--documents", action="store_true", help="run nothing: compare the documents with the list")
    parser.add_argument("--write", action="store_true", help="write what the commands give into list and documents")
    parser.add_argument("--list", action="store_true", help="print names, seconds and commands")
    return parser.parse_args()


class Documents:
    """The texts of the documents, read once and written back where they changed."""

    def __init__(self, names=DOCUMENTS):
        self.texts = {name: (ROOT / name).read_text() for name in names}

    def replace(self, name, begin, end, new):
        text = self.texts[name]
        self.texts[name] = text[:begin] + new + text[end:]

    def write(self):
        for name, text in self.texts.items():
            if (ROOT / name).read_text() != text:
                (ROOT / name).write_text(text)

    def spans_of(self, entry):
        """Where a claim, a table or a plain entry stands."""
        text = self.texts[entry.document]
        if entry.header:
            return find_table(text, entry.header)
        return [(found.begin, found.end) for found in find_text(text, entry.text)]


def document_faults(claim, documents):
    """Returns a sentence for every way in which the document is not what the list says."""
    text = documents.texts[claim.document]
    spans = documents.spans_of(claim)
    if len(spans) != 1:
        return [f"{claim.document}: its {'table' if claim.header else 'words'} stand there {len(spans)} times, "
                f"not once: {claim.header or claim.text}"]
    if claim.header:
        return table_faults(claim, text, *spans[0])
    faults = []
    for figure, (begin, end) in zip(claim.figures, find_text(text, claim.text)[0].figures):
        if text[begin:end] != figure.shown:
            faults.append(f"{claim.document}:{line_of(text, begin)}: shows {text[begin:end]}, "
                          f"the list has {figure.shown}")
    return faults


def table_faults(claim, text, begin, end):
    if not claim.record.exists():
        return [f"{claim.record.name} is not there; tools/claims --write {claim.name} makes it"]
    shown, recorded = text[begin:end].splitlines(), claim.record.read_text().splitlines()
    line = line_of(text, begin)
    if len(shown) != len(recorded):
        changes = [change for change in difflib.ndiff(recorded, shown) if change[0] in "+-"]
        return ["\n    ".join([f"{claim.document}:{line}: shows {len(shown)} lines, recorded are {len(recorded)}",
                               *changes])]
    return [f"{claim.document}:{line + k}: shows\n    {a}\n  recorded is\n    {b}"
            for k, (a, b) in enumerate(zip(shown, recorded)) if a != b]


def run_faults(claim, output):
    """Returns a sentence for every figure that the command does not give."""
    if claim.header:
        if not claim.record.exists():
            return [f"{claim.record.name} is not there; tools/claims --write {claim.name} makes it"]
        return table_differences(claim, claim.record.read_text(), table_of(claim, output))
    faults = []
    for figure in claim.figures:
        value = read_figure(figure, output)
        if not holds(figure.shown, value, figure.within, figure.bound):
            kind = {"": figure.within or "last digit", "most": "at most", "least": "at least"}[figure.bound]
            faults.append(f"the list has {figure.shown} ({kind}), the command gives {value:.6g}")
    return faults


def table_of(claim, output):
    tables = find_table(output.text, claim.header)
    if len(tables) != 1:
        raise NotRead(f"prints {len(tables)} tables that begin with {claim.header}")
    return output.text[slice(*tables[0])]


def take_in(claim, output):
    """Writes what a command gave into the list: into its `shown` and `recorded`, or the record of a table."""
    if claim.header:
        claim.record.parent.mkdir(exist_ok=True)
        claim.record.write_text(table_of(claim, output))
    text = claim.source.read_text()
    begin = text.index(f'name = "{claim.name}"\n')
    end = text.find("\n[[", begin)
    entry = text[begin:end if end > 0 else len(text)]
    new_entry = re.sub(r'^recorded = ".*"$', f'recorded = "{datetime.date.today()}"', entry, flags=re.MULTILINE)
    for figure in claim.figures:
        value = read_figure(figure, output)
        if not figure.bound and not holds(figure.shown, value):
            new = written_like(figure.shown, value)
            new_entry = new_entry.replace(f'shown = "{figure.shown}"', f'shown = "\0{new}"', 1)
            figure.shown = new
        else:
            new_entry = new_entry.replace(f'shown = "{figure.shown}"', f'shown = "\0{figure.shown}"', 1)
    claim.source.write_text(text.replace(entry, new_entry.replace("\0", "")))


def rewrite(claim, documents):
    """Makes the document show what the list has."""
    text = documents.texts[claim.document]
    if claim.header:
        spans = find_table(text, claim.header)
        if len(spans) == 1 and claim.record.exists():
            documents.replace(claim.document, *spans[0], claim.record.read_text())
        return
    places = find_text(text, claim.text)
    if len(places) == 1:
        for figure, (begin, end) in reversed(list(zip(claim.figures, places[0].figures))):
            documents.replace(claim.document, begin, end, figure.shown)


def uncovered_faults(claims, plain, documents):
    """Returns a sentence for every figure that no entry covers, and for plain words that are not there."""
    faults = []
    for entry in plain:
        if not documents.spans_of(entry):
            faults.append(f"{entry.document}: the plain words are not there: {entry.header or entry.text}")
    for name, text in documents.texts.items():
        spans = [span for entry in claims + plain if entry.document == name for span in documents.spans_of(entry)]
        faults += [f"{name}:{line}: no claim covers {figure}" for line, figure in uncovered(text, spans)]
    return faults


def is_possible(claim):
    if not claim.requires:
        return True
    return subprocess.run(["bash", "-c", claim.requires], cwd=ROOT, capture_output=True,
                          env=dict(os.environ, RERADIANT_BUILD=BUILD)).returncode == 0


class Runner:
    """Runs claims in order; those of one command share its output."""

    def __init__(self, options):
        self.options, self.outputs, self.failed, self.skipped, self.held = options, {}, [], [], 0

    def output_of(self, command):
        if command not in self.outputs:
            try:
                self.outputs[command] = Output(command)
            except NotRead as error:
                self.outputs[command] = error
        if isinstance(self.outputs[command], NotRead):
            raise self.outputs[command]
        return self.outputs[command]

    def run(self, claim, command):
        if not is_possible(claim):
            self.skipped.append(claim.name)
            print(f"SKIP {claim.name}: not here: {claim.requires}", flush=True)
            return
        known = command in self.outputs
        try:
            output = self.output_of(command).through(claim.through)
            if self.options.write:
                take_in(claim, output)
            faults = run_faults(claim, output)
        except NotRead as error:
            faults = [str(error)]
        seconds = 0.0 if known or faults and not isinstance(self.outputs[command], Output) \
            else output.seconds
        self.held += not faults
        print(f"{'FAIL' if faults else 'ok  '} {claim.name}: {seconds:.1f} s", *faults, sep="\n  ", flush=True)
        if faults:
            self.failed.append(claim.name)


def chosen(claims, options):
    unknown = [name for name in options.names if not fnmatch.filter([claim.name for claim in claims], name)]
    if unknown:
        sys.exit(f"tools/claims: no figure is called {', '.join(unknown)}; tools/claims --list says the names")
    return [claim for claim in claims if not options.names or
            any(fnmatch.fnmatch(claim.name, name) for name in options.names)]


def run_commands(claims, options):
    """Returns the runner after all commands that were asked for; a full run of the tests takes all for --quick."""
    runner = Runner(options)
    quick = options.quick and "RERADIANT_FULL_TESTS" not in os.environ
    if not options.documents:
        for claim in claims:
            if claim.is_quick or claim.is_of_suite or not quick and claim.command:
                runner.run(claim, "" if quick and claim.is_of_suite else claim.command)
    return runner


def main():
    options = parse()
    claims, plain = claim_list.load()
    wanted = chosen(claims, options)
    if options.list:
        for claim in wanted:
            print(f"{claim.name:32} {claim.seconds:6.0f} s  {claim.command or 'kept: ' + claim.kept}")
        return 0
    begin = time.monotonic()
    runner = run_commands(wanted, options)
    documents = Documents()
    if options.write:
        for claim in wanted:
            rewrite(claim, documents)
        documents.write()
    faults = [f"{claim.name}: {fault}" for claim in wanted for fault in document_faults(claim, documents)]
    if not options.names:
        faults += uncovered_faults(claims, plain, documents)
    print(*faults, sep="\n")
    kept = sum(1 for claim in wanted if claim.kept)
    print(f"{len(wanted)} entries: {runner.held} of {runner.held + len(runner.failed)} that were run hold, "
          f"{len(runner.skipped)} cannot be run here, {kept} are kept; {len(faults)} faults of documents; "
          f"{time.monotonic() - begin:.0f} s")
    return 1 if faults or runner.failed else 0


if __name__ == "__main__":
    sys.exit(main())
