"""The shared library as such: what it exports, its name, and a program that was written for Embree.

Usage: library_test.py LIBRARY RENAMED_PROGRAM FOLDER [EMBREE_PROGRAM]
"""
import re
import subprocess
import sys


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def main():
    library, renamed, folder = sys.argv[1:4]
    symbols = [line.split()[-1] for line in output_of("nm", "-D", "--defined-only", library).splitlines()]
    exported = {symbol.split("@")[0] for symbol in symbols} - {"ALHAZEN_0"}
    with open(f"{folder}/../include/alhazen/alhazen.h", encoding="utf-8") as file:
        declared = set(re.findall(r"\b(alhazen[A-Z]\w*)\(", file.read())) - {"alhazenInitIntersectContext"}
    assert exported == declared, f"exported and not declared, or the reverse: {sorted(exported ^ declared)}"
    assert all("@@ALHAZEN_0" in symbol for symbol in symbols if symbol != "ALHAZEN_0"), symbols
    assert re.search(r"SONAME.*\[libalhazen\.so\.0\]", output_of("readelf", "-d", library))

    printed = output_of(renamed)
    lines = printed.splitlines()
    assert lines[-1] == "last error 0" and len(lines) > 20, printed
    if len(sys.argv) > 4:
        theirs = output_of(sys.argv[4])
        assert printed == theirs, f"--- renamed\n{printed}\n--- Embree\n{theirs}"
    print(f"{len(exported)} functions; the program printed {len(lines)} lines")


main()
