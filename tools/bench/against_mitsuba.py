#!/usr/bin/env python3
"""The reference study by Mitsuba 3 and by Reradiant, side by side: seconds to an error.

    against_mitsuba.py [--variant llvm_ad_spectral] [--surface smooth|rough] [--repeat 5]
                       [--sampler NAME] [--adaptive]

Both render the same scene (sphere of paint beneath a varnish, ground, area light, constant
environment; 512 x 512), each against a reference of its own, whose error is to be below 5 % of the
target. Error: relMSE of linear sRGB, the mean of d^2 / (ref^2 + 0.01). Without --sampler every
sampler of Mitsuba is tried, and the one that takes the least seconds to the target, by its errors and
times at 16 and 64 samples, is the one that is compared. The samples that reach --target follow from a
fit of slope; they are then rendered and timed, both programs in turns, wall seconds of the whole
process (start-up, kernels from the cache, writing an image). Needs numpy and mitsuba (PyPI); the
llvm variants need LLVM 19 (libllvm19); with LLVM 15 they abort.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "build" / "bin" / "reradiant"

WAVELENGTHS = list(range(400, 701, 20))
PAINT = [0.045, 0.042, 0.040, 0.038, 0.037, 0.038, 0.040, 0.045,
         0.070, 0.180, 0.420, 0.620, 0.710, 0.745, 0.760, 0.770]
SIZE = 512
SAMPLERS = ["independent", "stratified", "multijitter", "orthogonal", "ldsampler"]


def mitsuba_scene(mi, surface, sampler, spp):
    """The study as a Mitsuba dictionary; `plastic` with nonlinear colour shifts, as ours has."""
    to_world = mi.ScalarTransform4f
    paint = {"type": "plastic" if surface == "smooth" else "roughplastic",
             "int_ior": 1.5, "ext_ior": 1.0, "nonlinear": True,
             "diffuse_reflectance": {"type": "irregular",
                                     "wavelengths": ", ".join(map(str, WAVELENGTHS)),
                                     "values": ", ".join(map(str, PAINT))}}
    if surface == "rough":
        paint |= {"distribution": "ggx", "alpha": 0.1}
    flat = {"type": "uniform", "value": 8.0}
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 9, "rr_depth": 5},
        "sensor": {
            "type": "perspective", "fov": 35, "fov_axis": "y",
            "to_world": to_world().look_at(origin=[0, 2.2, 6], target=[0, 0.9, 0], up=[0, 1, 0]),
            "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgb",
                     "rfilter": {"type": "box"}},
            "sampler": {"type": sampler, "sample_count": spp}},
        "light": {"type": "rectangle",
                  "to_world": to_world().translate([-2, 5, 1.5]).rotate([1, 0, 0], 90),
                  "emitter": {"type": "area", "radiance": flat}},
        "sky": {"type": "constant", "radiance": {"type": "uniform", "value": 0.3}},
        "sphere": {"type": "sphere", "center": [0, 1, 0], "radius": 1, "bsdf": paint},
        "ground": {"type": "rectangle",
                   "to_world": to_world().rotate([1, 0, 0], -90).scale([10, 10, 1]),
                   "bsdf": {"type": "diffuse",
                            "reflectance": {"type": "uniform", "value": 0.5}}},
    }


def render_mitsuba(variant, surface, sampler, spp, seed, out):
    """One render; run by itself as a process, so that start-up counts."""
    import mitsuba as mi
    mi.set_variant(variant)
    # memory: the wavefront holds all paths of a pass
    passes = max(1, spp * SIZE * SIZE // (1 << 25))
    scene = mi.load_dict(mitsuba_scene(mi, surface, sampler, spp // passes))
    total = None
    for p in range(passes):
        image = np.array(mi.render(scene, seed=seed * 1000 + p), np.float64)
        total = image if total is None else total + image
    np.save(out, total / passes)


def run_mitsuba(args, sampler, spp, seed, out):
    start = time.time()
    subprocess.run([sys.executable, __file__, "--worker", "--variant", args.variant, "--surface",
                    args.surface, "--sampler", sampler, "--spp", str(spp), "--seed", str(seed),
                    "--out", out], check=True, stderr=subprocess.DEVNULL)
    return time.time() - start, np.load(out)


def ours_scene(surface, folder):
    text = (ROOT / "tools" / "examples" / "reference-study.toml").read_text()
    if surface == "rough":
        text = text.replace("ior = 1.5\n", "ior = 1.5\n  alpha = 0.1\n")
    path = pathlib.Path(folder) / "study.toml"
    path.write_text(text)
    return path


def read_rgb(path):
    """The R, G, B channels of an EXR file of ours."""
    import mitsuba as mi
    if mi.variant() is None:
        mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(str(path))
    names = [bitmap.struct_()[i].name for i in range(len(bitmap.struct_()))]
    data = np.array(bitmap, np.float64)
    return data[..., [names.index(c) for c in "RGB"]]


def run_ours(args, folder, spp, seed, out):
    command = [str(PROGRAM), "render", str(ours_scene(args.surface, folder)), "-o", out, "--spp",
               str(spp), "--seed", str(seed), "--quiet", "--json", out + ".json"]
    if args.bands:
        command += ["--bands", args.bands]
    if args.adaptive and spp < args.reference:
        command.append("--adaptive")
    start = time.time()
    subprocess.run(command, check=True)
    return time.time() - start, read_rgb(out)


def relmse(image, reference):
    return float(np.mean((image - reference) ** 2 / (reference ** 2 + 0.01)))


def spp_for(target, run, reference):
    """Samples and about how many seconds reach the target, from 16 and 64 samples, two seeds each."""
    errors, seconds = {}, {}
    for spp in (16, 64):
        runs = [run(spp, seed) for seed in (7, 8)]
        errors[spp] = statistics.mean(relmse(image, reference) for _, image in runs)
        seconds[spp] = min(second for second, _ in runs)
    slope = float(np.log(errors[64] / errors[16]) / np.log(4))
    spp = int(np.ceil(64 * (target / errors[64]) ** (1 / slope)))
    per_sample = (seconds[64] - seconds[16]) / 48
    return {"spp": spp, "errors": errors, "slope": slope,
            "expected_seconds": seconds[16] + (spp - 16) * per_sample}


def best_sampler(args, run, reference):
    """The sampler of Mitsuba that promises the least seconds, and what was found of each."""
    tried = {}
    for sampler in [args.sampler] if args.sampler else SAMPLERS:
        try:
            tried[sampler] = spp_for(args.target, lambda spp, seed: run(sampler, spp, seed), reference)
        except subprocess.CalledProcessError:
            print(f"{sampler}: Mitsuba cannot render the scene with it", file=sys.stderr)
    return min(tried, key=lambda name: tried[name]["expected_seconds"]), tried


def compare(args):
    with tempfile.TemporaryDirectory() as folder:
        def mitsuba_by(sampler, spp, seed):
            return run_mitsuba(args, sampler, spp, seed, os.path.join(folder, "m.npy"))

        def mitsuba(spp, seed):
            return mitsuba_by(best, spp, seed)

        def ours(spp, seed):
            return run_ours(args, folder, spp, seed, os.path.join(folder, "o.exr"))

        references = {"mitsuba": mitsuba_by(args.sampler or "multijitter", args.reference, 1)[1],
                      "reradiant": ours(args.reference, 1)[1]}
        best, tried = best_sampler(args, mitsuba_by, references["mitsuba"])
        found = {"mitsuba": tried[best],
                 "reradiant": spp_for(args.target, ours, references["reradiant"])}
        result = {name: {**of, "reference": references[name], "seconds": [], "reached": []}
                  for name, of in found.items()}
        result["mitsuba"] |= {"sampler": best, "samplers": tried}
        for repeat in range(args.repeat):
            for name, run in {"mitsuba": mitsuba, "reradiant": ours}.items():
                seconds, image = run(result[name]["spp"], 100 + repeat)
                result[name]["seconds"].append(seconds)
                result[name]["reached"].append(relmse(image, result[name]["reference"]))
        report(args, result)


def report(args, result):
    print(f"{args.surface} study, {args.variant}, relMSE {args.target:g}, medians of {args.repeat}")
    for sampler, of in result["mitsuba"]["samplers"].items():
        print(f"sampler {sampler}: {of['spp']} samples, about {of['expected_seconds']:.2f} s")
    print("| program | spp | relMSE reached | slope of relMSE | seconds |")
    print("| --- | --- | --- | --- | --- |")
    for name, r in result.items():
        shown = f"{name} ({r['sampler']})" if "sampler" in r else name
        print(f"| {shown} | {r['spp']} | {statistics.median(r['reached']):.3g} | {r['slope']:.2f} | "
              f"{statistics.median(r['seconds']):.2f} |")
        own = r["errors"][64] * 64 / args.reference  # at most: passes of a reference are independent
        print(f"{name}'s reference has an error of {100 * own / args.target:.1f} % of the target or less",
              file=sys.stderr)
    ratios = [m / o for m, o in zip(result["mitsuba"]["seconds"], result["reradiant"]["seconds"])]
    print(f"mitsuba : reradiant = {statistics.median(ratios):.2f} (pairs {min(ratios):.2f} to "
          f"{max(ratios):.2f})")
    difference = relmse(result["reradiant"]["reference"], result["mitsuba"]["reference"])
    means = [float(r["reference"].mean()) for r in result.values()]
    print(f"references: relMSE of one to the other {difference:.3g}, means {means[0]:.5f} "
          f"{means[1]:.5f}")
    if args.json:
        for r in result.values():
            del r["reference"]
        pathlib.Path(args.json).write_text(json.dumps(result, indent=1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--variant", default="llvm_ad_spectral")
    parser.add_argument("--surface", choices=["smooth", "rough"], default="smooth")
    parser.add_argument("--target", type=float, default=1e-3)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--reference", type=int, default=4096, help="samples of the references")
    parser.add_argument("--sampler", help="of Mitsuba; without it the best of " + ", ".join(SAMPLERS))
    parser.add_argument("--bands", help="--bands of our render, FROM:TO:STEP")
    parser.add_argument("--adaptive", action="store_true", help="our render is adaptive, its reference is not")
    parser.add_argument("--json", help="also write the figures here")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--spp", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--seed", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--out", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.worker:
        render_mitsuba(args.variant, args.surface, args.sampler, args.spp, args.seed, args.out)
    else:
        compare(args)


if __name__ == "__main__":
    main()
