"""The shared library as such: what it exports, its name, and programs that were written for Embree.

Usage: library_test.py LIBRARY FOLDER [RENAMED_PROGRAM EMBREE_PROGRAM]...    - for an Embree that is not installed
"""
import re
import subprocess
import sys


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def same(ours, theirs):
    """Whether two words are equal, distances within a unit of their last digit (float32 beside float64)."""
    if ours == theirs:
        return True
    return all(re.fullmatch(r"-?\d+\.\d{3}", word) for word in (ours, theirs)) and abs(float(ours) - float(theirs)) < 0.0015


def main():
    library, folder = sys.argv[1:3]
    symbols = [line.split()[-1] for line in output_of("nm", "-D", "--defined-only", library).splitlines()]
    exported = {symbol.split("@")[0] for symbol in symbols} - {"ALHAZEN_0"}
    with open(f"{folder}/../include/alhazen/alhazen.h", encoding="utf-8") as file:
        declared = set(re.findall(r"\b(alhazen[A-Z]\w*)\(", file.read())) - {"alhazenInitIntersectContext"}
    assert exported == declared, f"exported and not declared, or the reverse: {sorted(exported ^ declared)}"
    assert all("@@ALHAZEN_0" in symbol for symbol in symbols if symbol != "ALHAZEN_0"), symbols
    assert re.search(r"SONAME.*\[libalhazen\.so\.0\]", output_of("readelf", "-d", library))

    for renamed, embree in zip(sys.argv[3::2], sys.argv[4::2]):
        lines = output_of(renamed).splitlines()
        assert lines[-1].endswith("last error 0") and len(lines) > 20, lines
        assert not any("differs" in line for line in lines), lines
        if embree != "-":
            theirs = output_of(embree).splitlines()
            assert len(lines) == len(theirs), f"{len(lines)} lines, of Embree {len(theirs)}"
            for line, other in zip(lines, theirs):
                words, others = line.split(), other.split()
                assert len(words) == len(others) and all(map(same, words, others)), f"{line}\nEmbree: {other}"
        print(f"{renamed}: {len(lines)} lines" + (", as of Embree" if embree != "-" else ""))
    print(f"{len(exported)} functions")


main()
