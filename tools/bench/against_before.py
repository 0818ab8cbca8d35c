#!/usr/bin/env python3
"""Two builds of this program on the same scenes, in turns: error, seconds, and their product.

    against_before.py PROGRAM [SCENE ...] [--spp 32] [--reference 2048] [--repeat 5]

PROGRAM is an earlier build's `reradiant`, which finds its own kernels and spectra through
RERADIANT_DATA_BEFORE (its checkout) if that is set. SCENE is an example's name or a file; without
any, all that are quick are taken. The error is the mean relMSE over the seeds against a long render
of this build; "pictures differ" compares one render of each, same seed, with each other. Seconds
are medians of whole processes, wall clock and processor.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOW = ROOT / "build" / "bin" / "reradiant"
QUICK = ["reference-study", "reference-study-fluorescent", "fluorescent-bare", "fluorescent-smooth",
         "fluorescent-rough", "fluorescent-room", "fluorescent-study", "uv-only"]


def render(program, environment, scene, out, spp, seed, more):
    """Renders; returns wall and processor seconds."""
    command = [str(program), "render", str(scene), "-o", str(out), "--spp", str(spp), "--seed",
               str(seed), "--quiet", *more]
    before = os.times()
    start = time.time()
    subprocess.run(command, check=True, env=environment)
    after = os.times()
    processor = (after.children_user + after.children_system
                 - before.children_user - before.children_system)
    return time.time() - start, processor


def relmse(image, reference, folder):
    out = pathlib.Path(folder) / "compare.json"
    subprocess.run([str(NOW), "compare", str(image), str(reference), "--json", str(out), "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(out.read_text())["relmse"]


def judge(scene, args, folder):
    """Errors and seconds of both builds, and how their pictures of one seed differ."""
    folder = pathlib.Path(folder)
    reference = folder / "reference.exr"
    older = dict(os.environ)
    if "RERADIANT_DATA_BEFORE" in os.environ:
        older["RERADIANT_DATA"] = os.environ["RERADIANT_DATA_BEFORE"]
    builds = {"before": (args.program, older), "now": (NOW, dict(os.environ))}
    render(NOW, os.environ, scene, reference, args.reference, 1000, args.more)
    for name, (program, environment) in builds.items():  # kernels into the cache
        render(program, environment, scene, folder / f"{name}.exr", 1, 0, args.more)
    found = {name: {"error": [], "wall": [], "processor": []} for name in builds}
    for seed in range(args.repeat):
        for name, (program, environment) in builds.items():
            image = folder / f"{name}.exr"
            wall, processor = render(program, environment, scene, image, args.spp, seed, args.more)
            found[name]["wall"].append(wall)
            found[name]["processor"].append(processor)
            found[name]["error"].append(relmse(image, reference, folder))
    return found, relmse(folder / "now.exr", folder / "before.exr", folder)


def row(name, found, difference, spp):
    error = {build: statistics.mean(of["error"]) for build, of in found.items()}
    wall = {build: statistics.median(of["wall"]) for build, of in found.items()}
    processor = {build: statistics.median(of["processor"]) for build, of in found.items()}
    gain = error["before"] * processor["before"] / (error["now"] * processor["now"])
    return (f"| {name} | {spp * error['before']:.3g} / {spp * error['now']:.3g} | "
            f"{wall['before']:.2f} / {wall['now']:.2f} | "
            f"{processor['before']:.2f} / {processor['now']:.2f} | {gain:.2f} | {difference:.2g} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("scenes", nargs="*", default=QUICK)
    parser.add_argument("--spp", type=int, default=32)
    parser.add_argument("--reference", type=int, default=2048)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--more", nargs=argparse.REMAINDER, default=[], help="options for both")
    args = parser.parse_args()
    print(f"{args.spp} samples, {args.repeat} turns; before / now\n\n"
          "| scene | samples x relMSE | seconds | processor seconds | error x time, times better | "
          "pictures differ, relMSE |\n| --- | --- | --- | --- | --- | --- |")
    for scene in args.scenes:
        file = pathlib.Path(scene)
        if not file.is_file():
            file = ROOT / "tools" / "examples" / f"{scene}.toml"
        with tempfile.TemporaryDirectory() as folder:
            found, difference = judge(file, args, folder)
        print(row(file.stem, found, difference, args.spp), flush=True)


if __name__ == "__main__":
    main()
