"""The numbers of cases in tests/README.md are in the names of the tests that it names, and in one spelling."""

import pathlib
import re
import unittest

TESTS = pathlib.Path(__file__).resolve().parents[1]
SPELLING = re.compile(r"Case(\d\d+)(?=[A-Z])")


def rows():
    """Numbers of cases with the files that hold them, of the table in tests/README.md."""
    for line in (TESTS / "README.md").read_text().splitlines():
        match = re.match(r"\| (\d+(?:, \d+)*) ", line)
        if match:
            files = re.findall(r"`([a-z_]+/test_[a-z_]+\.cpp)`", line)
            yield [int(number) for number in match[1].split(", ")], files


def names_in(file):
    """Names of tests, and of the cases of those that take parameters."""
    text = (TESTS / file).read_text()
    return re.findall(r"^TEST(?:_F|_P)?\(\w+, (\w+)\)", text, re.MULTILINE) + re.findall(r'"(Case\w+)"', text)


class Cases(unittest.TestCase):
    def test_every_file_of_a_row_has_a_test_of_that_number(self):
        missing = [f"{file}: Case{number:02}" for numbers, files in rows() for number in numbers for file in files
                   if not any(f"{number:02}" in SPELLING.findall(name) for name in names_in(file))]
        self.assertEqual(missing, [])

    def test_every_test_of_a_number_stands_in_its_row(self):
        named = {}
        for numbers, files in rows():
            for number in numbers:
                named.setdefault(number, set()).update(files)
        self.assertGreater(len(named), 50)
        stray = [f"{file.relative_to(TESTS)}: {name}" for file in TESTS.rglob("test_*.cpp") for name in names_in(file)
                 for number in SPELLING.findall(name)
                 if str(file.relative_to(TESTS)) not in named.get(int(number), set())]
        self.assertEqual(stray, [])

    def test_numbers_are_spelt_one_way(self):
        odd = [f"{file.relative_to(TESTS)}: {name}" for file in TESTS.rglob("test_*.cpp") for name in names_in(file)
               if len(re.findall(r"[Cc]ases?_?\d", name)) != len(SPELLING.findall(name))]
        self.assertEqual(odd, [])


if __name__ == "__main__":
    unittest.main()
