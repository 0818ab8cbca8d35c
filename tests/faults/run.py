"""Runs the program under faults and prints the table; see tools/faults."""

import argparse
import os
import sys
import time

import device_faults
import disk_faults
import process_faults
from harness import Bench, Unexpected

SUBJECTS = {"disk": disk_faults.FAULTS, "device": device_faults.FAULTS,
            "process": process_faults.FAULTS}


def parse():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--shim", required=True, help="libfault_shim.so")
    parser.add_argument("--full", action="store_true", help="as many tries as the issue wants")
    names = [fault.__name__ for faults in SUBJECTS.values() for fault in faults]
    parser.add_argument("only", nargs="*", metavar="SUBJECT|FAULT",
                        help=f"only these of: {', '.join([*SUBJECTS, *names])}")
    return parser.parse_args()


def chosen(only):
    return [fault for subject, faults in SUBJECTS.items() for fault in faults
            if not only or subject in only or fault.__name__ in only]


def main():
    options = parse()
    full = options.full or "RERADIANT_FULL_TESTS" in os.environ
    bench = Bench(options.program, options.shim, full)
    failed = False
    print("| fault | tries | lost work, s | corrupted files | what happens | took, s |")
    print("| --- | --- | --- | --- | --- | --- |")
    try:
        for fault in chosen(options.only):
            start = time.monotonic()
            try:
                row = fault(bench)
            except Unexpected as error:
                failed = True
                print(f"| {fault.__name__} | | | | UNEXPECTED: {error} | |", flush=True)
                continue
            failed |= row.corrupted > 0
            print(f"| {row.fault} | {row.tries} | {row.lost_seconds:.2f} | {row.corrupted} | "
                  f"{row.outcome} | {time.monotonic() - start:.0f} |", flush=True)
    finally:
        bench.close()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
