"""Measures what no other command prints, and prints it as JSON.

    figures.py double | furnace | roulette | rough_metal | sequences

Pictures are small: what is compared does not depend on their size. Renders are the program's, as a user would
make them; RERADIANT_BUILD is the build folder, $OUT a folder for pictures.
"""

import json
import os
import pathlib
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("RERADIANT_BUILD", ROOT / "build"))
OUT = pathlib.Path(os.environ.get("OUT", "."))


def program(*arguments):
    """Runs the program and returns its JSON."""
    result = OUT / "answer.json"
    subprocess.run([BUILD / "bin/reradiant", *map(str, arguments), "--quiet", "--json", result], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads(result.read_text())


def small(name, width, changes=()):
    """An example scene at another width, with further lines changed; returns its file."""
    text = (ROOT / f"tools/examples/{name}.toml").read_text()
    old_width, old_height = (int(re.search(rf"^{key} = (\d+)", text, re.MULTILINE)[1]) for key in ("width", "height"))
    changes = [(f"width = {old_width}", f"width = {width}"),
               (f"height = {old_height}", f"height = {max(1, round(width * old_height / old_width))}"), *changes]
    for old, new in changes:
        assert text.count(old) >= 1, f"{name} has no line '{old}'"
        text = text.replace(old, new, 1)
    file = OUT / f"{name}-{width}-{abs(hash(tuple(changes)))}.toml"
    file.write_text(text)
    return file


def picture(scene, name, *options):
    """Renders and returns the file with what the program says of it."""
    file = OUT / f"{name}.exr"
    return file, program("render", scene, "-o", file, *options)


def error(scene, reference, seeds, *options):
    """Mean relMSE over seeds, and the rays of one of the renders."""
    errors = []
    for seed in range(1, seeds + 1):
        file, said = picture(scene, "a", "--seed", seed, *options)
        errors.append(program("compare", file, reference)["relmse"])
    return statistics.mean(errors), said["rays"]


def sequences():
    """relMSE of independent samples (those of --variance bands) over that of the sequences, reference study."""
    scene, bands = small("reference-study", 96), ("--bands", "400:700:20")
    reference, _ = picture(scene, "reference", "--spp", 4096, "--seed", 99, *bands)
    found = {}
    for spp in (16, 64):
        independent, _ = error(scene, reference, 6, "--spp", spp, "--variance", "bands", *bands)
        found[f"spp{spp}"] = independent / error(scene, reference, 6, "--spp", spp, *bands)[0]
    return found


def roulette():
    """Samples x relMSE at 16 samples with roulette and without, and the rays without over those with."""
    found = {}
    rough = ("  ior = 1.5\n", "  ior = 1.5\n  alpha = 0.1\n")
    for surface, changes in (("smooth", []), ("rough", [rough])):
        scene = small("reference-study", 128, changes)
        without = small("reference-study", 128, [*changes, ("max_depth = 8", "max_depth = 8\nmin_depth = 9")])
        bands = ("--bands", "400:700:20")
        reference, _ = picture(without, "reference", "--spp", 2048, "--seed", 99, *bands)
        for name, file in (("with", scene), ("without", without)):
            mean, rays = error(file, reference, 8, "--spp", 16, *bands)
            found[f"{surface}_{name}"] = 16 * mean
            found[f"{surface}_{name}_rays"] = rays
        found[f"{surface}_rays_percent"] = 100 * (found[f"{surface}_without_rays"] / found[f"{surface}_with_rays"] - 1)
    return found


def double():
    """relMSE of single precision against double, the same samples, and the seconds of double over those of single."""
    found = {}
    for name in ("fluorescent-bare", "fluorescent-smooth", "fluorescent-rough", "fluorescent-room", "reference-study"):
        scene = small(name, 96)
        single, _ = picture(scene, "single", "--spp", 32)
        exact, _ = picture(scene, "double", "--spp", 32, "--double")
        ratios = []
        for _ in range(3):
            seconds = [picture(scene, "timed", "--spp", 32, *more)[1]["passes"][-1]["seconds"]
                       for more in ((), ("--double",))]
            ratios.append(seconds[1] / seconds[0])
        found[name] = {"relmse": program("compare", single, exact)["relmse"], "time": statistics.median(ratios)}
    values = list(found.values())
    found["relmse"] = [value["relmse"] for value in values]
    found["time"] = [value["time"] for value in values]
    return found


def furnace():
    """Mean over the picture in the band that is furthest from 1, with its standard error, 1024 samples a pixel."""
    sys.path.insert(0, str(BUILD / "python"))
    import numpy as np
    import reradiant
    image = reradiant.render(str(ROOT / "tools/examples/furnace.toml"), spp=1024)
    values = np.asarray(image.values, dtype=float).reshape(-1, image.values.shape[-1])
    means, errors = values.mean(axis=0), values.std(axis=0) / np.sqrt(len(values))
    worst = int(np.argmax(np.abs(means - 1)))
    return {"mean": float(means[worst]), "distance": float(abs(means[worst] - 1)), "error": float(errors[worst])}


def albedos(material, model, angles, *options):
    table = OUT / "albedo.csv"
    program("measure", material, "-o", table, "--model", model, "--hemispherical", "--bands", "550:560:10",
            "--theta-i", ",".join(map(str, angles)), *options)
    rows = [line.split(",") for line in table.read_text().splitlines() if line and line[0] in "0123456789t"]
    value = rows[0].index("value")
    sums = {}
    for row in rows[1:]:
        if row[rows[0].index("lambda_i_nm")] == rows[1][rows[0].index("lambda_i_nm")]:
            angle = float(row[0])
            sums[angle] = sums.get(angle, 0.0) + float(row[value])
    return sums


def rough_metal():
    """Largest relative distance of weidlich-wilkie from the walk in albedo: a bare rough metal, 0 to 80 degrees."""
    worst = 0.0
    for alpha in (0.2, 0.5, 1.0):
        material = OUT / "metal.toml"
        material.write_text("[material]\n[material.substrate]\n"
                            f'type = "conductor"\nior = 0.3\nkappa = 3\nalpha = {alpha}\n')
        angles = (0, 20, 40, 60, 80)
        walk = albedos(material, "walk", angles, "--samples", 1 << 18)
        nested = albedos(material, "weidlich-wilkie", angles)
        worst = max([worst, *(abs(nested[angle] / walk[angle] - 1) for angle in walk)])
    return {"worst_percent": 100 * worst}


if __name__ == "__main__":
    print(json.dumps({f.__name__: f for f in (double, furnace, roulette, rough_metal, sequences)}[sys.argv[1]]()))
