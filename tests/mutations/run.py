#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Makes wrong edits, one at a time, and sees whether the tests notice.

  tests/mutations/run.py [OPTION]... [NAME]...     all edits, or those whose name contains a NAME

  --build-dir DIR   where it builds (default: build/mutations, configured where it is not yet there)
  --list            names and files only
  --check           only whether every edit still fits its file

Every file *.txt here holds edits:

  === NAME: what is wrong
  file PATH
  build TARGET...
  test COMMAND      (from the build folder; one must fail; several lines: several commands)
  --- old
  the text, which must be there once
  --- new
  what stands there instead

The source is edited in place and put back, also after ctrl-C. The tests run on the source as it is first: one that fails
then, or that runs nothing, says nothing about an edit, and neither does an edit that does not compile. Exit status: 0 all were caught, 1 some were missed or do not fit, 2 wrong use.
"""
import argparse
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class Mutation:
    def __init__(self, place, title):
        self.place = place  # of its definition
        self.name, _, self.what = (part.strip() for part in title.partition(":"))
        self.file = None
        self.targets = []
        self.tests = []
        self.old = []
        self.new = []

    def text(self, lines):
        return "\n".join(lines).strip("\n")

    def problem(self):
        """Why it cannot be made; None: it can."""
        path = ROOT / self.file if self.file else None
        if not path or not path.is_file():
            return f"there is no file {self.file}"
        count = path.read_text().count(self.text(self.old))
        if not self.text(self.old) or count != 1:
            return f"its old text stands {count} times in {self.file}"
        if not self.tests:
            return "it names no test"
        return None


def read_mutations(path):
    mutations, section = [], None
    for number, line in enumerate(path.read_text().split("\n"), 1):
        if line.startswith("=== "):
            mutations.append(Mutation(f"{path.name}:{number}", line[4:]))
            section = "head"
        elif line in ("--- old", "--- new"):
            section = line[4:]
        elif section in ("old", "new"):
            getattr(mutations[-1], section).append(line)
        elif section == "head" and line.strip():
            key, _, value = line.partition(" ")
            if key == "file":
                mutations[-1].file = value
            elif key == "build":
                mutations[-1].targets += value.split()
            elif key == "test":
                mutations[-1].tests.append(value)
            else:
                sys.exit(f"{path.name}:{number}: unknown word '{key}'")
    return mutations


def run(command, folder):
    return subprocess.run(command, cwd=folder, shell=isinstance(command, str), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")


def build(build_dir, targets):
    if not targets:
        return None
    result = run(["cmake", "--build", str(build_dir), "--target", *targets], ROOT)
    return None if result.returncode == 0 else result.stdout[-2000:]


def problem_unedited(command, build_dir, known):
    """Why the test says nothing of an edit, None: it passes as it should. `known`: of the commands tried before."""
    if command not in known:
        result = run(command, build_dir)
        if result.returncode != 0:
            known[command] = f"fails without the edit: {command}\n{result.stdout[-2000:]}"
        elif "--gtest_filter" in command and "[  PASSED  ] 0 tests" in result.stdout:
            known[command] = f"runs no test: {command}"
        else:
            known[command] = None
    return known[command]


def try_one(mutation, build_dir):
    """'caught', 'MISSED' or a reason why it says nothing."""
    path = ROOT / mutation.file
    original = path.read_text()
    try:
        path.write_text(original.replace(mutation.text(mutation.old), mutation.text(mutation.new)))
        if failure := build(build_dir, mutation.targets):
            return "does not compile:\n" + failure
        for test in mutation.tests:
            if run(test, build_dir).returncode != 0:
                return "caught"
        return "MISSED"
    finally:
        path.write_text(original)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build-dir", type=pathlib.Path, default=ROOT / "build/mutations")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    mutations = [m for path in sorted(HERE.glob("*.txt")) for m in read_mutations(path)]
    if options.names:
        mutations = [m for m in mutations if any(name in m.name for name in options.names)]
    if not mutations:
        sys.exit("no edit has this name")
    if options.list:
        for m in mutations:
            print(f"{m.name:32} {m.file}")
        return 0
    unfit = {m: reason for m in mutations if (reason := m.problem())}
    for m, reason in unfit.items():
        print(f"{m.place}: {m.name}: {reason}")
    if options.check:
        print(f"{len(mutations) - len(unfit)} of {len(mutations)} edits fit")
        return 1 if unfit else 0

    build_dir = options.build_dir.resolve()
    known = {}
    if not (build_dir / "build.ninja").exists():
        run(["cmake", "--preset", "release", "-S", str(ROOT), "-B", str(build_dir)], ROOT)
    fit = [m for m in mutations if m not in unfit]
    if failure := build(build_dir, sorted({target for m in fit for target in m.targets})):
        sys.exit(f"the source as it is does not build:\n{failure}")
    caught, missed, useless = 0, [], []
    reasons = {m: next(filter(None, (problem_unedited(test, build_dir, known) for test in m.tests)), None) for m in fit}
    for m in fit:
        result = reasons[m] or try_one(m, build_dir)
        print(f"{m.name:32} {result}   ({m.what})", flush=True)
        caught += result == "caught"
        if result == "MISSED":
            missed.append(m.name)
        elif result != "caught":
            useless.append(m.name)
    # What was built last was wrong.
    build(build_dir, sorted({target for m in mutations for target in m.targets}))
    print(f"{caught} of {len(mutations)} caught, {len(missed)} missed, {len(unfit) + len(useless)} not tried")
    return 0 if caught == len(mutations) else 1


if __name__ == "__main__":
    sys.exit(main())
