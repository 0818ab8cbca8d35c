#!/usr/bin/env python3
"""The reference study by Mitsuba 3 and by Reradiant, side by side: seconds to an error.

    against_mitsuba.py [--variant llvm_ad_spectral] [--surface smooth|rough] [--repeat 5]

Both render the same scene (sphere of paint beneath a varnish, ground, area light, constant
environment; 512 x 512), each against a reference of its own. Error: relMSE of linear sRGB, the mean
of d^2 / (ref^2 + 0.01). Each renders at growing sample counts; error times samples is constant for
independent samples, so the samples that reach --target follow from a fit of slope, and are then
rendered and timed, both programs in turns, wall seconds of the whole process (start-up, kernels from
the cache, writing an image). Needs numpy and mitsuba (PyPI); the llvm variants need LLVM 19
(libllvm19); with LLVM 15 they abort.
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


def mitsuba_scene(mi, surface, spp):
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
            "sampler": {"type": "independent", "sample_count": spp}},
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


def render_mitsuba(variant, surface, spp, seed, out):
    """One render; run by itself as a process, so that start-up counts."""
    import mitsuba as mi
    mi.set_variant(variant)
    scene = mi.load_dict(mitsuba_scene(mi, surface, spp))
    total = None
    # memory: the wavefront holds all paths of a pass
    passes = max(1, spp * SIZE * SIZE // (1 << 24))
    for p in range(passes):
        image = np.array(mi.render(scene, spp=spp // passes, seed=seed * 1000 + p), np.float64)
        total = image if total is None else total + image
    np.save(out, total / passes)


def run_mitsuba(args, spp, seed, out):
    start = time.time()
    subprocess.run([sys.executable, __file__, "--worker", "--variant", args.variant, "--surface",
                    args.surface, "--spp", str(spp), "--seed", str(seed), "--out", out],
                   check=True)
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
    start = time.time()
    subprocess.run(command, check=True)
    return time.time() - start, read_rgb(out)


def relmse(image, reference):
    return float(np.mean((image - reference) ** 2 / (reference ** 2 + 0.01)))


def spp_for(target, run, reference):
    """Samples that reach the target, from errors at 16 and 64 samples, which give the slope."""
    errors = {spp: relmse(run(spp, 7)[1], reference) for spp in (16, 64)}
    slope = np.log(errors[64] / errors[16]) / np.log(4)
    return int(np.ceil(64 * (target / errors[64]) ** (1 / slope))), errors, slope


def compare(args):
    with tempfile.TemporaryDirectory() as folder:
        def mitsuba(spp, seed):
            return run_mitsuba(args, spp, seed, os.path.join(folder, "m.npy"))

        def ours(spp, seed):
            return run_ours(args, folder, spp, seed, os.path.join(folder, "o.exr"))

        result = {}
        for name, run in {"mitsuba": mitsuba, "reradiant": ours}.items():
            reference = run(args.reference, 1)[1]
            spp, errors, slope = spp_for(args.target, run, reference)
            result[name] = {"reference": reference, "spp": spp, "errors": errors, "slope": slope,
                            "seconds": [], "reached": []}
        for repeat in range(args.repeat):
            for name, run in {"mitsuba": mitsuba, "reradiant": ours}.items():
                seconds, image = run(result[name]["spp"], 100 + repeat)
                result[name]["seconds"].append(seconds)
                result[name]["reached"].append(relmse(image, result[name]["reference"]))
        report(args, result)


def report(args, result):
    print(f"{args.surface} study, {args.variant}, relMSE {args.target:g}, medians of {args.repeat}")
    print("| program | spp | relMSE reached | slope of relMSE | seconds |")
    print("| --- | --- | --- | --- | --- |")
    for name, r in result.items():
        print(f"| {name} | {r['spp']} | {statistics.median(r['reached']):.3g} | {r['slope']:.2f} | "
              f"{statistics.median(r['seconds']):.2f} |")
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
    parser.add_argument("--bands", help="--bands of our render, FROM:TO:STEP")
    parser.add_argument("--json", help="also write the figures here")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--spp", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--seed", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--out", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.worker:
        render_mitsuba(args.variant, args.surface, args.spp, args.seed, args.out)
    else:
        compare(args)


if __name__ == "__main__":
    main()
