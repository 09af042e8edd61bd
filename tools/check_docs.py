#!/usr/bin/env python3
"""Fails when a reference of the documentation leads nowhere or its text breaks a rule.

Checks of the repository:
  - each link of a .md file to a file or folder of the repository leads to one, and each anchor to a heading;
  - each path docs/... that a source, a test, a script or a build file names exists;
  - lines of .md files have at most 120 columns, outside of tables (lines that begin with '|') and code;
  - no comment of src has an empty entry ("Source: none", "Differs: nothing").

Usage: check_docs.py [ROOT]    or    check_docs.py --self-test
"""

import pathlib
import re
import sys
import tempfile
import urllib.parse

COLUMNS = 120

# Folders with documents; of the root only its own files.
DOCUMENTS = ("docs", "bindings", "examples", "scenes", "bench", "tests", "src", "apps", "tools", "scripts")
# Folders whose files name documents by their path from the root.
NAMING = ("src", "apps", "bindings", "tests", "bench", "tools", "scripts", "cmake", "scenes", "examples")
NAMING_SUFFIXES = {".h", ".cpp", ".py", ".txt", ".cmake", ".alhazen", ""}

LINK = re.compile(r"!?\[[^\]]*\]\(([^()\s]+)(?:\s+\"[^\"]*\")?\)")
NAMED = re.compile(r"\bdocs/[A-Za-z0-9_/.-]*[A-Za-z0-9_]")
EMPTY_ENTRY = re.compile(r"(Source: none|Differs: nothing)", re.IGNORECASE)


def lines_of(text):
    """(number, line, whether it is code) for each line of a document."""
    fence = None
    for number, line in enumerate(text.split("\n"), 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if mark and (fence is None or line.strip().startswith(fence)):
            fence = mark.group(1) if fence is None else None
            yield number, line, True
        else:
            yield number, line, fence is not None


def slug(heading):
    """The anchor of a heading."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).strip().replace(" ", "-")


def anchors(text):
    found, counts = set(), {}
    for _, line, code in lines_of(text):
        heading = None if code else re.match(r"#{1,6}\s+(.*)", line)
        if heading:
            name = slug(heading.group(1))
            count = counts.get(name, 0)
            counts[name] = count + 1
            found.add(f"{name}-{count}" if count else name)
    return found


def documents(root):
    found = sorted(root.glob("*.md"))
    for folder in DOCUMENTS:
        found += sorted(path for path in (root / folder).rglob("*.md") if not is_installed(path))
    return found


def is_installed(path):
    """Whether it came with tools from elsewhere: it is not of the repository."""
    return "node_modules" in path.parts


def check_link(root, path, target):
    """What is wrong with a link, or None."""
    if re.match(r"[a-zA-Z][a-zA-Z0-9+.-]*:", target):
        return None
    name, _, anchor = urllib.parse.unquote(target).partition("#")
    other = (path.parent / name).resolve() if name else path.resolve()
    if not other.is_relative_to(root.resolve()):
        return f"the link {target} leads out of the repository"
    if not other.exists():
        return f"the link {target} leads to nothing"
    if anchor and other.suffix == ".md" and anchor not in anchors(other.read_text(encoding="utf-8")):
        return f"the link {target} has no such heading"
    return None


def check_document(root, path):
    text = path.read_text(encoding="utf-8")
    for number, line, code in lines_of(text):
        if code:
            continue
        if len(line) > COLUMNS and not line.startswith("|"):
            yield f"{path}:{number}: {len(line)} columns, at most {COLUMNS}"
    # Links may continue on the next line; code contains none.
    prose = "\n".join("" if code else re.sub(r"`[^`]*`", lambda m: "`" * len(m.group()), line)
                      for _, line, code in lines_of(text))
    for match in LINK.finditer(prose):
        problem = check_link(root, path, match.group(1))
        if problem:
            yield f"{path}:{prose.count(chr(10), 0, match.start()) + 1}: {problem}"


def check_named(root, path):
    if path.name == "check_docs.py":
        return
    text = path.read_text(encoding="utf-8", errors="replace")
    for match in NAMED.finditer(text):
        if not (root / match.group()).exists():
            yield f"{path}:{text.count(chr(10), 0, match.start()) + 1}: there is no {match.group()}"


def check_entries(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        match = EMPTY_ENTRY.search(line)
        if match:
            yield f'{path}:{number}: "{match.group(1)}" says nothing: leave it out'


def check(root):
    """All findings, as lines of text."""
    findings = []
    found = documents(root)
    if not found:
        findings.append(f"{root}: there is nothing to check")
    for path in found:
        findings += check_document(root, path)
    for folder in NAMING:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in NAMING_SUFFIXES and path.is_file() and "corpus" not in path.parts \
                    and not is_installed(path):
                findings += check_named(root, path)
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".h", ".cpp"):
            findings += check_entries(path)
    return findings


GOOD = {
    "README.md": "# Read\n[page](docs/page.md), [place](docs/page.md#the-first-place) and [web](https://example.org/x)\n",
    "docs/page.md": "# Page\n## The first `place`\n[up](../README.md)\n| " + "x" * 130 + " |\n```\n" + "y" * 130
                    + "\n[none](none.md)\n```\n`[none](none.md)`\n",
    "tools/page/node_modules/x/README.md": "[none](none.md)\n" + "y " * 70 + "\n",
    "src/alhazen/base/a.h": "/// Formats: docs/page.md.\n/// Source: Author, \"Title\", 1999.\n",
}

# Changes to GOOD, each with a part of the message it must cause.
BAD = [
    ({"README.md": "[page](docs/none.md)\n"}, "leads to nothing"),
    ({"README.md": "text\n[a long\nname](docs/none.md)\n"}, "README.md:2: the link"),
    ({"README.md": "[page](docs/page.md#second)\n"}, "no such heading"),
    ({"README.md": "[page](../../etc)\n"}, "out of the repository"),
    ({"docs/page.md": "# Page\n# The first place\n" + "z " * 61 + "\n"}, "page.md:3: 122 columns"),
    ({"src/alhazen/base/a.h": "/// See docs/old/page.md.\n"}, "a.h:1: there is no docs/old/page.md"),
    ({"src/alhazen/base/a.h": "/// x\n/// Source: none. Units: m.\n"}, "a.h:2:"),
    ({"src/alhazen/base/a.h": "/// Differs: nothing.\n"}, "Differs: nothing"),
]


def check_tree(files):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check(root)


def self_test():
    failures = []
    if findings := check_tree(GOOD):
        failures.append(f"findings in the good tree: {findings}")
    for change, expected in BAD:
        findings = check_tree({**GOOD, **change})
        if len(findings) != 1 or expected not in findings[0]:
            failures.append(f"expected one finding with {expected!r}, got {findings}")
    return failures


def main():
    arguments = sys.argv[1:]
    if len(arguments) > 1:
        sys.exit(__doc__)
    if arguments == ["--self-test"]:
        findings = self_test()
    else:
        root = arguments[0] if arguments else pathlib.Path(__file__).resolve().parent.parent
        findings = check(pathlib.Path(root))
    for finding in findings:
        print(finding, file=sys.stderr)
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
