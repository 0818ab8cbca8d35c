"""Tests of the tables that are made of what programs print."""

import contextlib
import io
import unittest

import document_tables


def made(name, text):
    output = io.StringIO()
    with contextlib.redirect_stdout(output):
        document_tables.MAKERS[name](text)
    return output.getvalue()


class Makers(unittest.TestCase):
    def test_presets_that_adding_does_not_take_and_models_that_make_energy(self):
        printed = ("| preset | " + " | ".join("abcdefghi") + " |\n|" + " --- |" * 10 + "\n"
                   "| lacquer | 0.098 | -2.1 % | 3.6 % | 0.4 % | 58.3 % | 58.3 % | 9.0 % | 1.0 %, 2.0 % "
                   "| 0.111 / 0.110 / 1.002 **over** |\n"
                   "[info] brass: something that is logged\n"
                   "| brass | 0.522 | refused | | | 208.7 % | 208.7 % | 9.9 % | 1.5 %, 2.5 % | 0.600 / - / 0.127 |\n")
        rows = made("model_errors", printed).splitlines()[2:]
        self.assertEqual(rows, ["| lacquer | 0.098 | -2.1 %, 3.6 % | 58.3 %, 58.3 % | 1.002 |",
                                "| brass | 0.522 | not for it | 208.7 %, 208.7 % | 0.127 |"])

    def test_recovery_is_summed_up_by_stack(self):
        heading = "| stack | " + " | ".join("abcdefghijk") + " |\n| --- |" + " --- |" * 11 + "\n"
        printed = heading + ("| bare | 10 | 1 | 1 | 0.1 | 0.02 | 0.18 | 0.00 | 95.6 | +4.30 | 0.3 |  |\n"
                             "| bare | 10 | 2 | 2 | 0.1 | 0.03 | 0.50 | 0.00 | 99.1 | -1.00 | 12.4 |  |\n"
                             "| rough | 10 | 1 | 1 | 0.1 | 0.02 | 0.14 | 0.04 | 95.0 | -2.00 | 0.4 |  |\n"
                             "| rough | 10 | 2 | 2 | 0.1 | 0.02 | 0.15 | 17.60 | 96.0 | 0.00 | 1.4 |  |\n"
                             "| rough | 5 | 2 | 2 | 0.1 | 0.02 | 9.00 | 17.60 | 96.0 | 0.00 | 1.4 |  |\n")
        rows = made("recovery_10nm", printed).splitlines()[2:]
        self.assertEqual(rows, ["| bare | 0.18 to 0.50 | | 95.6 to 99.1 % | 4.3 % | 1 of 2 | 0.3 to 12 |",
                                "| rough | 0.14 to 0.15 | 0.04 to 17.6 | 95.0 to 96.0 % | 2.0 % | 2 of 2 "
                                "| 0.4 to 1.4 |"])

    def test_errors_of_methods_in_a_row_and_their_ratios(self):
        rows = [("comb", "29.1e-6", "-0.85", "0", "0.19", "0.7"),
                ("comb+adaptive (winner)", "12.2e-6", "-0.9", "0", "0.24", "0.86"),
                ("comb:16", "0.022", "-0.1", "0.0219", "-", "-"),
                ("weidlich-wilkie", "12.4e-6", "-0.9", "0", "0.2", "0.7"),
                ("hero:4", "0.0142", "-0.5", "0", "-", "-"), ("hero:8", "0.0078", "-0.51", "0", "8.47", "-"),
                ("hero:16", "0.0049", "-0.52", "0", "5.91", "-")]
        table = ("| method | a | b | c | d | e |\n| --- | --- | --- | --- | --- | --- |\n" +
                 "".join("| " + " | ".join(row) + " |\n" for row in rows))
        scenes = [f"\n{name}, 10 s a method\n\n{table}" for name in ("fluorescent-bare", "fluorescent-room")]
        lines = made("error_table", "".join(scenes)).splitlines()
        self.assertEqual(lines[2], "| fluorescent-bare | comb+adaptive | 1.2e-5, 2.9e-5, 1.4e-2, 7.8e-3, 4.9e-3 | "
                         "0.24, 0.19, -, 8.5, 5.9 | 0.86, 0.70, -, -, - |")
        self.assertIn("error of hero over comb: 168.3849 to 487.9725", lines)
        self.assertIn("slopes of hero: -0.52 to -0.50", lines)
        self.assertIn("floor of comb:16 in fluorescent-bare: 0.0219", lines)

    def test_fits_of_measured_data(self):
        heading = "| data | model | a | b | c | d | e | f |\n| --- |" + " --- |" * 7 + "\n"
        printed = heading + "".join(f"| PAPER | {name} | 1 | 360 | {error} | 0.16 | 12 | 6.0e-09 |\n" for name, error in
                                    (("factors, rank 1", "0.0560"), ("factors, rank 1, 200 bytes", "0.0565"),
                                     ("factors, rank 3", "0.0311"), ("matrix", "0.0135")))
        self.assertEqual(made("fit_measured", printed).splitlines()[2],
                         "| PAPER | 0.0560 | 0.0565 | 0.0311 | 0.2 | 0.0135 | 0.2 |")


if __name__ == "__main__":
    unittest.main()
