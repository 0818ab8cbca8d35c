"""Tests of what counts as the same figure, and of what a document that is wrong gets told."""

import pathlib
import tempfile
import unittest
from unittest import mock

import claim_list
import documents
import readings
import run

CLAIM = """
[[claim]]
name = "price"
document = "a.md"
text = "It takes {} s, or {} times as long"
figures = [
  { shown = "2.50", output = 'took (\\S+)', within = "x2" },
  { shown = "1.3", output = 'took (\\S+)', times = 0.5 },
]
command = "echo took 2.60"
seconds = 1
machine = true
recorded = "2026-01-01"
"""
TABLE = """
[[table]]
name = "sizes"
document = "a.md"
header = "| what | size |"
command = "printf '| what | size |\\n| --- | --- |\\n| a | 1.01 of 2 |\\n'"
seconds = 1
within = { "size" = "0.05" }
"""
DOCUMENT = "# A\n\nIt takes 2.50 s, or\n  1.3 times as long.\n\n| what | size |\n| --- | --- |\n| a | 1.00 of 2 |\n"


class Figures(unittest.TestCase):
    def test_half_a_unit_of_the_last_digit_is_free_and_no_more(self):
        self.assertTrue(readings.holds("0.52", 0.524))
        self.assertFalse(readings.holds("0.52", 0.526))
        self.assertTrue(readings.holds("1.5e-3", 1.54e-3))
        self.assertFalse(readings.holds("1.5e-3", 1.56e-3))
        self.assertTrue(readings.holds("4,000", 4000.0))
        self.assertFalse(readings.holds("21", 22.0))

    def test_tolerances(self):
        self.assertTrue(readings.holds("10", 12.0, "x2"))
        self.assertFalse(readings.holds("10", 21.0, "x2"))
        self.assertFalse(readings.holds("10", -10.0, "x2"))
        self.assertTrue(readings.holds("0", 0.0, "x2"))
        self.assertTrue(readings.holds("2.00", 2.09, "5 %"))
        self.assertFalse(readings.holds("2.00", 2.2, "5 %"))
        self.assertTrue(readings.holds("0.7", 0.1, bound="most"))
        self.assertFalse(readings.holds("0.7", 0.71, bound="most"))
        self.assertFalse(readings.holds("0.7", float("nan"), bound="most"))

    def test_new_numbers_have_as_many_digits(self):
        for shown, value, wanted in (("2.48", 2.6, "2.60"), ("1.2e-5", 3.45e-6, "3.5e-6"), ("4,000", 5000, "5,000"),
                                     ("57", 61.2, "61")):
            self.assertEqual(readings.written_like(shown, value), wanted)


class Checkout(unittest.TestCase):
    """A checkout of one document and one list."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "list").mkdir()
        (self.root / "tables").mkdir()
        (self.root / "list/a.toml").write_text(CLAIM + TABLE)
        (self.root / "a.md").write_text(DOCUMENT)
        (self.root / "tables/sizes.md").write_text("| what | size |\n| --- | --- |\n| a | 1.00 of 2 |\n")
        for patch in (mock.patch.object(claim_list, "HERE", self.root), mock.patch.object(run, "ROOT", self.root),
                      mock.patch.object(readings, "ROOT", self.root)):
            patch.start()
            self.addCleanup(patch.stop)

    def faults(self):
        claims, plain = claim_list.load(self.root / "list")
        texts = run.Documents(["a.md"])
        return [fault for claim in claims for fault in run.document_faults(claim, texts)] + \
            run.uncovered_faults(claims, plain, texts)

    def change(self, old, new, file="a.md"):
        text = (self.root / file).read_text()
        self.assertIn(old, text)
        (self.root / file).write_text(text.replace(old, new, 1))

    def test_a_document_as_the_list_says_is_right(self):
        self.assertEqual(self.faults(), [])

    def test_another_figure_in_a_sentence_is_named_by_its_line(self):
        self.change("1.3 times", "1.4 times")
        self.assertEqual(self.faults(), ["a.md:4: shows 1.4, the list has 1.3"])

    def test_another_figure_in_a_table_is_named_by_its_line(self):
        self.change("1.00 of", "1.02 of")
        self.assertEqual(len(self.faults()), 1)
        self.assertIn("a.md:8: shows\n    | a | 1.02 of 2 |", self.faults()[0])

    def test_words_that_are_gone_and_figures_that_nothing_covers_are_told(self):
        self.change("It takes", "It took")
        self.assertEqual(len(self.faults()), 3)
        self.assertIn("stand there 0 times", self.faults()[0])
        self.assertEqual(self.faults()[1:], ["a.md:3: no claim covers 2.50", "a.md:4: no claim covers 1.3"])

    def test_code_and_plain_words_need_no_claim(self):
        self.change("# A\n", "# A\n\n`x = 0.5` and version 1.25.\n\n```sh\nx=0.75\n```\n")
        self.assertEqual(self.faults(), ["a.md:3: no claim covers 1.25"])
        with open(self.root / "list/a.toml", "a") as file:
            file.write('[[plain]]\ndocument = "a.md"\ntext = "version 1.25."\nwhy = "a version"\n')
        self.assertEqual(self.faults(), [])

    def test_what_a_command_gives_is_compared(self):
        claims, _ = claim_list.load(self.root / "list")
        self.assertEqual([run.run_faults(claim, readings.Output(claim.command)) for claim in claims], [[], []])
        claims[0].command, claims[1].command = "echo took 5.2", claims[1].command.replace("1.01", "1.07")
        wrong = [run.run_faults(claim, readings.Output(claim.command)) for claim in claims]
        self.assertEqual(wrong[0], ["the list has 2.50 (x2), the command gives 5.2",
                                    "the list has 1.3 (last digit), the command gives 2.6"])
        self.assertEqual(wrong[1], ["a, size: recorded is '1.00 of 2', the command gives '1.07 of 2'"])

    def test_a_command_that_fails_is_a_fault(self):
        with self.assertRaisesRegex(readings.NotRead, "ends with 3: oops"):
            readings.Output("echo oops >&2; exit 3")

    def test_what_is_written_is_right_afterwards(self):
        self.change("took 2.60", "took 3.10", "list/a.toml")
        claims, _ = claim_list.load(self.root / "list")
        texts = run.Documents(["a.md"])
        for claim in claims:
            output = readings.Output(claim.command)
            run.take_in(claim, output)
            run.rewrite(claim, texts)
        texts.write()
        self.assertEqual(self.faults(), [])
        self.assertIn("It takes 3.10 s, or\n  1.6 times", (self.root / "a.md").read_text())
        self.assertIn("| a | 1.01 of 2 |", (self.root / "a.md").read_text())
        self.assertIn('shown = "3.10"', (self.root / "list/a.toml").read_text())

    def test_entries_that_are_not_whole_are_refused(self):
        for old, new in (("seconds = 1\nmachine", "machine"), ("or {} times", "or"), ('"price"', '"sizes"'),
                         ("recorded =", "recordd ="), ("'took (\\S+)', times", "'', times")):
            with self.subTest(old):
                (self.root / "list/a.toml").write_text((CLAIM + TABLE).replace(old, new, 1))
                with self.assertRaises(claim_list.WrongList):
                    claim_list.load(self.root / "list")


class TheList(unittest.TestCase):
    def test_documents_are_those_that_are_looked_at(self):
        claims, plain = claim_list.load()
        self.assertEqual({entry.document for entry in claims + plain} - set(documents.DOCUMENTS), set())


if __name__ == "__main__":
    unittest.main()
