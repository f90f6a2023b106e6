#!/usr/bin/env python3
"""Puts each fault of faults.txt into a copy of the sources, and tells which test goes red.

usage: run_mutations.py [WORD...]     only faults whose name has one of the words

The copy and its build are kept in build/mutations, so that a second run compiles only what changed. Exit status 1 if a
fault passed unnoticed, or is not to be found in the sources any more.
"""

import dataclasses
import os
import pathlib
import re
import subprocess
import sys

SOURCES = pathlib.Path(__file__).resolve().parents[2]
TREE = SOURCES / "build" / "mutations"
BUILD = TREE / "build" / "test"


@dataclasses.dataclass
class Fault:
    name: str
    file: str
    tests: list
    before: str
    after: str


def read_faults():
    faults = []
    for line in (SOURCES / "test/mutations/faults.txt").read_text().splitlines():
        if line.startswith("== "):
            name, file, tests = line[3:].rsplit(" : ", 2)
            faults.append(Fault(name, file, tests.split(), "", ""))
        elif line.startswith("- "):
            faults[-1].before = line[2:]
        elif line.startswith("+ "):
            faults[-1].after = line[2:]
    return faults


def copy_sources():
    """Files that are alike are left alone, so that nothing of theirs is compiled again."""
    listed = subprocess.check_output(["git", "ls-files", "-z"], cwd=SOURCES).decode().split("\0")
    for name in filter(None, listed):
        source, target = SOURCES / name, TREE / name
        if source.exists() and not (target.exists() and target.read_bytes() == source.read_bytes()):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(source.read_bytes())
            target.chmod(source.stat().st_mode)


def program(test):
    return test.rpartition(":")[2]


def environment(test):
    name, is_set, value = test.rpartition(":")[0].partition("=")
    return os.environ | ({name: value} if is_set else {})


def build(tests):
    return subprocess.run(["ninja", "-C", BUILD, "-j", os.environ.get("JOBS", "1"), *map(program, tests)],
                          capture_output=True, text=True)


def configure(faults):
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DPCL_FLOAM_INSTALL=OFF",
               "-DPCL_FLOAM_WARNINGS_AS_ERRORS=ON"]
    subprocess.run(["cmake", "-S", TREE, "-B", BUILD, *options], check=True, stdout=subprocess.DEVNULL)
    result = build(sorted({test for fault in faults for test in fault.tests}))
    if result.returncode != 0:
        sys.exit(result.stdout)


def red_tests(fault):
    """The tests that fail with the fault in place; nothing if it does not compile, which shows nothing."""
    if build(fault.tests).returncode != 0:
        return None
    red = []
    for test in fault.tests:
        try:
            output = subprocess.run([BUILD / "test" / program(test)], env=environment(test), capture_output=True, text=True,
                                    timeout=600)
        except subprocess.TimeoutExpired:
            return red + [test + " (did not end)"]
        if output.returncode != 0:
            red += re.findall(r"^\[  FAILED  \] ([\w/.]+)(?:,.*)? \(\d+ ms\)$", output.stdout, re.M) or [test + " (crashed)"]
            break
    return red


def try_fault(fault):
    file = TREE / fault.file
    original = file.read_text()
    if original.count(fault.before) != 1:
        return None
    file.write_text(original.replace(fault.before, fault.after))
    try:
        return red_tests(fault)
    finally:
        file.write_text(original)


def main():
    words = sys.argv[1:]
    faults = [f for f in read_faults() if not words or any(word in f.name for word in words)]
    copy_sources()
    configure(faults)
    unnoticed = 0
    for fault in faults:
        red = try_fault(fault)
        if red:
            verdict = f"red: {red[0]}" + (f" and {len(red) - 1} more" if len(red) > 1 else "")
        else:
            unnoticed += 1
            verdict = "STALE: not once there, or it does not compile" if red is None else "UNNOTICED by " + " ".join(fault.tests)
        print(f"{fault.name}: {verdict}", flush=True)
    print(f"{len(faults) - unnoticed} of {len(faults)} faults noticed")
    return 1 if unnoticed else 0


if __name__ == "__main__":
    sys.exit(main())
