"""Processes that are killed, that share files, and that speak another language."""

import json
import os
import pathlib
import random
import signal
import subprocess
import time

from harness import Row, Unexpected, count_corrupted, expect, leftovers

ENDLESS = "render scene.toml -o out.exr --spp 100000000 --checkpoint 0.05 --quiet"
RESUMED = "render scene.toml -o copy.exr --resume --time 0.001 --json copy.json --quiet"


def seconds_to_first(bench, folder, checkpoint):
    """From the start to the first checkpoint."""
    process = bench.start(folder, ENDLESS)
    start = time.monotonic()
    while not checkpoint.exists() and process.poll() is None:
        time.sleep(0.01)
    process.kill()
    process.communicate()
    return time.monotonic() - start


def kill_nine(bench):
    """Kills while checkpoints are written all the time; what is left must load."""
    folder = bench.folder(32, 24)
    bench.run_well(folder, "render scene.toml -o warm.exr --spp 1 --quiet")
    dice = random.Random(8)
    tries = 200 if bench.full else 4
    lost, corrupted, resumed = 0.0, 0, 0
    checkpoint = folder / "out.exr.checkpoint"
    first = seconds_to_first(bench, folder, checkpoint)
    for _ in range(tries):
        process = bench.start(folder, ENDLESS + " --resume")
        started = time.time()
        time.sleep(dice.uniform(0.1 * first, 2.0 * first))
        process.send_signal(signal.SIGKILL)
        killed = time.time()
        process.communicate()
        if (folder / "out.exr").exists():
            raise Unexpected("a killed render left an image")
        if not checkpoint.exists():
            lost = max(lost, killed - started)
            continue
        # The work of this process alone counts: all of it is lost before its own first checkpoint.
        lost = max(lost, killed - max(started, checkpoint.stat().st_mtime))
        (folder / "copy.exr.checkpoint").write_bytes(checkpoint.read_bytes())
        result = bench.run(folder, RESUMED)
        samples = 0
        if result.code == 0:
            samples = json.loads((folder / "copy.json").read_text())["resumed_spp"]
            (folder / "copy.exr").unlink()
        corrupted += result.code != 0 or samples < 1
        resumed += samples > 0
    return Row("kill -9 at random moments, checkpoint every 0.05 s", tries, lost, corrupted,
               f"{resumed} of them resumed, {tries - resumed} had no checkpoint yet; lost work "
               "counts starting up")


def kill_nine_while_writing(bench):
    """Kills short commands at any moment: their files are absent, old or whole."""
    folder = bench.folder(64, 48)
    commands = {
        "render scene.toml -o out.exr --spp 1 --png out.png --quiet": ["out.exr", "out.png"],
        "synth recipe.toml -o out.csv --quiet": ["out.csv"],
    }
    dice = random.Random(9)
    tries = corrupted = 0
    for command, names in commands.items():
        bench.run_well(folder, command)
        good = {name: (folder / name).read_bytes() for name in names}
        start = time.monotonic()
        bench.run_well(folder, command)
        usual = time.monotonic() - start
        for _ in range(100 if bench.full else 3):
            for name in names:
                (folder / name).write_bytes(b"old")
            process = bench.start(folder, command)
            time.sleep(dice.uniform(0.0, usual))
            process.kill()
            process.communicate()
            tries += 1
            corrupted += sum(count_corrupted(folder / name, [good[name], b"old"]) for name in names)
    return Row("kill -9 of short commands", tries, 0.0, corrupted, "files are old or whole")


def shared_output_and_cache(bench):
    """Processes that write the same file at the same time, with a cache that is empty at first."""
    folder = bench.folder()
    command = "render scene.toml -o out.exr --spp 8 --quiet"
    bench.run_well(folder, command)
    good = (folder / "out.exr").read_bytes()
    tries, corrupted = 12 if bench.full else 1, 0
    for at in range(tries):
        (folder / "out.exr").unlink()
        cache = {"RERADIANT_CACHE": str(bench.root / f"shared-{at}")}
        together = [bench.start(folder, command, environment=cache) for _ in range(2)]
        for process in together:
            _, errors = process.communicate(timeout=300)
            if process.returncode != 0:
                raise Unexpected(f"one of two processes ended with {process.returncode}: {errors}")
        corrupted += count_corrupted(folder / "out.exr", [good]) + len(leftovers(folder))
        corrupted += not (folder / "out.exr").exists()
    return Row("two processes, one output, one empty cache", 2 * tries, 0.0, corrupted,
               "both end well, the file is whole")


def read_while_written(bench):
    """Reads an image as fast as may be while other runs replace it."""
    folder = bench.folder(64, 48)
    command = "render scene.toml -o out.exr --spp 1 --quiet"
    bench.run_well(folder, command)
    good = (folder / "out.exr").read_bytes()
    corrupted = reads = 0
    for _ in range(20 if bench.full else 1):
        writer = bench.start(folder, command)
        while writer.poll() is None:
            corrupted += (folder / "out.exr").read_bytes() != good
            reads += 1
        writer.communicate()
    expect(bench.run(folder, "info out.exr"), (0,), "info")
    return Row("reads of an image that is being replaced", reads, 0.0, corrupted,
               "always the whole of one")


def german_locale(bench, folder):
    """The environment of a locale with a decimal comma, made here; None where it cannot be."""
    locales = folder / "locales"
    locales.mkdir()
    made = subprocess.run(
        ["localedef", "-i", "de_DE", "-f", "UTF-8", locales / "de_DE.UTF-8"],
        capture_output=True, check=False).returncode if _exists("localedef") else 1
    # localedef ends with 1 for warnings too.
    if not (locales / "de_DE.UTF-8" / "LC_NUMERIC").exists() and made != 0:
        return None
    return {"LOCPATH": str(locales), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}


def _exists(program):
    return any((pathlib.Path(place) / program).exists()
               for place in os.environ.get("PATH", "").split(":"))


def other_locale(bench):
    """Every command must write the same bytes where numbers have a comma."""
    folder = bench.folder()
    german = german_locale(bench, folder)
    if german is None:
        return Row("locale de_DE (decimal comma)", 0, 0.0, 0,
                   "SKIPPED: no localedef or no locale sources here (package locales)")
    commands = {
        "render scene.toml -o a.exr --spp 2 --png a.png --exposure 0.5 --quiet": ["a.exr", "a.png"],
        "synth recipe.toml -o made.csv --quiet": ["made.csv"],
        "measure --preset red-lacquer -o m.csv --theta-i 0,45.5 --theta-o 0,30 --quiet": ["m.csv"],
        "fit made.csv -o fitted.csv --rank 1 --quiet": ["fitted.csv"],
        "convert made.csv b.bfc --quiet": ["b.bfc"],
        "convert made.csv b.exr --quiet": ["b.exr"],
        "info a.exr": [], "colour made.csv --illuminant D65": [], "validate scene.toml": [],
    }
    different = 0
    for command, names in commands.items():
        output = bench.run_well(folder, command).output
        good = {name: (folder / name).read_bytes() for name in names}
        different += bench.run_well(folder, command, environment=german).output != output
        different += sum((folder / name).read_bytes() != good[name] for name in names)
    return Row("locale de_DE (decimal comma)", len(commands), 0.0, different,
               "the same bytes as in C")


FAULTS = [kill_nine, kill_nine_while_writing, shared_output_and_cache, read_while_written,
          other_locale]
