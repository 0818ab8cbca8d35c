"""The code that the tests of faults share: running the program, judging what it left behind, rows of
the table."""

import dataclasses
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import tempfile
import time

SCENE = """[film]
width = {width}
height = {height}
[camera]
origin = [0, 0, 3]
target = [0, 0, 0]
[[light]]
type = "environment"
radiance = 1.0
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 1
material = "grey"
[[material]]
name = "grey"
[material.substrate]
type = "lambert"
reflectance = 0.5
"""

RECIPE = """[[fluorophore]]
absorptance = 0.45
quantum_yield = 0.8
excitation = { peak_nm = 450, width_nm = 60 }
mirror = true
stokes_shift_nm = 60
[noise]
read_of_peak = 0.01
"""

NOBODY = 65534


@dataclasses.dataclass
class Row:
    """A fault: how often it was tried, the most seconds of work it cost, and what it damaged."""

    fault: str
    tries: int
    lost_seconds: float
    corrupted: int
    outcome: str


class Unexpected(Exception):
    """The program did something else than the contract says."""


@dataclasses.dataclass
class Result:
    code: int
    output: str
    errors: str


SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Bench:
    """The program under test and a scratch folder."""

    def __init__(self, program, shim, full):
        self.shim, self.full = pathlib.Path(shim).resolve(), full
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="reradiant-faults-"))
        self.root.chmod(0o755)
        # Some runs are those of another user, whom a home may keep out of the checkout: he has a
        # program and data of his own, laid out as an installation is.
        self.program = self.root / "bin" / "reradiant"
        self.program.parent.mkdir()
        shutil.copy(program, self.program)
        for data in ("kernels", "spectra"):
            shutil.copytree(SOURCE / data, self.root / "share" / "reradiant" / data)
        for copied in self.root.rglob("*"): # whatever the umask
            copied.chmod(0o755 if copied.is_dir() or copied == self.program else 0o644)
        self.cache = self.root / "cache"
        self.folders = 0

    def close(self):
        shutil.rmtree(self.root, ignore_errors=True)

    def folder(self, width=8, height=6):
        """A new folder with a small scene and a recipe."""
        self.folders += 1
        folder = self.root / str(self.folders)
        folder.mkdir()
        (folder / "scene.toml").write_text(SCENE.format(width=width, height=height))
        (folder / "recipe.toml").write_text(RECIPE)
        return folder

    def start(self, folder, arguments, environment=None, limits=(), user=None):
        """Starts the program; `limits` are pairs for setrlimit."""

        def prepare():
            # A write beyond RLIMIT_FSIZE shall fail, as on a full disk, not kill.
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            for which, most in limits:
                resource.setrlimit(which, (most, most))
            if user is not None:
                os.setgid(user)
                os.setuid(user)

        variables = {**os.environ, "RERADIANT_CACHE": str(self.cache), **(environment or {})}
        variables.pop("RERADIANT_DEVICE", None)
        return subprocess.Popen([self.program, *arguments.split()], cwd=folder, env=variables,
                                preexec_fn=prepare, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, errors="replace")

    def run(self, folder, arguments, environment=None, limits=(), user=None, seconds=120):
        process = self.start(folder, arguments, environment, limits, user)
        try:
            output, errors = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired as hang:
            process.kill()
            process.wait()
            raise Unexpected(f"{arguments} hung for {seconds} s") from hang
        return Result(process.returncode, output, errors)

    def run_well(self, folder, arguments, environment=None):
        result = self.run(folder, arguments, environment)
        if result.code != 0:
            raise Unexpected(f"{arguments} ended with {result.code}: {result.errors}")
        return result

    def preloaded(self, **faults):
        return {"LD_PRELOAD": str(self.shim), **{k: str(v) for k, v in faults.items()}}


def expect(result, codes, arguments):
    if result.code not in codes:
        raise Unexpected(f"{arguments} ended with {result.code}: {result.errors[-500:]}")


def leftovers(folder):
    """Temporary files that a run left (host/base/atomic_file.h names them)."""
    return [file.name for file in folder.rglob(".*.partial*")]


def count_corrupted(file, good):
    """1 unless the file is absent or one of the byte strings that it may be."""
    return 0 if not file.exists() or file.read_bytes() in good else 1


def seconds_of(work):
    start = time.monotonic()
    work()
    return time.monotonic() - start
