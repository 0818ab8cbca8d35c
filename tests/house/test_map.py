"""The map in host/README.md is that of the code, and links of documents lead somewhere."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HOST = ROOT / "host"
MOST_FILES = 25
WITHOUT_HEADER = ["toml_implementation.cpp"]
DOCUMENTS = [ROOT / "README.md", *(ROOT / folder / "README.md" for folder in ("host", "kernels", "spectra", "tests")),
             ROOT / "tools/bench/README.md", *sorted((ROOT / "tools/docs").glob("*.md"))]


def folders_of_map():
    """Rows of the first table of host/README.md, from the top: what a row may include stands above it."""
    rows = re.findall(r"^\| `([a-z]+)` \|", (HOST / "README.md").read_text(), re.MULTILINE)
    return rows


def sources():
    return [path for path in HOST.rglob("*") if path.suffix in (".h", ".cpp")]


def folder_of(path):
    """The folder of host/ that a path below it lies in."""
    return path.parts[0]


def first_include(path):
    return re.search(r'^#include ["<]([^">]+)', path.read_text(), re.MULTILINE)[1]


def homes_of_public_headers():
    """The folder of host/ where a public header's functions are defined; none for types alone."""
    homes = {}
    for path in sources():
        if path.suffix == ".cpp" and first_include(path).startswith("reradiant/"):
            homes.setdefault(first_include(path)[len("reradiant/"):], folder_of(path.relative_to(HOST)))
    return homes


def includes_its_header_first(path):
    """A source has its header's name, or is one of several that define what one header declares."""
    first = pathlib.PurePath(first_include(path))
    if first.stem == path.stem:
        return True
    has_own = path.with_suffix(".h").exists() or (HOST / "reradiant" / f"{path.stem}.h").exists()
    return not has_own and (first.parts[0] == "reradiant" or first.parts[1] == path.relative_to(HOST).parts[0])


class Map(unittest.TestCase):
    def test_every_folder_stands_in_it_once(self):
        built = sorted(path.name for path in HOST.iterdir() if path.is_dir())
        self.assertEqual(sorted(folders_of_map()), built)

    def test_a_folder_includes_only_what_stands_above_it(self):
        place = {folder: index for index, folder in enumerate(folders_of_map())}
        homes = homes_of_public_headers()
        wrong = []
        for path in sources():
            own = folder_of(path.relative_to(HOST))
            for root, included in re.findall(r'^#include "(host|reradiant)/([^"]+)"', path.read_text(), re.MULTILINE):
                other = folder_of(pathlib.PurePath(included)) if root == "host" else homes.get(included, "base")
                if own != "reradiant" and place[other] > place[own]:
                    wrong.append(f"{path.relative_to(ROOT)} includes {root}/{included}")
        self.assertEqual(wrong, [])

    def test_public_headers_include_each_other_alone(self):
        wrong = [f"{path.name}: {included}" for path in (HOST / "reradiant").iterdir()
                 for included in re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)
                 if not included.startswith("reradiant/")]
        self.assertEqual(wrong, [])

    def test_every_public_header_stands_in_its_document(self):
        text = (ROOT / "tools/docs/cpp.md").read_text()
        named = sorted(re.findall(r"^\| `([a-z_]+\.h)` \|", text, re.MULTILINE))
        self.assertEqual(named, sorted(path.name for path in (HOST / "reradiant").iterdir()))

    def test_a_source_includes_first_what_it_defines(self):
        wrong = [str(path.relative_to(ROOT)) for path in sources() if path.suffix == ".cpp"
                 and path.name not in WITHOUT_HEADER and not includes_its_header_first(path)]
        self.assertEqual(wrong, [])

    def test_folders_are_small(self):
        folders = [*HOST.rglob("*"), *(ROOT / "kernels").rglob("*"), *(ROOT / "tools").glob("*")]
        large = {str(folder.relative_to(ROOT)): count for folder in folders if folder.is_dir()
                 for count in [sum(1 for file in folder.iterdir() if file.suffix in (".h", ".cpp", ".cl"))]
                 if count > MOST_FILES}
        self.assertEqual(large, {})

    def test_spectra_and_layers_know_neither_rays_nor_devices(self):
        foreign = re.compile(r"#include <(embree\d|CL)/")
        wrong = [str(path) for folder in ("spectral", "layers") for path in (HOST / folder).rglob("*.*")
                 if foreign.search(path.read_text())]
        self.assertEqual(wrong, [])

    def test_every_file_that_it_names_is_there(self):
        text = (HOST / "README.md").read_text()
        named = re.findall(r"`((?:[a-z_]+/)+[a-z_]+\.(?:h|cpp|cl))`", text)
        self.assertGreater(len(named), 10)
        self.assertEqual([name for name in named if not (HOST / name).exists() and not (ROOT / name).exists()], [])


class Features(unittest.TestCase):
    def test_kernels_ask_for_bits_that_there_are(self):
        """The preprocessor takes a name that nobody defines, a misspelt bit, for 0."""
        kernels = [path for path in (ROOT / "kernels").rglob("*") if path.suffix in (".h", ".cl")]
        defined, asked = {"FEATURE_BIT"}, set()
        for path in kernels:
            text = path.read_text()
            defined |= set(re.findall(r"#define (FEATURE_\w+)", text))
            asked |= set(re.findall(r"\bFEATURE_\w+", text))
        self.assertGreater(len(defined), 20)
        self.assertEqual(sorted(asked - defined), [])

    def test_bits_and_their_names_agree(self):
        blocks = re.findall(r"FEATURE_BIT\((\w+),[^)]*\)\n#elif !defined\((\w+)\)\n#define (\w+) 1\n",
                            (ROOT / "kernels/core/feature_bits.h").read_text())
        self.assertGreater(len(blocks), 20)
        self.assertEqual([block for block in blocks if set(block[1:]) != {"FEATURE_" + block[0].upper()}], [])


class Documents(unittest.TestCase):
    def test_links_lead_somewhere(self):
        broken = []
        for document in DOCUMENTS:
            for target in re.findall(r"\]\(([^)\s]+)\)", document.read_text()):
                path, _, heading = target.partition("#")
                if "://" in target:
                    continue
                file = document.parent / path if path else document
                if not file.exists() or heading and heading not in self.headings_of(file):
                    broken.append(f"{document.relative_to(ROOT)}: {target}")
        self.assertEqual(broken, [])

    @staticmethod
    def headings_of(file):
        titles = re.findall(r"^#+ (.+)$", file.read_text(), re.MULTILINE)
        return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in titles}


if __name__ == "__main__":
    unittest.main()
