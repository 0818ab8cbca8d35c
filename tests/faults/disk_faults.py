"""Disks that are full, folders that are closed, files that are half there."""

import json
import os
import pathlib
import resource
import subprocess

from harness import NOBODY, Row, Unexpected, count_corrupted, expect, leftovers

# Every command that writes, with what it writes.
WRITERS = [
    ("render scene.toml -o out.exr --spp 4 --png out.png --json out.json --quiet",
     ["out.exr", "out.png", "out.json"]),
    ("measure --preset red-lacquer -o out.csv --theta-i 0,45 --theta-o 0,30 --quiet", ["out.csv"]),
    ("synth recipe.toml -o data.csv --truth truth.csv --quiet", ["data.csv", "truth.csv"]),
    ("fit made.csv -o fitted.csv --rank 1 --report fit.html --quiet", ["fitted.csv", "fit.html"]),
    ("convert made.csv made.exr --quiet", ["made.exr"]),
    ("merge part.exr -o merged.exr --quiet", ["merged.exr"]),
]


def prepare(bench, folder):
    """Inputs of the later commands."""
    bench.run_well(folder, "synth recipe.toml -o made.csv --quiet")
    bench.run_well(folder, "render scene.toml -o part.exr --sample-range 0:4 --quiet")


def contents(folder, names):
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def good_contents(bench, folder, command, names):
    """Returns what the command writes on a good day, and removes the files again."""
    bench.run_well(folder, command)
    good = contents(folder, names)
    for name in names:
        (folder / name).unlink()
    return good


def judge(folder, names, good, old):
    """Files that are neither absent nor old nor new, and temporary files left behind."""
    bad = sum(count_corrupted(folder / name, [good[name], old]) for name in names)
    return bad + len(leftovers(folder))


def file_sizes_limited(bench):
    """A disk that fills up at some byte of what is written, with and without an older file."""
    folder = bench.folder()
    prepare(bench, folder)
    tries = corrupted = 0
    for command, names in WRITERS:
        good = good_contents(bench, folder, command, names)
        largest = max(len(content) for content in good.values())
        points = range(12) if bench.full else [6]
        for at in points:
            limit = largest * at // 12
            for old in (None, b"old") if bench.full else (b"old",):
                for name in names:
                    (folder / name).unlink(missing_ok=True)
                    if old:
                        (folder / name).write_bytes(old)
                result = bench.run(folder, command, limits=[(resource.RLIMIT_FSIZE, limit)])
                tries += 1
                # Times in files make some shorter than on the good day: they may just fit.
                expect(result, (0, 1), command)
                if result.code == 0 and limit < 0.9 * min(map(len, good.values())):
                    raise Unexpected(f"{command} says that it wrote beyond {limit} bytes")
                corrupted += judge_volatile(folder, names, good, old, result)
        for name in names:
            (folder / name).unlink(missing_ok=True)
    return Row("disk full (file size limit)", tries, 0.0, corrupted,
               "exit 1, older file stays, nothing half-written")


def judge_volatile(folder, names, good, old, result):
    """As judge, but files with times in them (JSON, reports) are new in every run."""
    steady = [name for name in names if not name.endswith((".json", ".html"))]
    bad = judge(folder, steady, good, old)
    for name in set(names) - set(steady):
        file = folder / name
        if file.exists() and file.read_bytes() != old and result.code == 0:
            ends = (b"}", b"</html>")
            bad += 0 if file.read_bytes().rstrip().endswith(ends) else 1
    return bad


def small_disk(bench):
    """A disk that holds half an image, whatever the compression makes of it, where one may be mounted."""
    name = "disk full (file system of half an image)"
    folder = bench.folder(64, 48)
    bench.run_well(folder, "render scene.toml -o whole.exr --spp 4 --quiet")
    size = (folder / "whole.exr").stat().st_size // 2
    disk = folder / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", disk],
                      capture_output=True, check=False).returncode != 0:
        return Row(name, 0, 0.0, 0, "skipped: may not mount")
    try:
        tries = corrupted = 0
        for old in (None, b"old"):
            if old:
                (disk / "out.exr").write_bytes(old)
            command = "render scene.toml -o disk/out.exr --spp 4 --quiet"
            result = bench.run(folder, command)
            expect(result, (1,), command)
            tries += 1
            corrupted += count_corrupted(disk / "out.exr", [old]) + len(leftovers(folder))
    finally:
        subprocess.run(["umount", disk], check=True)
    return Row(name, tries, 0.0, corrupted, "exit 1, older file stays, nothing half-written")


def full_for_one_file(bench):
    """A disk that is full when a checkpoint is written costs no render; one that is full when the
    image is written costs nothing that --resume does not bring back."""
    folder = bench.folder()
    command = "render scene.toml -o out.exr --spp 2048 --checkpoint 0.001 --quiet"
    bench.run_well(folder, command)
    good = (folder / "out.exr").read_bytes()
    (folder / "out.exr").unlink()
    result = bench.run(folder, command.replace(" --quiet", ""),
                       environment=bench.preloaded(RERADIANT_FAULT_RENAME=".checkpoint"))
    expect(result, (0,), command)
    if "goes on without" not in result.errors:
        raise Unexpected(f"no word of the checkpoint that was not written: {result.errors}")
    (folder / "good.exr").write_bytes(good)
    bench.run_well(folder, "compare out.exr good.exr --max-relmse 0")
    (folder / "out.exr").unlink()
    expect(bench.run(folder, command, environment=bench.preloaded(RERADIANT_FAULT_RENAME=".exr")),
           (1,), command)
    corrupted = count_corrupted(folder / "out.exr", []) + len(leftovers(folder))
    bench.run_well(folder, command + " --resume --json out.json")
    bench.run_well(folder, "compare out.exr good.exr --max-relmse 0")
    if json.loads((folder / "out.json").read_text())["resumed_spp"] < 1:
        raise Unexpected("nothing was left to resume")
    return Row("disk full for a checkpoint, for the image", 2, 0.0, corrupted,
               "the render goes on; the checkpoint stays and --resume writes the same image")


def closed_folders(bench):
    """Folders without leave to write; root may write anywhere, so root becomes nobody."""
    user = NOBODY if os.geteuid() == 0 else None
    folder = bench.folder()
    prepare(bench, folder)
    tries = corrupted = 0
    for command, names in WRITERS:
        good = good_contents(bench, folder, command, names)
        for name in names:
            (folder / name).write_bytes(b"old")
            (folder / name).chmod(0o444)
        folder.chmod(0o555)
        result = bench.run(folder, command, user=user,
                           environment={"RERADIANT_CACHE": str(folder / "no-cache")})
        folder.chmod(0o755)
        tries += 1
        expect(result, (1, 2), command)
        corrupted += judge(folder, names, good, b"old")
        for name in names:
            (folder / name).unlink()
    return Row("read-only folder, no place for caches", tries, 0.0, corrupted,
               "exit 1 or 2 naming the file, older file stays")


def unreadable_inputs(bench):
    """Inputs without leave to read, folders, devices and pipes in their place."""
    user = NOBODY if os.geteuid() == 0 else None
    folder = bench.folder()
    prepare(bench, folder)
    os.mkfifo(folder / "pipe")
    os.mkfifo(folder / "pipe.csv")
    (folder / "secret.csv").write_text("nm,value\n400,1\n")
    (folder / "secret.csv").chmod(0)
    scene = (folder / "scene.toml").read_text()
    names = ["pipe.csv", "secret.csv"]
    if bench.full:
        names += ["pipe", "/dev/zero", "/dev/stdin", "/dev/tty", ".", "/proc"]
    commands = []
    for number, name in enumerate(names):
        named = scene.replace("reflectance = 0.5", f'reflectance = {{ file = "{name}" }}')
        (folder / f"names-{number}.toml").write_text(named)
        commands.append(f"render names-{number}.toml -o out.exr --spp 1")
        commands += [f"{command} {name}" for command in ("validate", "info", "colour")]
        commands += [f"render {name} -o out.exr", f"fit {name} -o out.csv",
                     f"compare {name} part.exr", f"merge {name} part.exr -o out.exr",
                     f"convert {name} out.csv", f"study {name} -o out", f"synth {name} -o out.csv",
                     f"measure {name} -o out.csv --theta-i 0 --theta-o 0",
                     f"render scene.toml -o out.exr --spp 1 --png out.png --ocio {name}"]
    os.mkfifo(folder / "resumed.exr.checkpoint")
    commands.append("render scene.toml -o resumed.exr --spp 1 --resume")
    folder.chmod(0o777)
    for command in commands:
        # A pipe without a writer would be waited for without end.
        result = bench.run(folder, command, user=user,
                           environment={"RERADIANT_CACHE": str(folder / "cache")})
        expect(result, (1, 2), command)
    left = [name for name in ("out.csv", "out") if (folder / name).exists()]
    return Row("input: no permission, device, pipe, folder", len(commands), 0.0, len(left),
               "exit 2 naming it, none is waited for or executed")


def half_written_images(bench):
    """An image cut at many places, as a copy in progress or a crash of another program leaves."""
    folder = bench.folder()
    bench.run_well(folder, "render scene.toml -o whole.exr --spp 2 --quiet")
    whole = (folder / "whole.exr").read_bytes()
    tries = 200 if bench.full else 10
    accepted = 0
    for at in range(tries):
        pathlib.Path(folder / "cut.exr").write_bytes(whole[:len(whole) * at // tries])
        result = bench.run(folder, "compare cut.exr whole.exr --quiet")
        expect(result, (0, 2), "compare")
        accepted += result.code == 0
    return Row("reader of a half-written EXR", tries, 0.0, accepted, "exit 2, none is taken")


FAULTS = [file_sizes_limited, small_disk, full_for_one_file, closed_folders, unreadable_inputs, half_written_images]
