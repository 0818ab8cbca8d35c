"""Meshes and textures of the four figures: own work, made anew from numbers alone."""

import math
import pathlib
import struct
import sys
import zlib


def write_png(file, width, height, colour):
    """colour(u, v) gives linear red, green, blue from 0 to 1; (0, 0) is the upper left corner."""
    def chunk(name, data):
        body = name + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    def code(value):
        value = min(max(value, 0.0), 1.0)
        encoded = 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055
        return round(255 * encoded)

    rows = bytearray()
    for y in range(height):
        rows.append(0)
        for x in range(width):
            rows.extend(code(value) for value in colour((x + 0.5) / width, (y + 0.5) / height))
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
                     chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def write_obj(file, points, faces, coordinates=()):
    """Polygons of indices from 0, with texture coordinates where there are some."""
    lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in points] + [f"vt {u:.5f} {v:.5f}" for u, v in coordinates]
    corner = "{0}/{0}" if coordinates else "{0}"
    lines += ["f " + " ".join(corner.format(index + 1) for index in face) for face in faces]
    file.write_text("\n".join(lines) + "\n")


def grid(columns, rows, point):
    """A net of quadrilaterals over u and v from 0 to 1, with the coordinates."""
    coordinates = [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    faces = [(j * (columns + 1) + i, j * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i)
             for j in range(rows) for i in range(columns)]
    return [point(u, v) for u, v in coordinates], faces, coordinates


def hashed(*numbers):
    """A number from 0 to 1 that looks random and is the same everywhere."""
    mixed = 0
    for number in numbers:
        mixed = ((mixed ^ number) * 0x9e3779b1 + 0x7f4a7c15) & 0xffffffff
        mixed = (mixed ^ mixed >> 15) * 0x2c1b3c6d & 0xffffffff
        mixed ^= mixed >> 13
    return mixed / 0x100000000


def noise(x, y):
    """Smooth noise on the plane, from 0 to 1."""
    i, j = math.floor(x), math.floor(y)
    u, v = (t * t * (3 - 2 * t) for t in (x - i, y - j))
    rows = [hashed(i, j + k) * (1 - u) + hashed(i + 1, j + k) * u for k in (0, 1)]
    return rows[0] * (1 - v) + rows[1] * v


def stroke(u, v, left, right, middle, width, seed):
    """How much dye a stroke of a marker leaves: even within, ragged at its ends, more where it begins."""
    edge = 0.012 * (noise(40 * u, seed) - 0.5)
    across = abs(v - middle - edge) / (0.5 * width)
    along = min(u - left, right - u) / 0.02 + noise(60 * v, seed + 7) - 0.5
    body = 1.0 if across < 0.9 else max(0.0, (1.0 - across) / 0.1)
    return body * min(max(along, 0.0), 1.0) * (0.85 + 0.3 * noise(14 * u, seed + 3))


def highlighter(folder):
    strokes = [(0.08, 0.72, 0.22, 0.13), (0.2, 0.92, 0.5, 0.13), (0.08, 0.55, 0.78, 0.13), (0.42, 0.9, 0.78, 0.13)]

    def dye(u, v):
        amount = sum(stroke(u, v, *one, seed) for seed, one in enumerate(strokes))
        return (min(amount / 2.0, 1.0),) * 3

    def print_of(u, v):
        line, place = divmod(v * 14.0, 1.0)
        word = hashed(int(u * 22 + 3 * hashed(int(line), 1)), int(line)) > 0.18
        letter = hashed(int(u * 150), int(line), 5) > 0.4
        is_ink = 0.3 < place < 0.65 and 0.08 < u < 0.92 and word and letter
        return (0.0 if is_ink else 1.0,) * 3

    write_png(folder / "strokes.png", 384, 256, dye)
    write_png(folder / "print.png", 960, 640, print_of)


def varnish(folder):
    def horizon(u):
        return 0.56 + 0.1 * math.sin(6.7 * u) + 0.06 * (noise(11 * u, 9) - 0.5)

    def shade(u, v):
        """How light the ground is, or the sky with its sun."""
        x, y = 3.2 * u, 3.2 * v
        if v > horizon(u):
            return (noise(7 * x, 11 * y),) * 3
        sun = 1.0 if (u - 0.74) ** 2 + 0.6 * (v - 0.22) ** 2 < 0.004 else 0.0
        return (max(sun, min(1.0, max(0.0, noise(2.2 * x, 5 * y) - 0.4) * 1.7)),) * 3

    def is_varnished(u, v):
        return u > 0.5 + 0.03 * math.sin(9 * v) + 0.02 * (noise(18 * v, 2) - 0.5)

    def mask(condition):
        return lambda u, v: (1.0 if condition(u, v) else 0.0,) * 3

    write_png(folder / "shade.png", 384, 288, shade)
    write_png(folder / "ground.png", 384, 288, mask(lambda u, v: v > horizon(u)))
    write_png(folder / "varnished.png", 384, 288, mask(is_varnished))
    write_png(folder / "not-bare-sky.png", 384, 288, mask(lambda u, v: v > horizon(u) or is_varnished(u, v)))


def stone(seed):
    """A polyhedron: what is left of space inside random planes about a ball, face by face."""
    planes = []
    for k in range(22):
        height, angle = 2 * hashed(seed, k, 1) - 1, 2 * math.pi * hashed(seed, k, 2)
        side = math.sqrt(1 - height * height)
        planes.append(((side * math.cos(angle), height, side * math.sin(angle)), 0.82 + 0.18 * hashed(seed, k, 3)))
    points, faces = [], []
    for normal, distance in planes:
        face = square_on(normal, distance)
        for other, reach in planes:
            face = face if other is normal else clipped(face, other, reach)
        if len(face) > 2:
            faces.append(range(len(points), len(points) + len(face)))
            points += face
    return points, faces


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def square_on(normal, distance, size=9.0):
    """A large square on a plane, counter-clockwise seen from the normal's side."""
    u = cross((0.0, 1.0, 0.0) if abs(normal[1]) < 0.9 else (1.0, 0.0, 0.0), normal)
    v = cross(normal, u)
    return [tuple(distance * n + size * (s * a + t * b) for n, a, b in zip(normal, u, v))
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def clipped(face, normal, reach):
    """The part of a polygon behind a plane."""
    kept = []
    for here, there in zip(face, face[1:] + face[:1]):
        h, t = dot(here, normal) - reach, dot(there, normal) - reach
        if h <= 0:
            kept.append(here)
        if (h < 0) != (t < 0) and h != t:
            kept.append(tuple(a + (b - a) * h / (h - t) for a, b in zip(here, there)))
    return kept


def minerals(folder):
    for seed, name in enumerate(("fluorite", "calcite", "willemite"), 1):
        write_obj(folder / f"{name}.obj", *stone(seed))


def vest(folder):
    def body(u, v):
        """Half a torso, open at the back: an ellipse whose width follows the height."""
        angle = math.pi * (u - 0.5) * 1.5
        width = 0.62 - 0.1 * math.sin(math.pi * v) + 0.05 * v
        fold = 0.012 * math.sin(30 * u + 4 * v) * math.sin(math.pi * v)
        return (width + fold) * math.sin(angle), 1.5 * v, (0.42 + fold) * math.cos(angle)

    points, faces, coordinates = grid(120, 60, body)
    write_obj(folder / "vest.obj", points, faces, coordinates)

    def band(u, v):
        level = 1.0 - v
        is_band = abs(level - 0.28) < 0.05 or abs(level - 0.5) < 0.05 or abs(abs(u - 0.5) - 0.17) < 0.022 and level > 0.5
        return (1.0 if is_band else 0.0,) * 3

    write_png(folder / "bands.png", 512, 512, band)


if __name__ == "__main__":
    target = pathlib.Path(sys.argv[2])
    target.mkdir(parents=True, exist_ok=True)
    {"highlighter": highlighter, "varnish": varnish, "minerals": minerals, "vest": vest}[sys.argv[1]](target)
