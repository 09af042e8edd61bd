#!/usr/bin/env python3
"""The lists of files in CONTRIBUTING.md are complete and exact.

Usage: contributing_test.py BUILD_FOLDER SOURCE_FOLDER

For each list, adds a minimal shape, accelerator, renderer or scene format to a scratch copy of the sources. Then the files that
differ must be exactly those of the list, and the copy must pass its tools/check_layers.py. With all four additions in one
copy, the sources that they concern must compile (-fsyntax-only, with the options of the build's tests), where
ALHAZEN_TEST_THOROUGH=1: as one unit, which reads their headers once, and those added to `src` also each by itself, for a unit
hides includes that are missing. Every day one of those is compiled.
"""

import filecmp
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv[1])
SOURCE = pathlib.Path(sys.argv[2])
THOROUGH = os.environ.get("ALHAZEN_TEST_THOROUGH") == "1"

COPIED = ["apps", "bindings", "docs/reference/formats", "src", "tests/fuzz", "tests/support", "tests/unit", "tools"]

SHAPE_H = """#pragma once
/// The least shape: a sphere by another name.

#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen {

struct Extra {
    static constexpr const char* kName = "extra";
    static constexpr int kMaxHits = Sphere::kMaxHits;
    static constexpr bool kClosed = true;

    Vec3 middle{0, 0, 0};
    double size = 1;

    static constexpr auto kFields =
        std::make_tuple(field("middle", &Extra::middle, Unit::Point, Check::Point),
                        field("size", &Extra::size, Unit::Length, Check::Length));

    void prepare() {}
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
"""
SHAPE_CPP = """#include "alhazen/shapes/quadrics/extra.h"

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Extra::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
}
Box3 Extra::box() const {
    return Sphere{middle, size}.box();
}
Interval Extra::extent(const Vec3& axis) const {
    return Sphere{middle, size}.extent(axis);
}
int Extra::intersect(const Ray& ray, ShapeHit* hits) const {
    return Sphere{middle, size}.intersect(ray, hits);
}
ShapeSurface Extra::surface(const Ray& ray, const ShapeHit& hit) const {
    return Sphere{middle, size}.surface(ray, hit);
}

}  // namespace alhazen
"""
# Random maker, comparison, reader and writer are derived from kFields.
SHAPE_TEST = """#include "alhazen/shapes/quadrics/extra.h"

#include <gtest/gtest.h>

#include "alhazen/formats/native/fields/native_shape_fields.h"
#include "support/random_shapes.h"
#include "support/same_description.h"

namespace alhazen {

TEST(Extra, IsMadeComparedReadAndWritten) {
    testing::Random random(1);
    const AnyShape shape = testing::random_shape<Extra>({random});
    EXPECT_TRUE(testing::same(std::get<Extra>(shape), std::get<Extra>(shape)));
    NativeBlockText block("extra");
    write_native_fields(block, std::get<Extra>(shape));
    EXPECT_FALSE(block.empty());
    [[maybe_unused]] void (*read)(BlockReader&, Extra&) = read_native_fields<Extra>;
}

}  // namespace alhazen
"""

ACCELERATOR_H = """#pragma once
/// The least accelerator: every primitive in turn.

#include "alhazen/accel/core/accelerator.h"

namespace alhazen {

class ExtraAccelerator {
  public:
    static constexpr const char* kName = "extra";
    static constexpr const char* kDescription = "every primitive in turn";
    struct Config {};
    [[nodiscard]] static Config configure(SettingsReader&) { return {}; }
    [[nodiscard]] static ExtraAccelerator build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray&, Visitor& visitor, Stats) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            if (visitor.visit(i)) return;
        }
    }
    [[nodiscard]] std::size_t memory_bytes() const { return sizeof(*this); }

  private:
    std::uint32_t count_ = 0;
};

}  // namespace alhazen
"""
ACCELERATOR_CPP = """#include "alhazen/accel/bounds/extra.h"

namespace alhazen {

ExtraAccelerator ExtraAccelerator::build(const BoundsSource& source, const Config&) {
    ExtraAccelerator extra;
    extra.count_ = static_cast<std::uint32_t>(source.size());
    return extra;
}

}  // namespace alhazen
"""
ACCELERATOR_TEST = """#include "alhazen/accel/bounds/extra.h"

#include <gtest/gtest.h>

namespace alhazen {

static_assert(Accelerator<ExtraAccelerator>);
TEST(Extra, HasAName) {
    EXPECT_STREQ(ExtraAccelerator::kName, "extra");
}

}  // namespace alhazen
"""

RENDERER_TEST = """#include "alhazen/renderers/extra/extra.h"

#include <gtest/gtest.h>

namespace alhazen {

TEST(Extra, IsInTheTable) {
    EXPECT_NE(make_renderer("extra"), nullptr);
}

}  // namespace alhazen
"""

IMPORTER_H = """#pragma once
/// The least scene format: files that begin with "extra", without contents.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class ExtraImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "extra"; }
    [[nodiscard]] const char* description() const override { return "nothing"; }
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
"""
IMPORTER_CPP = """#include "alhazen/formats/extra/extra_importer.h"

namespace alhazen {

int ExtraImporter::recognise(const ImportSource& source) const {
    return source.bytes.starts_with("extra") ? 2 : 0;
}
SceneDescription ExtraImporter::import(const ImportSource& source, Diagnostics&) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    return scene;
}

}  // namespace alhazen
"""
IMPORTER_TEST = """#include "alhazen/formats/extra/extra_importer.h"

#include <gtest/gtest.h>

#include "alhazen/formats/importer_list.h"

namespace alhazen {

TEST(Extra, IsRecognised) {
    const ImportOptions options;
    EXPECT_STREQ(find_importer({"extra", "x", options}).name(), "extra");
}

}  // namespace alhazen
"""


def listed_files(section, family):
    """The files of the numbered list below `## section`, for the new thing `extra`."""
    page = (SOURCE / "CONTRIBUTING.md").read_text(encoding="utf-8")
    text = re.search(rf"^## {section}$(.*?)(?=^## |\Z)", page, re.MULTILINE | re.DOTALL).group(1)
    paths = re.findall(r"^\d+\. `([^`]+)`", text, re.MULTILINE)
    return {re.sub(r"\bx(?=[./_])", "extra", path.replace("FAMILY", family)) for path in paths}


def syntax_command(source, like, root):
    """The command that checks the syntax of a file of `root` with the options of the files below the folder `like`."""
    for entry in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
        if like in pathlib.Path(entry["directory"], entry["file"]).as_posix():
            break
    else:
        raise AssertionError(f"nothing below {like} in compile_commands.json")
    words = shlex.split(entry["command"])
    if "ccache" in pathlib.Path(words[0]).name:
        words = words[1:]
    command, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-include", "-MF", "-MT", "-Xclang"):
            skip = True
        elif word != "-MD":
            command.append(word.replace(str(SOURCE) + "/", str(root) + "/"))
    return command + ["-fsyntax-only", "-Werror=return-type", str(root / source)], entry["directory"]


class Copy:
    """A scratch copy of the sources, and the names of what was written there."""

    def __init__(self, root):
        self.root = root
        self.written = set()
        for name in COPIED:
            shutil.copytree(SOURCE / name, root / name, ignore=shutil.ignore_patterns("__pycache__"))

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")
        self.written.add(name)

    def edit(self, name, *changes):
        """Replaces the first match of each pattern; each must be there."""
        text = (self.root / name).read_text(encoding="utf-8")
        for pattern, replacement in changes:
            text, count = re.subn(pattern, replacement, text, count=1, flags=re.MULTILINE | re.DOTALL)
            if count != 1:
                raise AssertionError(f"{name}: nothing matches {pattern}")
        self.write(name, text)

    def list_source(self, cmake_list, after, new):
        """Adds a line to a CMakeLists.txt, after the one of another source."""
        self.edit(cmake_list, (rf"^( +){re.escape(after)}\n", rf"\g<0>\g<1>{new}\n"))

    def changed(self):
        def same(name):
            return (SOURCE / name).is_file() and filecmp.cmp(self.root / name, SOURCE / name, shallow=False)
        return {name for name in self.written if not same(name)}

    def restore(self):
        for name in self.written:
            if (SOURCE / name).is_file():
                shutil.copy(SOURCE / name, self.root / name)
            else:
                (self.root / name).unlink()
        self.written.clear()


def add_shape(copy):
    copy.write("src/alhazen/shapes/quadrics/extra.h", SHAPE_H)
    copy.write("src/alhazen/shapes/quadrics/extra.cpp", SHAPE_CPP)
    copy.edit("src/alhazen/shapes/shape_list.h",
              (r'^#include "alhazen/shapes/quadrics/frustum.h"\n|^#include "alhazen/shapes/quadrics/hyperboloid.h"\n',
               r'#include "alhazen/shapes/quadrics/extra.h"\n\g<0>'),
              (r"(using AnalyticShapes =\s+ShapeTypes<[^>]*)>", r"\g<1>, Extra>"))
    copy.list_source("src/alhazen/shapes/CMakeLists.txt", "quadrics/sphere.cpp", "quadrics/extra.cpp")
    copy.edit("docs/reference/formats/native.md",
              (r"^\| `sphere` .*?\n", r"\g<0>| `extra` | `middle`, `size` | (0, 0, 0), 1 |\n"))
    copy.write("tests/unit/shapes/quadrics/extra_test.cpp", SHAPE_TEST)
    copy.list_source("tests/unit/CMakeLists.txt", "shapes/quadrics/sphere_test.cpp", "shapes/quadrics/extra_test.cpp")


def add_accelerator(copy):
    copy.write("src/alhazen/accel/bounds/extra.h", ACCELERATOR_H)
    copy.write("src/alhazen/accel/bounds/extra.cpp", ACCELERATOR_CPP)
    copy.edit("src/alhazen/accel/accel_list.h",
              (r'^#include "alhazen/accel/bounds/goldsmith_salmon.h"\n',
               r'#include "alhazen/accel/bounds/extra.h"\n\g<0>'),
              (r"(using BoundAccelerators = std::tuple<[^>]*)>", r"\g<1>, ExtraAccelerator>"))
    copy.list_source("src/alhazen/accel/CMakeLists.txt", "bounds/bounding_volumes.cpp", "bounds/extra.cpp")
    copy.write("tests/unit/accel/extra_test.cpp", ACCELERATOR_TEST)
    copy.list_source("tests/unit/CMakeLists.txt", "accel/cell_grid_test.cpp", "accel/extra_test.cpp")


def add_renderer(copy):
    """The least renderer: ray casting by another name."""
    for suffix in (".h", ".cpp"):
        text = (SOURCE / f"src/alhazen/renderers/ray_casting/ray_casting{suffix}").read_text(encoding="utf-8")
        copy.write(f"src/alhazen/renderers/extra/extra{suffix}",
                   text.replace("renderers/ray_casting/ray_casting.h", "renderers/extra/extra.h")
                   .replace("RayCasting", "ExtraRenderer"))
    copy.edit("src/alhazen/renderers/renderer_list.cpp",
              (r'^#include "alhazen/renderers/ray_casting/ray_casting.h"\n',
               r'#include "alhazen/renderers/extra/extra.h"\n\g<0>'),
              (r"RendererEntry, (\d+)>", lambda m: f"RendererEntry, {int(m[1]) + 1}>"),
              (r'^ *\{"ray_casting".*?\}\},\n',
               lambda m: m[0] + m[0].replace("ray_casting", "extra").replace("RayCasting", "ExtraRenderer")))
    copy.list_source("src/alhazen/renderers/CMakeLists.txt", "ray_casting/ray_casting.cpp", "extra/extra.cpp")
    copy.edit("tools/check_layers.py", (r'^( +)"ray_casting": (\[.*?\]),\n', r'\g<0>\g<1>"extra": \g<2>,\n'))
    copy.write("tests/unit/renderers/extra_test.cpp", RENDERER_TEST)
    copy.list_source("tests/unit/CMakeLists.txt", "renderers/mipmap_test.cpp", "renderers/extra_test.cpp")


def add_scene_format(copy):
    copy.write("src/alhazen/formats/extra/extra_importer.h", IMPORTER_H)
    copy.write("src/alhazen/formats/extra/extra_importer.cpp", IMPORTER_CPP)
    copy.edit("src/alhazen/formats/importer_list.cpp",
              (r'^#include "alhazen/formats/gltf/scene/gltf_importer.h"\n',
               r'#include "alhazen/formats/extra/extra_importer.h"\n\g<0>'),
              (r"^( +)static const NffImporter nff;\n", r"\g<0>\g<1>static const ExtraImporter extra;\n"),
              (r"Importer\*, (\d+)>", lambda m: f"Importer*, {int(m[1]) + 1}>"),
              (r"&nff,", "&nff, &extra,"))
    copy.list_source("src/alhazen/formats/CMakeLists.txt", "core/default_conventions.cpp", "extra/extra_importer.cpp")
    copy.edit("tools/check_layers.py", (r'^( +)"nff": (\[.*?\]),\n', r'\g<0>\g<1>"extra": ["core"],\n'))
    copy.write("tests/unit/formats/extra/extra_test.cpp", IMPORTER_TEST)
    copy.list_source("tests/unit/CMakeLists.txt", "formats/nff/nff_test.cpp", "formats/extra/extra_test.cpp")
    copy.edit("tests/fuzz/CMakeLists.txt", (r"foreach\(importer native ", r"\g<0>extra "))
    copy.write("docs/reference/formats" + "/extra.md", "# Extra\n")


# How, the section of CONTRIBUTING.md, the family named there, and the sources to compile.
ADDITIONS = [
    (add_shape, "Add a shape", "quadrics", [
        "src/alhazen/shapes/quadrics/extra.cpp",
        "src/alhazen/formats/native/read/native_shapes.cpp",
        "src/alhazen/scene/compile.cpp",
        "tests/unit/shapes/quadrics/extra_test.cpp",
    ]),
    (add_accelerator, "Add an accelerator", "bounds", [
        "src/alhazen/accel/bounds/extra.cpp",
        "src/alhazen/accel/accelerator_names.cpp",
        "tests/unit/accel/extra_test.cpp",
    ]),
    (add_renderer, "Add a renderer", "", [
        "src/alhazen/renderers/extra/extra.cpp",
        "src/alhazen/renderers/renderer_list.cpp",
        "tests/unit/renderers/extra_test.cpp",
    ]),
    (add_scene_format, "Add a scene format", "", [
        "src/alhazen/formats/extra/extra_importer.cpp",
        "src/alhazen/formats/importer_list.cpp",
        "tests/unit/formats/extra/extra_test.cpp",
    ]),
]


class Contributing(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.copy = Copy(pathlib.Path(folder.name).resolve())

    def setUp(self):
        self.copy.restore()

    def test_additions_take_the_listed_files(self):
        for add, section, family, _ in ADDITIONS:
            with self.subTest(section):
                self.copy.restore()
                add(self.copy)
                self.assertEqual(self.copy.changed(), listed_files(section, family))
                self.check_layers()

    def test_all_additions_compile_together(self):
        for add, _, _, _ in ADDITIONS:
            add(self.copy)
        self.check_layers()
        sources = [source for _, _, _, own in ADDITIONS for source in own]
        if THOROUGH:
            self.copy.write("unit.cpp", "".join(f'#include "{source}"\n' for source in sources))
            self.check_syntax("unit.cpp")
        # Tests by themselves would take three times as long: most of it for the headers that the unit reads once.
        added = [source for source in sources if source.startswith("src/") and not (SOURCE / source).exists()]
        self.assertEqual(len(added), len(ADDITIONS))
        for source in added if THOROUGH else added[:1]:
            with self.subTest(source):
                self.check_syntax(source)

    def check_syntax(self, source):
        command, at = syntax_command(source, "/alhazen_session_test.dir/", self.copy.root)
        run = subprocess.run(command, cwd=at, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stderr[:4000])

    def check_layers(self):
        layers = subprocess.run([sys.executable, self.copy.root / "tools/check_layers.py", self.copy.root],
                                capture_output=True, text=True, check=False)
        self.assertEqual((layers.returncode, layers.stdout + layers.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
