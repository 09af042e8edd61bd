#!/usr/bin/env python3
"""Every test of a GoogleTest program runs in exactly one entry of CTest.

Usage: entries_test.py CTEST BUILD_FOLDER

Entries of a program divide its tests by filters and shards. Of entries with one filter all shards must be there; of two
filters none may name the same test; together they name all. Left out are programs that are not built, programs of heavy
entries alone that are older than the everyday ones (the target `all` does not build them), and heavy entries of programs
whose everyday entries have all of their tests. Of the program that repeats tests with other kernels, each
pattern names some.
"""

import collections
import fnmatch
import json
import os
import pathlib
import subprocess
import sys
import unittest

CTEST, BUILD = sys.argv[1], sys.argv[2]
FILTER = "--gtest_filter="
# Runs some suites of others again.
REPEATS = "alhazen_portable_kernels_test"
# Programs of heavy entries alone.
HEAVY = ("alhazen_heavy_test", REPEATS)
# No GoogleTest programs.
OTHERS = ("alhazen_c_api_test", "alhazen_c_callbacks_test", "alhazen_c_threads_test")


def test_names(program, *options):
    """The tests that a program lists."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith("GTEST_")}
    text = subprocess.run([program, "--gtest_list_tests", *options], env=environment, capture_output=True, text=True,
                          check=True).stdout
    names, suite = [], ""
    for line in text.splitlines():
        word = line.split("#")[0].rstrip()
        if word.startswith("  "):
            names.append(suite + word.strip())
        elif word.endswith("."):
            suite = word.strip()
    return names


def entries_of_programs():
    """Of each program: its shards (index, number) by filter."""
    text = subprocess.run([CTEST, "--test-dir", BUILD, "--show-only=json-v1"], capture_output=True, text=True,
                          check=True).stdout
    programs = collections.defaultdict(lambda: collections.defaultdict(list))
    for test in json.loads(text)["tests"]:
        # They begin with the program, or with `nice`.
        words = test.get("command", [])
        program = next((w for w in words if w.endswith("_test") and os.access(w, os.X_OK)), None)
        if program is None or pathlib.Path(program).name in OTHERS:
            continue
        properties = {p["name"]: p["value"] for p in test["properties"]}
        if properties.get("LABELS") == ["heavy"] and pathlib.Path(program).name not in HEAVY:
            continue
        environment = dict(variable.split("=", 1) for variable in properties.get("ENVIRONMENT", []))
        shard = int(environment.get("GTEST_SHARD_INDEX", 0)), int(environment.get("GTEST_TOTAL_SHARDS", 1))
        pattern = "".join(word[len(FILTER):] for word in words if word.startswith(FILTER))
        programs[program][pattern].append(shard)
    built = {program: os.stat(program).st_mtime for program in programs}
    newest = max((time for program, time in built.items() if pathlib.Path(program).name not in HEAVY), default=0)
    return {program: filters for program, filters in programs.items()
            if pathlib.Path(program).name not in HEAVY or built[program] >= newest}


class Entries(unittest.TestCase):
    def test_divide_the_tests_of_their_program(self):
        programs = entries_of_programs()
        self.assertGreater(len(programs), 0)
        for program, filters in programs.items():
            with self.subTest(program=pathlib.Path(program).name):
                run = []
                for pattern, shards in filters.items():
                    number = shards[0][1]
                    self.assertEqual(sorted(shards), [(k, number) for k in range(number)], pattern)
                    run += test_names(program, *([FILTER + pattern] if pattern else []))
                self.assertGreater(len(run), 0)
                self.assertEqual(len(run), len(set(run)))
                names = test_names(program)
                if pathlib.Path(program).name != REPEATS:
                    self.assertEqual(sorted(run), sorted(names))
                    continue
                for pattern in ":".join(filters).split(":"):
                    self.assertTrue(fnmatch.filter(names, pattern), f"no test is named {pattern}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
