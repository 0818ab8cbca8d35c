"""Tests of what counts as the same output, and of what a document that is wrong gets told."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from run_blocks import agrees, line_agrees

HERE = pathlib.Path(__file__).resolve().parent


class Lines(unittest.TestCase):
    def test_last_digit_of_a_number_is_free_and_no_more(self):
        self.assertTrue(line_agrees("XYZ  69.5781 43.3", "XYZ 69.5782 43.3"))
        self.assertTrue(line_agrees("error 1.50e-03", "error 1.49e-03"))
        self.assertFalse(line_agrees("41 bands", "42 bands"))
        self.assertFalse(line_agrees("L* 0.50", "L* 0.52"))
        self.assertFalse(line_agrees("L* 0.50", "L* -0.50"))

    def test_words_are_to_the_letter(self):
        self.assertFalse(line_agrees("valid", "invalid"))
        self.assertFalse(line_agrees("a.b", "axb"))

    def test_seconds_are_of_the_machine(self):
        self.assertTrue(line_agrees("14 iterations in 0.34 s", "14 iterations in 7.1 s"))
        self.assertFalse(line_agrees("14 iterations in 0.34 s", "19 iterations in 0.34 s"))

    def test_dots_stand_for_anything(self):
        self.assertTrue(line_agrees("device: ... (PoCL)", "device: a 2 b (PoCL)"))
        self.assertTrue(agrees(["a", "...", "d"], ["a", "b", "c", "d"]))
        self.assertTrue(agrees(["a", "..."], ["a"]))
        self.assertFalse(agrees(["a", "...", "d"], ["a", "b", "c"]))
        self.assertFalse(agrees(["a"], ["a", "b"]))


class Documents(unittest.TestCase):
    def run_document(self, text):
        with tempfile.TemporaryDirectory() as folder:
            document = pathlib.Path(folder, "a.md")
            document.write_text(text)
            environment = dict(os.environ, RERADIANT_BUILD=folder, RERADIANT_PYTHON=sys.executable)
            run = subprocess.run([sys.executable, "-B", HERE / "run_blocks.py", document, folder + "/run"],
                                 env=environment, capture_output=True, text=True)
        return run.returncode, run.stdout

    def test_variables_and_files_hold_from_block_to_block(self):
        status, printed = self.run_document("```sh\na=1; echo $a > f\n```\n```sh\ncat f; echo $a\n```\n"
                                            "\n```text\n1\n1\n```\n```python\nprint(open('f').read())\n```\n")
        self.assertEqual(status, 0, printed)
        self.assertIn("3 blocks run, 0 failures", printed)

    def test_a_failing_block_and_a_wrong_output_are_named_by_line(self):
        status, printed = self.run_document("```sh\necho 1\n```\n```text\n2\n```\nText.\n\n```sh\nfalse\n```\n")
        self.assertEqual(status, 1)
        self.assertIn("a.md:1: does not print", printed)
        self.assertIn("a.md:9: failed with 1", printed)

    def test_progress_of_a_slow_machine_does_not_count(self):
        status, printed = self.run_document("```sh\necho '4 spp, relMSE 0.021; about 2 min to go' >&2; echo 1\n```\n"
                                            "\n```text\n1\n```\n")
        self.assertEqual(status, 0, printed)

    def test_what_is_not_run_says_why(self):
        status, printed = self.run_document("<!-- not run: it takes a year -->\n```sh\nfalse\n```\n"
                                            "```sh\ntrue\n```\n")
        self.assertEqual(status, 0, printed)
        self.assertIn("a.md:2: not run here: it takes a year", printed)

    def test_a_document_without_blocks_is_no_success(self):
        self.assertEqual(self.run_document("Words.\n")[0], 1)


if __name__ == "__main__":
    unittest.main()
