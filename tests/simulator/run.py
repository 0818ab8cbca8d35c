"""Renders tiny scenes on Oclgrind, a simulator that watches every access of every work-item, and fails where it
finds a read or write outside of a buffer, a race, a value that was never written, or a wrong call of OpenCL.

    run.py --program reradiant --shim libwrite_shim.so [SCENE...]

Without scenes those of QUICK are run, with RERADIANT_FULL_TESTS all, which together must use every feature of the
kernels. Exits with 77 where the simulator is not installed."""

import argparse
import collections
import itertools
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import zlib

from scenes import QUICK, SCENES

NOT_INSTALLED = 77
DRIVERS = ("/usr/lib/oclgrind/liboclgrind-rt-icd.so", "/usr/local/lib/liboclgrind-rt-icd.so")
ENTRY = re.compile(r"^\S.*?(?=^\S|\Z)", re.MULTILINE | re.DOTALL)
# What the simulator says of the halves of a vector (y16.lo): their numbers are written, and seen to be so where the same
# vector is stored whole. Kernel and text of the instruction.
KNOWN = (("film", "vstore2"),)
DENSE = """# reradiation
# quantity: per-band
# orientation: rows-emission
nm,380,420,460,500,540,580,620,660,700
380,0.1,0,0,0,0,0,0,0,0
420,0.05,0.1,0,0,0,0,0,0,0
460,0.01,0.06,0.1,0,0,0,0,0,0
500,0.04,0.01,0.07,0.1,0,0,0,0,0
540,0.02,0.05,0.01,0.02,0.3,0,0,0,0
580,0.01,0.02,0.07,0.01,0.02,0.3,0,0,0
620,0.03,0.01,0.02,0.06,0.01,0.07,0.3,0,0
660,0.01,0.04,0.01,0.03,0.06,0.01,0.02,0.3,0
700,0.02,0.01,0.05,0.01,0.03,0.05,0.01,0.05,0.3
"""


def png(width, height):
    """An RGB picture with a different colour in every pixel."""
    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    rows = b"".join(b"\0" + bytes((40 * x + 90 * y + 60 * c) % 256 for x in range(width) for c in range(3))
                    for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def kernel_of(entry):
    found = re.search(r"Kernel: (\w+)", entry)
    return found[1] if found else "host"


def is_known(entry):
    return any(kernel_of(entry) == kernel and text in entry for kernel, text in KNOWN)


class Simulator:
    def __init__(self, program, shim, driver, folder):
        self.program, self.folder = program, folder
        (folder / "vendors").mkdir()
        (folder / "vendors" / "simulator.icd").write_text(driver + "\n")
        (folder / "dense.csv").write_text(DENSE)
        (folder / "image.png").write_bytes(png(4, 4))
        (folder / "lamp.obj").write_text("v -1 2.5 1\nv 0 2.5 1\nv 0 2.5 2\nv -1 2.5 2\nf 1 2 3\nf 1 3 4\n")
        # Optimised, some bit operations become ones that the simulator does not know.
        self.environment = os.environ | {
            "OCL_ICD_VENDORS": f"{folder / 'vendors'}/", "LD_PRELOAD": shim, "OCLGRIND_CHECK_API": "1",
            "OCLGRIND_UNINITIALIZED": "1", "OCLGRIND_DATA_RACES": "1", "OCLGRIND_MAX_ERRORS": "1000000",
            "OCLGRIND_BUILD_OPTIONS": "-cl-opt-disable", "OCLGRIND_LOG": str(folder / "log.txt")}

    def render(self, name, kind):
        """Findings of one scene on a device that calls itself a GPU or a CPU, and the features that it used."""
        text, options = SCENES[name]
        (self.folder / "scene.toml").write_text(text)
        (self.folder / "log.txt").unlink(missing_ok=True)
        samples = [] if "--spp" in options else ["--spp", "2"]
        with tempfile.TemporaryDirectory() as cache:  # what is kept there was built with optimisation
            environment = self.environment | {"XDG_CACHE_HOME": cache}
            if kind == "CPU":
                environment["RERADIANT_SIMULATED_CPU"] = "1"
            run = subprocess.run(
                [self.program, "render", "scene.toml", "-o", "out.exr", "--json", "out.json", "--quiet", *samples,
                 *options.split()], cwd=self.folder, env=environment, capture_output=True, text=True)
        log = self.folder / "log.txt"
        entries = [entry for entry in ENTRY.findall(log.read_text() if log.exists() else "") if not is_known(entry)]
        if run.returncode != 0:
            entries.append(f"the program ended with {run.returncode}: {run.stderr.strip()}")
            return entries, set()
        features = json.loads((self.folder / "out.json").read_text())["features"]
        return entries, {bit for bit, is_on in features.items() if is_on}


def summary(entries):
    kinds = collections.Counter(re.sub(r" (at|to|from) .*", "", entry.splitlines()[0]) + f" ({kernel_of(entry)})"
                                for entry in entries)
    return "; ".join(f"{count} x {kind}" for kind, count in kinds.items()) or "nothing"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--shim", required=True)
    parser.add_argument("scenes", nargs="*")
    arguments = parser.parse_args()
    driver = next((one for one in DRIVERS if pathlib.Path(one).exists()), None)
    if driver is None:
        print("SKIPPED: Oclgrind is not installed (the package oclgrind)")
        return NOT_INSTALLED
    is_full = "RERADIANT_FULL_TESTS" in os.environ
    names = arguments.scenes or (list(SCENES) if is_full else QUICK)
    failed, used, every = 0, set(), set()
    print("| scene | kernels for a | found | seconds |\n| --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as folder:
        simulator = Simulator(os.path.abspath(arguments.program), os.path.abspath(arguments.shim), driver,
                              pathlib.Path(folder))
        for name, kind in itertools.product(names, ("GPU", "CPU")):
            start = time.time()
            entries, features = simulator.render(name, kind)
            failed += bool(entries)
            used |= features if name != "all features" else set()
            every |= features
            print(f"| {name} | {kind} | {summary(entries)} | {time.time() - start:.1f} |", flush=True)
            for entry in entries[:3]:
                print(entry, file=sys.stderr)
    unused = every - used
    if unused and not arguments.scenes and is_full:
        print(f"No scene uses {', '.join(sorted(unused))}")
        failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
