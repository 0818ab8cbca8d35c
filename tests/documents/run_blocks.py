"""Runs the code blocks of a Markdown document as its reader would, and compares what they print.

    run_blocks.py DOCUMENT FOLDER

Blocks marked ```sh go to one bash, in order, so that folders and variables hold from block to block;
```python blocks each get an interpreter of their own. All start in FOLDER, which is made anew: it shows
the checkout by links, and what the blocks write stays in it. A ```text block directly behind a block
is what that prints: `...` stands for any text, alone in a line for any lines; numbers agree to one
unit of their last digit or 1 %, whichever is more, and seconds and speeds are any number. Lines of progress, which
only a slow machine shows, do not count.

A comment before a block says why it is not run (`<!-- not run: REASON -->`), or that only the full run,
with RERADIANT_FULL_TESTS set, does it (`<!-- full run: REASON -->`). Both are printed.

Environment: RERADIANT_BUILD is the build folder, RERADIANT_PYTHON the interpreter of its module. Ends
with 1 where a block fails, prints something else, or writes into the checkout.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
FENCE = re.compile(r"^```(\w*)\s*$")
REMARK = re.compile(r"^<!-- (not run|full run): (.+) -->$")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
DEPENDS_ON_MACHINE = re.compile(r"^ ?(?:s|seconds?|min|minutes?|(?:million )?paths/s|[MG]B)\b")
PROGRESS = re.compile(r"; about .+ to go$")
MARK = "@@ block {} @@"


@dataclass
class Block:
    """A block of code: where its fence stands, what it runs in, and what it shows below."""

    line: int
    language: str
    code: list = field(default_factory=list)
    shown: list | None = None
    remark: tuple | None = None

    @property
    def is_run(self):
        kind = self.remark[0] if self.remark else None
        return kind is None or (kind == "full run" and "RERADIANT_FULL_TESTS" in os.environ)


def blocks_of(document):
    """Blocks of `sh` and `python` in order, each with the `text` that follows it."""
    blocks, remark, lines = [], None, enumerate(document.read_text().splitlines(), 1)
    for number, line in lines:
        fence = FENCE.match(line)
        if not fence:
            remark = (m := REMARK.match(line)) and m.groups() or (remark if not line else None)
            continue
        body = []
        for _, inner in lines:
            if inner.startswith("```"):
                break
            body.append(inner)
        if fence[1] in ("sh", "python"):
            blocks.append(Block(number, fence[1], body, None, remark))
        elif fence[1] == "text" and blocks and blocks[-1].shown is None:
            blocks[-1].shown = body
        remark = None
    return blocks


def script_of(blocks):
    """One bash script: a line marks where the output of each block begins."""
    parts = ["set -eu -o pipefail"]
    for index, block in enumerate(blocks):
        parts.append(f"echo '{MARK.format(index)}'")
        code = "\n".join(block.code)
        if block.language == "python":
            code = f"\"$RERADIANT_PYTHON\" -B - <<'END OF PYTHON'\n{code}\nEND OF PYTHON"
        parts.append(code)
    return "\n".join(parts) + "\n"


def numbers_agree(shown, printed, behind):
    if DEPENDS_ON_MACHINE.match(behind):
        return True
    mantissa, _, exponent = shown.lower().partition("e")
    decimals = len(mantissa.partition(".")[2]) - int(exponent or 0)
    return abs(float(shown) - float(printed)) <= max(1.001 * 10.0**-decimals if "." in shown else 0.0,
                                                     0.01 * abs(float(shown)))


def line_agrees(shown, printed):
    """Returns whether a line is as shown, but for `...`, the last digits of numbers and the width of gaps."""
    shown, printed = " ".join(shown.split()), " ".join(printed.split())
    tokens = list(re.finditer(rf"\.\.\.|{NUMBER.pattern}|.", shown))
    pattern = "".join(".*" if t[0] == "..." else f"({NUMBER.pattern})" if NUMBER.fullmatch(t[0])
                      else re.escape(t[0]) for t in tokens)
    match = re.fullmatch(pattern, printed)
    numbers = [t for t in tokens if NUMBER.fullmatch(t[0])]
    return bool(match) and all(numbers_agree(n[0], value, shown[n.end():])
                               for n, value in zip(numbers, match.groups()))


def agrees(shown, printed):
    """Returns whether lines are as shown; a line `...` stands for any number of them."""
    if not shown:
        return not printed
    if shown[0].strip() == "...":
        return any(agrees(shown[1:], printed[skipped:]) for skipped in range(len(printed) + 1))
    return bool(printed) and line_agrees(shown[0], printed[0]) and agrees(shown[1:], printed[1:])


def files_of_checkout():
    """Every file but what lies in folders that are built."""
    built = {CHECKOUT / "build", CHECKOUT / ".git", pathlib.Path(os.environ["RERADIANT_BUILD"]).resolve()}
    found = set()
    for folder, folders, files in os.walk(CHECKOUT):
        folders[:] = [f for f in folders
                      if pathlib.Path(folder, f) not in built and f != "__pycache__"]
        found.update(os.path.join(folder, file) for file in files)
    return found


def make_folder(folder):
    """The scratch folder, with links to what lies at the top of the checkout."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for entry in CHECKOUT.iterdir():
        if not entry.name.startswith(".") and entry.name != "build":
            (folder / entry.name).symlink_to(entry)
    (folder / "build").symlink_to(os.environ["RERADIANT_BUILD"])


def environment_of(folder):
    """Home is the scratch folder's, but kernels that were compiled before are found again."""
    environment = dict(os.environ, HOME=str(folder / "home"))
    caches = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache"))
    environment.update(XDG_CACHE_HOME=str(caches),
                       PYTHONPATH=os.path.join(os.environ["RERADIANT_BUILD"], "python"))
    (folder / "home").mkdir()
    return environment


def outputs_of(blocks, folder):
    """Returns the lines that each block printed, up to the one that failed, and the exit status."""
    run = subprocess.run(["bash"], input=script_of(blocks), cwd=folder, env=environment_of(folder),
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    parts = re.split(r"^@@ block \d+ @@\n", run.stdout, flags=re.MULTILINE)
    return [[line for line in part.splitlines() if not PROGRESS.search(line)] for part in parts[1:]], run.returncode


def main():
    document, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    blocks = blocks_of(document)
    for block in blocks:
        if not block.is_run:
            print(f"{document.name}:{block.line}: not run here: {block.remark[1]}")
    blocks = [block for block in blocks if block.is_run]
    make_folder(folder)
    before = files_of_checkout()
    outputs, status = outputs_of(blocks, folder)
    failures = 0
    for block, output in zip(blocks, outputs):
        if block is blocks[len(outputs) - 1] and status != 0:
            failures += 1
            print(f"{document}:{block.line}: failed with {status}, having printed:", *output, sep="\n  ")
        elif block.shown is not None and not agrees(block.shown, output):
            failures += 1
            print(f"{document}:{block.line}: does not print what is shown, but:", *output, sep="\n  ")
    left = sorted(files_of_checkout() - before)
    if left:
        failures += 1
        print(f"{document}: its blocks wrote into the checkout:", *left, sep="\n  ")
    print(f"{document.name}: {len(outputs)} blocks run, {failures} failures")
    return 1 if failures or not outputs else 0


if __name__ == "__main__":
    sys.exit(main())
