"""A device that goes away, kernels that do not build, memory that runs out, clocks that leap."""

import json
import resource
import time

from harness import Row, Unexpected, count_corrupted, expect, leftovers

RENDER = "render scene.toml -o out.exr --spp 64 --quiet"


def fails_cleanly(bench, faults, words, name, outcome):
    """Every fault must end in exit 1 that says one of the words, with the older file in place."""
    folder = bench.folder()
    bench.run_well(folder, RENDER)
    (folder / "out.exr").write_bytes(b"old")
    corrupted = 0
    for fault in faults:
        result = bench.run(folder, RENDER, environment=bench.preloaded(**fault))
        expect(result, (1,), f"{RENDER} with {fault}")
        if not any(word in result.errors for word in words):
            raise Unexpected(f"{fault} is not named: {result.errors}")
        corrupted += count_corrupted(folder / "out.exr", [b"old"]) + len(leftovers(folder))
    return Row(name, len(faults), 0.0, corrupted, outcome)


def device_lost(bench):
    points = range(1, 30, 1 if bench.full else 13)
    return fails_cleanly(bench, [{"RERADIANT_FAULT_LAUNCH": at} for at in points],
                         ["CL_DEVICE_NOT_AVAILABLE"], "device lost at a kernel launch",
                         "exit 1 naming the error, older file stays")


def device_lost_after_checkpoint(bench):
    """A lost device costs no more than the work after the last checkpoint."""
    folder = bench.folder()
    bench.run_well(folder, RENDER)
    (folder / "out.exr").unlink()
    lost, tries = 0.0, 5 if bench.full else 1
    for attempt in range(tries):
        fault = bench.preloaded(RERADIANT_FAULT_LAUNCH=500 + 200 * attempt)
        command = "render scene.toml -o out.exr --spp 100000000 --checkpoint 0.02 --quiet"
        result = bench.run(folder, command, environment=fault)
        ended = time.time()
        expect(result, (1,), command)
        checkpoint = folder / "out.exr.checkpoint"
        if (folder / "out.exr").exists() or not checkpoint.exists():
            raise Unexpected("a lost device left an image, or no checkpoint")
        lost = max(lost, ended - checkpoint.stat().st_mtime)
        resumed = "render scene.toml -o out.exr --resume --time 0.001 --json out.json --quiet"
        bench.run_well(folder, resumed)
        if json.loads((folder / "out.json").read_text())["resumed_spp"] < 1:
            raise Unexpected("nothing was resumed")
        (folder / "out.exr").unlink()
    return Row("device lost, checkpoint every 0.02 s", tries, lost, 0,
               "the checkpoint is there and --resume goes on")


def buffers_fail(bench):
    points = range(1, 12, 1 if bench.full else 5)
    return fails_cleanly(bench, [{"RERADIANT_FAULT_BUFFER": at} for at in points],
                         ["ALLOCATION_FAILURE", "memory"], "device out of memory",
                         "exit 1 naming it, older file stays")


def kernels_fail(bench):
    """Without a cache every kernel is built, and none does."""
    fault = {"RERADIANT_FAULT_BUILD": 1, "RERADIANT_CACHE": bench.root / "empty-cache"}
    return fails_cleanly(bench, [fault], ["does not build"], "kernels do not build",
                         "exit 1 with the log, its source is kept, older file stays")


def memory_runs_out(bench):
    """Addresses are limited, from what starting needs up to enough."""
    folder = bench.folder(256, 256)
    command = "render scene.toml -o out.exr --spp 2 --quiet"
    bench.run_well(folder, command)
    good = (folder / "out.exr").read_bytes()
    tries = 40 if bench.full else 4
    corrupted = crashed = 0
    for at in range(tries):
        (folder / "out.exr").write_bytes(b"old")
        limit = (64 << 20) + (at * (3 << 30)) // tries
        result = bench.run(folder, command, limits=[(resource.RLIMIT_AS, limit)])
        crashed += result.code not in (0, 1)
        if result.code == 0 and (folder / "out.exr").read_bytes() != good:
            raise Unexpected("a render that ran short of memory calls itself done")
        corrupted += count_corrupted(folder / "out.exr", [good, b"old"]) + len(leftovers(folder))
    return Row("out of memory (address space limit)", tries, 0.0, corrupted,
               f"exit 1 or done; {crashed} ended by the driver's or loader's own abort; older file "
               "stays")


def clock_leaps(bench):
    """Only the wall clock leaps; times of renders and checkpoints are of the steady one."""
    folder = bench.folder()
    bench.run_well(folder, RENDER)
    good = (folder / "out.exr").read_bytes()
    tries = 10 if bench.full else 2
    corrupted = 0
    for _ in range(tries):
        (folder / "out.exr").unlink()
        fault = bench.preloaded(RERADIANT_FAULT_CLOCK=1)
        result = bench.run(folder, RENDER, environment=fault)
        expect(result, (0,), RENDER)
        corrupted += count_corrupted(folder / "out.exr", [good])
        timed = "render scene.toml -o timed.exr --time 0.5 --checkpoint 0.1 --json t.json --quiet"
        expect(bench.run(folder, timed, environment=fault), (0,), timed)
        seconds = json.loads((folder / "t.json").read_text())["seconds"]
        if not 0.0 <= seconds["total"] < 60.0 or min(seconds.values()) < 0.0:
            raise Unexpected(f"times followed the wall clock: {seconds}")
    return Row("wall clock leaps by up to a day", 2 * tries, 0.0, corrupted,
               "same image, times of the steady clock")


FAULTS = [device_lost, device_lost_after_checkpoint, buffers_fail, kernels_fail, memory_runs_out,
          clock_leaps]
