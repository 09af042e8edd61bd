#!/usr/bin/env python3
"""Fails when a file includes what its folder may not.

Checks of src/alhazen and apps:
  - a folder includes only the folders below it (TABLE), siblings never each other;
  - a third-party library is included only where it belongs (LIBRARIES);
  - quoted includes are written from src ("alhazen/folder/file.h") and exist;
  - a .cpp includes its own header first;
  - headers have #pragma once, and no chain of includes leads back to its start.

Usage: check_layers.py [ROOT]    or    check_layers.py --self-test
"""

import pathlib
import re
import sys
import tempfile

# Folder -> the folders it may include directly; what those may include, it may too.
TABLE = {
    "base": [],
    "math": ["base"],
    "simd": ["base"],
    "parallel": ["base"],
    "geometry": ["math", "base"],
    "sampling": ["math"],
    "imaging": ["math"],
    "shading": ["sampling", "imaging", "geometry"],
    "shapes": ["geometry", "simd"],
    "accel": ["geometry", "simd", "parallel"],
    "scene": ["shading", "shapes", "accel"],
    "tracer": ["scene"],
    "renderers": ["scene"],
    "importers": ["scene"],
    "session": ["renderers", "importers"],
    "cluster": ["session"],
    "laboratory": ["session"],
    "apps": ["cluster", "laboratory"],
}

# Start of an include -> the folders that may include it. Unlisted ones (standard, POSIX, fmt) are free.
LIBRARIES = {
    "hwy/": {"simd", "shapes", "accel", "scene"},
    "tbb/": {"parallel"},
    "oneapi/": {"parallel"},
    "Imf": {"imaging"},
    "Imath": {"imaging"},
    "OpenEXR/": {"imaging"},
    "png.h": {"imaging"},
    "jpeglib.h": {"imaging"},
    "yaml-cpp/": {"importers"},
    "nlohmann/": {"importers", "session", "laboratory", "cluster", "apps"},
    "CLI/": {"apps"},
    "mpi.h": {"cluster"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
# Texts compiled once per instruction set are included again and again on purpose.
REPEATED = "-inl.h"


def closure(folder):
    """The folder and all it may include."""
    reached, waiting = set(), [folder]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += TABLE[name]
    return reached


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.DOTALL)
    return re.sub(r"//[^\n]*", "", text)


class Source:
    """One file: where it is, its folder in TABLE and what it includes as (line, quote, name)."""

    def __init__(self, path, name, folder):
        self.path, self.name, self.folder = path, name, folder
        self.text = without_comments(path.read_text(encoding="utf-8"))
        self.includes = [
            (self.text.count("\n", 0, m.start(2)) + 1, m.group(1), m.group(2))
            for m in INCLUDE.finditer(self.text)
        ]


def read_sources(root):
    """All sources by the name they are included by (apps: by path)."""
    sources = {}
    for top in (root / "src" / "alhazen", root / "apps"):
        for path in sorted(top.rglob("*")) if top.is_dir() else []:
            if path.suffix not in (".h", ".cpp"):
                continue
            inside = path.relative_to(root)
            if inside.parts[0] == "apps":
                name, folder = inside.as_posix(), "apps"
            else:
                name, folder = path.relative_to(root / "src").as_posix(), inside.parts[2]
            sources[name] = Source(path, name, folder)
    return sources


def check_one_include(source, include, sources):
    line, quote, name = include
    where = f"{source.path}:{line}: "
    for start, folders in LIBRARIES.items():
        if name.startswith(start) and source.folder not in folders:
            yield f"{where}<{name}> belongs to {', '.join(sorted(folders))}, not to {source.folder}"
    if not name.startswith("alhazen/"):
        beside = (source.path.parent / name).is_file()
        if quote == '"' and not name.startswith("hwy/") and not (source.folder == "apps" and beside):
            yield f'{where}write "{name}" from src, as "alhazen/FOLDER/FILE.h"'
        return
    if name not in sources:
        yield f'{where}there is no "{name}"'
    elif sources[name].folder not in closure(source.folder):
        yield f"{where}{source.folder} may not include {sources[name].folder} ({name})"


def check_own_header(source, sources):
    if source.path.suffix != ".cpp":
        return
    own = source.name[:-4] + ".h"
    if source.folder == "apps":
        exists, own = source.path.with_suffix(".h").is_file(), source.path.with_suffix(".h").name
    else:
        exists = own in sources
    if exists and (not source.includes or source.includes[0][2] != own):
        yield f'{source.path}:1: the first include must be the own header "{own}"'


def find_cycles(sources):
    """Each chain of includes that leads back to its start, once."""
    state = {}  # 1: on the path, 2: done

    def visit(name, path):
        state[name] = 1
        for _, _, included in sources[name].includes:
            if included not in sources or included == name:
                continue
            if state.get(included) == 1:
                chain = path[path.index(included):] + [included]
                yield f"{sources[name].path}:1: includes in a circle: {' -> '.join(chain)}"
            elif included not in state:
                yield from visit(included, path + [included])
        state[name] = 2

    for name in sources:
        if name not in state:
            yield from visit(name, [name])


def check(root):
    """All findings, as lines of text."""
    sources = read_sources(root)
    findings = []
    if not sources:
        findings.append(f"{root}: there is nothing to check")
    for source in sources.values():
        if source.folder not in TABLE:
            findings.append(f"{source.path}:1: the folder {source.folder} is not in the table of "
                            "tools/check_layers.py")
            continue
        for include in source.includes:
            findings += check_one_include(source, include, sources)
        findings += check_own_header(source, sources)
        header = source.path.suffix == ".h" and not source.name.endswith(REPEATED)
        if header and "#pragma once" not in source.text:
            findings.append(f"{source.path}:1: the header has no #pragma once")
    return findings + list(find_cycles(sources))


GOOD = {
    "src/alhazen/base/a.h": '#pragma once\n#include <string>\n',
    "src/alhazen/base/a.cpp": '#include "alhazen/base/a.h"\n',
    "src/alhazen/math/m.h": '#pragma once\n#include "alhazen/base/a.h"\n',
    "src/alhazen/scene/s.h": '#pragma once\n// #include "alhazen/session/x.h"\n'
                             '#include "alhazen/base/a.h"\n',
    "src/alhazen/imaging/i.cpp": '#include <png.h>\n',
    "apps/cli/c.h": '#pragma once\n',
    "apps/cli/c.cpp": '#include "c.h"\n\n#include "alhazen/scene/s.h"\n',
}

# What is changed in GOOD, and a part of the message it must cause.
BAD = [
    ({"src/alhazen/base/b.h": '#pragma once\n#include "alhazen/math/m.h"\n'},
     "b.h:2: base may not include math"),
    ({"src/alhazen/shapes/s.h": '#pragma once\n',
      "src/alhazen/accel/l.h": '#pragma once\n#include "alhazen/shapes/s.h"\n'},
     "accel may not include shapes"),
    ({"src/alhazen/math/n.cpp": '/* one\ntwo */ \n#  include   "alhazen/scene/s.h"\n'},
     "n.cpp:3: math may not include scene"),
    ({"src/alhazen/math/n.cpp": '#include "m.h"\n'}, "from src"),
    ({"src/alhazen/math/n.cpp": '#include "alhazen/base/none.h"\n'}, "there is no"),
    ({"src/alhazen/math/n.cpp": '#include <yaml-cpp/yaml.h>\n'}, "belongs to importers"),
    ({"src/alhazen/base/a.cpp": '#include <string>\n#include "alhazen/base/a.h"\n'}, "own header"),
    ({"apps/cli/c.cpp": '#include <string>\n#include "c.h"\n'}, "own header"),
    ({"src/alhazen/base/a.h": '// #pragma once\n'}, "no #pragma once"),
    ({"src/alhazen/common/c.h": '#pragma once\n'}, "not in the table"),
    ({"src/alhazen/math/m.h": '#pragma once\n#include "alhazen/math/n.h"\n',
      "src/alhazen/math/n.h": '#pragma once\n#include "alhazen/math/m.h"\n'}, "in a circle"),
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
