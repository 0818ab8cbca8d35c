"""Makes of what a program prints the table of a document: `PROGRAM | document_tables.py NAME`.

    model_errors, direction_errors, depth_cells, dyed_seconds, error_estimate, fit_measured, recovery_10nm, recovery_5nm,
    error_table, faults, fuzz
"""

import re
import sys

from documents import cells_of


def tables_of(text):
    """Every Markdown table of a text, as rows of cells with the heading first."""
    return [cells_of(block) for block in re.findall(r"(?:^\|[^\n]*\n)+", text + "\n", re.MULTILINE)]


def only_table_of(text):
    """The table of a text that holds one, without what is logged between its rows."""
    return cells_of("".join(line + "\n" for line in text.splitlines() if line.startswith("|")))


def print_table(heading, rows):
    for row in [heading, ["---"] * len(heading), *rows]:
        print("| " + " | ".join(row) + " |" if all(row) else "|" + "|".join(f" {c} " if c else " " for c in row) + "|")


def model_errors(text):
    rows = []
    for row in only_table_of(text)[1:]:
        preset, walk, adding_0, adding, _, nested_0, nested, _, _, largest = row
        rows.append([preset, walk, "not for it" if adding_0 == "refused" else f"{adding_0}, {adding}",
                     f"{nested_0}, {nested}", re.sub(r"[ *]*over[ *]*", "", largest.split("/")[2]).strip()])
    print_table(["preset", "walk", "adding: at 0, worst", "weidlich-wilkie: at 0, worst", "largest"], rows)


def direction_errors(text):
    heading, *rows = only_table_of(text)
    print_table(heading, rows)


def depth_cells(text):
    heading, *rows = tables_of(text)[0]
    print_table(heading, rows)


def dyed_seconds(text):
    heading, *rows = tables_of(text)[1]
    print_table(heading, rows)


def error_estimate(text):
    shown, rows, held = ["8", "16", "64", "512"], {}, {}
    for scene, sampling, samples, _, median, low, high, holds in tables_of(text)[0][1:]:
        key = (scene, sampling)
        rows.setdefault(key, {})[samples] = f"{median.split()[0]}, {low} to {high}"
        of = [int(count) for count in holds.split(" of ")]
        held[key] = [a + b for a, b in zip(held.get(key, [0, 0]), of)]
    print_table(["scene", "sampling", "8 samples: median, 10 to 90 %", *shown[1:], "interval holds"],
                [[*key, *(cells.get(samples, "-") for samples in shown), "{} of {}".format(*held[key])]
                 for key, cells in rows.items()])


def fit_measured(text):
    found, order = {}, []
    for data, model, _, _, rmse, seconds, *_ in tables_of(text)[0][1:]:
        order += [data] if data not in order else []
        found[data, model] = (rmse, f"{float(seconds):.1f}")
    rows = [[data, found[data, "factors, rank 1"][0], found[data, "factors, rank 1, 200 bytes"][0],
             *found[data, "factors, rank 3"], *found[data, "matrix"]] for data in order]
    print_table(["matrix", "rank 1, 360 bytes", "rank 1, 200 bytes", "rank 3, 1080 bytes", "seconds, rank 3",
                 "every entry", "seconds"], rows)


def span(values, digits, unit=""):
    low, high = (f"{value:.{digits}f}" for value in (min(values), max(values)))
    return f"{low}{unit}" if low == high else f"{low} to {high}{unit}"


def seconds_span(values):
    return " to ".join(f"{value:.0f}" if value >= 10 else f"{value:.1f}" for value in (min(values), max(values)))


def recovery(text, step):
    rows = []
    cases = [row for row in tables_of(text)[0][1:] if row[1] == step]
    for stack in dict.fromkeys(row[0] for row in cases):
        of_stack = [row for row in cases if row[0] == stack]
        ratio, guessed, held, yields, seconds = ([float(row[k]) for row in of_stack] for k in (6, 7, 8, 9, 10))
        within = sum(90 <= value <= 99 for value in held)
        rows.append([stack, span(ratio, 2), "" if stack == "bare" else f"{min(guessed):.2f} to {max(guessed):.1f}",
                     span(held, 1, " %"), f"{max(map(abs, yields)):.1f} %", f"{within} of {len(of_stack)}",
                     seconds_span(seconds)])
    print_table(["stack", "error over noise" + ("" if step == "10" else f", {step} nm"),
                 "the same, excitation whose reflectance was not measured", "bands (95 %) hold",
                 "quantum yield off by at most", "cases within 90 to 99 %", "processor seconds"], rows)


def short(cell):
    """Two significant digits, as in 1.2e-5 and 0.60."""
    if cell == "-":
        return cell
    value = float(cell)
    if abs(value) < 0.1:
        mantissa, exponent = f"{value:.1e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return f"{value:.2f}" if value < 1 else f"{value:.1f}"


HEROES = ["hero:4", "hero:8", "hero:16"]


def error_table(text):
    """Makes one row of a scene's table, and lines of what its scenes have in common."""
    methods = ["comb+adaptive", "comb", *HEROES]
    rows, scenes = [], {}
    for scene, table in zip(re.findall(r"^(\S+), \S+ s a method$", text, re.MULTILINE), tables_of(text)):
        winner = next(row[0].split()[0] for row in table[1:] if "(winner)" in row[0])
        scenes[scene] = {row[0].split()[0]: row[1:] for row in table[1:]}
        rows.append([scene, winner] +
                    [", ".join(short(scenes[scene][method][k]) for method in methods) for k in (0, 3, 4)])
    print_table(["scene", "winner", "relMSE at the end: comb+adaptive, comb, hero:4, 8, 16",
                 "seconds to 1e-2: the same", "seconds to 1e-3: the same"], rows)
    print()
    error_lines(scenes)


def error_lines(scenes):
    """Says how the methods' errors compare, their slopes and where biased ones stop."""
    def over(a, b):
        return [float(scene[one][0]) / float(scene[b][0]) for scene in scenes.values() for one in a]

    def slopes(methods, only):
        return span([float(scene[method][1]) for name, scene in scenes.items() for method in methods if only(name)], 2)

    print("error of hero over comb:", span(over(HEROES, "comb"), 4))
    print("error of comb over comb+adaptive:", span(over(["comb"], "comb+adaptive"), 4))
    print("slopes of hero:", slopes(HEROES, lambda name: True))
    print("slopes of comb but for the room:", slopes(["comb"], lambda name: "room" not in name))
    print("slope of comb in the room:", slopes(["comb"], lambda name: "room" in name))
    for method in ("weidlich-wilkie", "comb:16"):
        for name, scene in scenes.items():
            print(f"floor of {method} in {name}: {scene[method][2]}")


def faults(text):
    table = tables_of(text)[0]
    print_table(table[0][:5], [row[:5] for row in table[1:]])


def fuzz(text):
    """Executions in thousands, three targets a row, and their sum in millions."""
    counts = [(row[0], int(row[1])) for row in tables_of(text)[0][1:]]
    cells = [[name, f"{count / 1000:,.0f}"] for name, count in counts]
    cells += [["", ""]] * (-len(cells) % 3)
    third = len(cells) // 3
    print(f"{sum(count for _, count in counts) / 1e6:.1f} million executions of {len(counts)} targets\n")
    print_table(["target", "thousand"] * 3,
                [cells[k] + cells[third + k] + cells[2 * third + k] for k in range(third)])


MAKERS = {"model_errors": model_errors, "direction_errors": direction_errors, "depth_cells": depth_cells,
          "dyed_seconds": dyed_seconds, "error_estimate": error_estimate, "fit_measured": fit_measured,
          "error_table": error_table, "faults": faults, "fuzz": fuzz,
          "recovery_10nm": lambda text: recovery(text, "10"), "recovery_5nm": lambda text: recovery(text, "5")}

if __name__ == "__main__":
    printed = sys.stdin.read()
    MAKERS[sys.argv[1]](printed)
    print("\n".join(line for line in printed.splitlines() if not line.startswith("|")))
