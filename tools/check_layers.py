#!/usr/bin/env python3
"""Fails when a file includes what its folder may not.

Checks of src/alhazen, apps and bindings:
  - a module (a folder of src/alhazen) includes only the modules below it (MODULES), siblings never each other;
  - a folder inside of a module includes of the same module only the folders below it (INSIDE);
  - no chain of includes leads from a folder, or a file, back to itself;
  - each module and folder of the tables exists, and each folder that exists is in them;
  - a third-party library is included only where it belongs (LIBRARIES);
  - quoted includes are written from src ("alhazen/module/file.h") and exist;
  - a .cpp includes its own header first;
  - headers have #pragma once.

Usage: check_layers.py [ROOT]    or    check_layers.py --self-test
"""

import pathlib
import re
import sys
import tempfile

# Module -> modules that it may include directly; what those may include, it may include too.
MODULES = {
    "base": [],
    "math": ["base"],
    "simd": ["math"],
    "parallel": ["base"],
    "sampling": ["math"],
    "geometry": ["math"],
    "imaging": ["math", "simd", "parallel"],
    "shading": ["sampling", "imaging", "geometry"],
    "cameras": ["geometry", "simd"],
    "shapes": ["geometry", "simd"],
    "accel": ["geometry", "sampling", "simd", "parallel"],
    "scene_model": ["accel", "cameras", "shading", "shapes"],
    "primitives": ["accel", "shading", "shapes"],
    "csg": ["primitives", "scene_model"],
    "aggregates": ["primitives"],
    "scene": ["aggregates", "csg", "scene_model"],
    "illumination": ["scene"],
    "solids": ["scene"],
    "tracer": ["solids"],
    "formats": ["scene_model"],
    "renderers": ["illumination"],
    "verification": ["solids"],
    "session": ["formats", "renderers", "verification"],
    "laboratory": ["session"],
    "explain": ["laboratory"],
    "apps": ["explain"],
    "bindings": ["session", "tracer"],
}

# Rooms outside of src: files are included by their name from files beside them.
OUTSIDE = ("apps", "bindings")
# Headers that programs include as "alhazen/...", wherever they lie.
PUBLIC = "/include/"

# Module -> its folders, each with the folders of the module that it may include directly. "" stands for the files of
# the module itself: without an entry they may include every folder, and no folder includes them.
INSIDE = {
    "accel": {
        "core": [],
        "bounds": ["core"],
        "cells": ["bounds"],
        "directions": ["cells"],
        "wide_bvh/nodes": [],
        "wide_bvh/build": ["wide_bvh/nodes"],
        "wide_bvh/trace": ["wide_bvh/build"],
        "motion": ["core", "wide_bvh/build"],
    },
    "aggregates": {
        "wide_bvh/leaves": [],
        "wide_bvh": ["wide_bvh/leaves"],
        "wide_bvh/packets": ["wide_bvh"],
        "wide_bvh/kernels": ["wide_bvh/packets"],
        "motion": [],
    },
    "explain": {
        "beams": [],
        "cones": [],
        "patches": [],
        "tree": [],
        "spans": [],
        "": ["beams", "cones", "patches", "tree", "spans"],
        "page": [""],
    },
    "formats": {
        "core": [],
        "text": [],
        "mesh": ["core", "text"],
        "patches": ["mesh"],
        "bpt": ["patches"],
        "brlcad": ["mesh"],
        "pictures": ["core"],
        "gltf/document": ["pictures"],
        "gltf/scene": ["gltf/document"],
        "obj": ["mesh", "patches", "pictures"],
        "ply": ["mesh"],
        "stl": ["mesh"],
        "mesh_files": ["obj", "ply", "stl"],
        "patch_files": ["mesh_files"],
        "native": ["text"],
        "native/fields": ["mesh", "native"],
        "native/read": ["bpt", "mesh_files", "native/fields"],
        "nff": ["mesh"],
        "ray": ["mesh", "pictures"],
        "rib": ["patches"],
        "uw_yaml": ["mesh_files"],
        "gltf/check": ["gltf/scene"],
        "native/write": ["native/read"],
    },
    "geometry": {
        "": [],
        "cones": [""],
        "mirrors": [],
        "motion": [""],
        "nearest": [""],
        "polygon": [""],
        "facets": ["polygon"],
        "polygon_sets": [""],
        "repair": ["facets", "polygon_sets"],
    },
    "imaging": {
        "image": [],
        "film": ["image"],
        "codecs": ["film"],
        "figures": ["image"],
        "svg": ["image"],
        "drawing": ["svg"],
    },
    "laboratory": {
        "": [],
        "claims": [""],
        "report": [""],
    },
    "renderers": {
        "core/reports": [],
        "core": ["core/reports"],
        "antialias": ["core"],
        "beam_tracing": ["core"],
        "cone_tracing": ["volumes"],
        "lane_carpenter": ["core"],
        "volumes": ["core"],
        "light_transport": ["volumes"],
        "ambient_occlusion": ["light_transport"],
        "manifold": ["light_transport"],
        "path_tracing": ["manifold"],
        "light_tracing": ["path_tracing"],
        "bidirectional": ["path_tracing"],
        "photons": ["light_transport"],
        "photon_mapping": ["photons"],
        "sppm": ["photons"],
        "vcm": ["bidirectional", "photons"],
        "direct_light": ["core"],
        "ray_casting": ["antialias", "direct_light"],
        "whitted": ["antialias", "volumes", "direct_light"],
        "distributed": ["whitted"],
    },
    "sampling": {
        "": [],
        "samplers": [""],
        "analysis": ["samplers"],
    },
    "solids": {
        "": [],
        "triangles": [""],
    },
    "session": {
        "": ["framing", "generators"],
        "conversion": [""],
        "framing": [],
        "scene_info": [""],
        "technical": ["conversion"],
        "generators": [],
    },
    "shading": {
        "lights": [],
        "optics": [],
        "textures": [],
        "materials": ["optics", "textures"],
        "microfacets": ["optics"],
        "spectrum": ["optics"],
        "bsdf": ["microfacets", "materials", "spectrum"],
    },
    "shapes": {
        "core": [],
        "quadrics": ["core"],
        "algebraic": ["quadrics"],
        "blobs": ["algebraic"],
        "meshes": ["core"],
        "nearest": [],
        "patches": ["algebraic", "polygons", "swept"],
        "patches/forms": ["patches", "patches/nurbs", "algebraic", "polygons", "swept"],
        "patches/methods": ["patches"],
        "patches/nurbs": ["patches"],
        "polygons": ["core"],
        "swept": ["core"],
        "tessellation": ["meshes", "patches", "patches/forms", "patches/nurbs"],
    },
}

# Start of an include -> modules that may include it. Unlisted ones (standard, POSIX, fmt) are free.
LIBRARIES = {
    "hwy/": {"simd", "imaging", "shading", "shapes", "cameras", "accel", "primitives", "csg", "aggregates", "illumination", "renderers",
             "verification"},
    "tbb/": {"parallel"},
    "oneapi/": {"parallel"},
    "Imf": {"imaging"},
    "Imath": {"imaging"},
    "OpenEXR/": {"imaging"},
    "png.h": {"imaging"},
    "cairo": {"imaging"},
    "jpeglib.h": {"imaging"},
    "yaml-cpp/": {"formats"},
    "nlohmann/": {"formats", "solids", "session", "laboratory", "explain", "apps", "bindings"},
    "pybind11/": {"bindings"},
    "CLI/": {"apps"},
    "boost/": {"apps"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)
# Files compiled once per instruction set are included repeatedly.
REPEATED = "-inl.h"


def closure(table, name):
    """The entry and all it may include."""
    reached, waiting = set(), [name]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting += table.get(name, [])
    return reached


def allowed_inside(module, folder):
    """The folders of the module that a file in one of them may include."""
    table = INSIDE.get(module, {})
    if folder == "" and "" not in table:
        return set(table) | {""}
    return closure(table, folder)


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.DOTALL)
    return re.sub(r"//[^\n]*", "", text)


class Source:
    """One file: where it is, its module, its folder in the module and what it includes as (line, quote, name)."""

    def __init__(self, path, name, module, folder):
        self.path, self.name, self.module, self.folder = path, name, module, folder
        self.text = without_comments(path.read_text(encoding="utf-8"))
        self.includes = [
            (self.text.count("\n", 0, m.start(2)) + 1, m.group(1), m.group(2))
            for m in INCLUDE.finditer(self.text)
        ]


def read_sources(root):
    """All sources by the name they are included by (outside of src: by path, but for public headers)."""
    sources = {}
    for top in (root / "src" / "alhazen", *(root / module for module in OUTSIDE)):
        for path in sorted(top.rglob("*")) if top.is_dir() else []:
            if path.suffix not in (".h", ".cpp"):
                continue
            inside = path.relative_to(root)
            if inside.parts[0] in OUTSIDE:
                name, module, folder = inside.as_posix().split(PUBLIC)[-1], inside.parts[0], ""
            else:
                name, module = path.relative_to(root / "src").as_posix(), inside.parts[2]
                folder = "/".join(inside.parts[3:-1])
            sources[name] = Source(path, name, module, folder)
    return sources


def check_one_include(source, include, sources):
    line, quote, name = include
    where = f"{source.path}:{line}: "
    for start, modules in LIBRARIES.items():
        if name.startswith(start) and source.module not in modules:
            yield f"{where}<{name}> belongs to {', '.join(sorted(modules))}, not to {source.module}"
    if not name.startswith("alhazen/"):
        beside = (source.path.parent / name).is_file()
        if quote == '"' and not name.startswith("hwy/") and not (source.module in OUTSIDE and beside):
            yield f'{where}write "{name}" from src, as "alhazen/ROOM/FILE.h"'
        return
    if name not in sources:
        yield f'{where}there is no "{name}"'
        return
    other = sources[name]
    if other.module not in closure(MODULES, source.module):
        yield f"{where}{source.module} may not include {other.module} ({name})"
    elif other.module == source.module and other.folder not in allowed_inside(source.module, source.folder):
        yield f"{where}{source.module}/{source.folder} may not include {other.module}/{other.folder} ({name})"


def check_own_header(source, sources):
    if source.path.suffix != ".cpp":
        return
    own = source.name[:-4] + ".h"
    if source.module in OUTSIDE:
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


def check_tables(sources):
    """Entries of the tables without a folder, and folders without an entry."""
    folders = {(s.module, s.folder) for s in sources.values()}
    for module in sorted({module for module, _ in folders} - MODULES.keys()):
        yield f"src/alhazen/{module}: the module is not in MODULES of tools/check_layers.py"
    for module in sorted(MODULES.keys() - {module for module, _ in folders}):
        yield f"tools/check_layers.py: there is no module {module}"
    for where, table in [("MODULES", MODULES), *INSIDE.items()]:
        for name, below in table.items():
            if any(name in closure(table, other) for other in below):
                yield f"tools/check_layers.py: {where}: {name or 'the module itself'} may include itself through others"
    entries = {(module, folder) for module, table in INSIDE.items() for folder in table}
    for module, folder in sorted(entries - folders):
        yield f"tools/check_layers.py: there is no folder {module}/{folder} with sources"
    for module, folder in sorted(folders - entries):
        if folder:
            yield f"src/alhazen/{module}/{folder}: the folder is not in INSIDE of tools/check_layers.py"


def check(root, tables=True):
    """All findings, as lines of text."""
    sources = read_sources(root)
    findings = []
    if not sources:
        findings.append(f"{root}: there is nothing to check")
    if tables:
        findings += check_tables(sources)
    for source in sources.values():
        if source.module not in MODULES:
            continue
        for include in source.includes:
            findings += check_one_include(source, include, sources)
        findings += check_own_header(source, sources)
        header = source.path.suffix == ".h" and not source.name.endswith(REPEATED) and PUBLIC not in str(source.path)
        if header and "#pragma once" not in source.text:
            findings.append(f"{source.path}:1: the header has no #pragma once")
    return findings + list(find_cycles(sources))


GOOD = {
    "src/alhazen/base/a.h": '#pragma once\n#include <string>\n',
    "src/alhazen/base/a.cpp": '#include "alhazen/base/a.h"\n',
    "src/alhazen/math/m.h": '#pragma once\n#include "alhazen/base/a.h"\n',
    "src/alhazen/shapes/quadrics/q.h": '#pragma once\n#include "alhazen/shapes/core/c.h"\n',
    "src/alhazen/shapes/core/c.h": '#pragma once\n',
    "src/alhazen/scene/s.h": '#pragma once\n// #include "alhazen/session/x.h"\n'
                             '#include "alhazen/base/a.h"\n',
    "src/alhazen/imaging/i.cpp": '#include <png.h>\n',
    "apps/cli/c.h": '#pragma once\n',
    "apps/cli/c.cpp": '#include "c.h"\n\n#include "alhazen/scene/s.h"\n',
}

# Changes to GOOD, each with a part of the message it must cause.
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
    ({"src/alhazen/math/n.cpp": '#include <yaml-cpp/yaml.h>\n'}, "belongs to formats"),
    ({"src/alhazen/base/a.cpp": '#include <string>\n#include "alhazen/base/a.h"\n'}, "own header"),
    ({"apps/cli/c.cpp": '#include <string>\n#include "c.h"\n'}, "own header"),
    ({"src/alhazen/base/a.h": '// #pragma once\n'}, "no #pragma once"),
    ({"src/alhazen/shapes/core/c.h": '#pragma once\n#include "alhazen/shapes/quadrics/r.h"\n',
      "src/alhazen/shapes/quadrics/r.h": '#pragma once\n'},
     "shapes/core may not include shapes/quadrics"),
    ({"src/alhazen/math/m.h": '#pragma once\n#include "alhazen/math/n.h"\n',
      "src/alhazen/math/n.h": '#pragma once\n#include "alhazen/math/m.h"\n'}, "in a circle"),
]


def check_tree(files, tables=False):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return check(root, tables)


def self_test():
    failures = []
    if findings := check_tree(GOOD):
        failures.append(f"findings in the good tree: {findings}")
    for change, expected in BAD:
        findings = check_tree({**GOOD, **change})
        if len(findings) != 1 or expected not in findings[0]:
            failures.append(f"expected one finding with {expected!r}, got {findings}")
    # The tables themselves: a module and a folder without entries, and entries without a folder.
    strange = {**GOOD, "src/alhazen/common/c.h": "#pragma once\n", "src/alhazen/shapes/odd/o.h": "#pragma once\n"}
    findings = check_tree(strange, tables=True)
    for expected in ("common: the module is not in MODULES", "shapes/odd: the folder is not in INSIDE",
                     "there is no module tracer", "there is no folder shapes/blobs"):
        if not any(expected in finding for finding in findings):
            failures.append(f"expected a finding with {expected!r}, got {findings}")
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
