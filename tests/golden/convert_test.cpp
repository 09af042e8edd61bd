/// Conversion keeps all bits: a scene of every format, written in the native format and read back,
/// is the same description, compiles to the same scene, and renders to the same image and layers,
/// counts of work included.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "alhazen/base/error.h"
#include "alhazen/session/conversion/convert.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"
#include "support/same_description.h"
#include "support/scratch_folder.h"
#include "support/test_data.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

struct Rendered {
    SceneDescription description;
    RenderResult result;
};

/// Renders as the command line does, at a small size.
Rendered rendered(const fs::path& path) {
    LoadedScene loaded = load(path);
    SceneDescription as_read = loaded.description;
    RenderOptions options;
    options.height = 16;
    options.count_tests = true;
    for (const AovEntry& aov : aov_table()) {
        if (aov.kind != AovKind::Time) options.aovs.add(aov.kind);
    }
    FramingOptions framing;
    framing.aspect = free_aspect(loaded.description.picture, options);
    (void)complete_view(loaded.description, loaded.scene, framing);
    return {std::move(as_read), render(loaded.scene, loaded.description.picture, options)};
}

void expect_same_bits(const Film& a, const Film& b) {
    ASSERT_EQ(a.crop(), b.crop());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.crop().area() * sizeof(Rgb)), 0);
}

void expect_same_bits(const FilmLayers& a, const FilmLayers& b) {
    ASSERT_EQ(a.channels().size(), b.channels().size());
    for (std::size_t i = 0; i < a.channels().size(); ++i) {
        const LayerChannel& x = a.channels()[i];
        const LayerChannel& y = b.channels()[i];
        EXPECT_TRUE(testing::same(x.values, y.values)) << x.name;
        EXPECT_TRUE(testing::same(x.whole, y.whole)) << x.name;
    }
}

void expect_converts(const fs::path& path) {
    SCOPED_TRACE(path.string());
    const ScratchFolder folder;
    const Rendered before = rendered(path);
    const fs::path out = folder.path() / "scene.alhazen";
    const ConvertReport report = convert(before.description, out);
    EXPECT_EQ(report.files.back(), out);
    const Rendered after = rendered(out);
    testing::expect_same(before.description, after.description);
    expect_same_bits(before.result.film, after.result.film);
    expect_same_bits(before.result.layers, after.result.layers);
    EXPECT_EQ(before.result.counters.total_cast(), after.result.counters.total_cast());
}

/// Checks all readable files; unreadable ones are covered by other tests.
void expect_all_convert(const std::vector<fs::path>& files, std::size_t at_least) {
    std::size_t converted = 0;
    for (const fs::path& file : files) {
        try {
            expect_converts(file);
            ++converted;
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::Scene ||
                std::string(error.what()).rfind(file.string(), 0) != 0) {
                ADD_FAILURE() << file << ": " << error.what();
            }
        }
    }
    EXPECT_GE(converted, at_least);
}

TEST(Convert, NativeScenesToTheSameBits) {
    for (const char* name : {"showcase", "cornell", "glass_slab"}) {
        expect_converts(testing::source_folder() / "scenes" / (std::string(name) + ".alhazen"));
    }
}

TEST(Convert, RayScenesToTheSameBits) {
    ALHAZEN_NEEDS_DATA("ray");
    expect_all_convert(testing::files_below("ray", ".ray"), 80);
}

TEST(Convert, CourseYamlToTheSameBits) {
    ALHAZEN_NEEDS_DATA("ray/uw2020_yaml");
    auto files = testing::files_below("ray/uw2020_yaml", ".yml");
    for (auto& file : testing::files_below("ray/uw2020_yaml", ".yaml")) files.push_back(file);
    expect_all_convert(files, 10);
}

TEST(Convert, NffScenesToTheSameBits) {
    ALHAZEN_NEEDS_DATA("nff/spd_small");
    expect_all_convert(testing::files_below("nff/spd_small", ".nff"), 10);
}

TEST(Convert, GltfScenesToTheSameBits) {
    ALHAZEN_NEEDS_DATA("gltf/dev");
    const auto files = testing::tried_of(testing::files_below("gltf/dev", ".gltf"), 4);
    expect_all_convert(files, testing::thorough() ? 38 : 9);
}

TEST(Convert, MeshFilesToTheSameBits) {
    ALHAZEN_NEEDS_DATA("meshes");
    std::vector<fs::path> small;
    for (const auto& file : testing::files_below("meshes", ".obj")) {
        if (fs::file_size(file) < 400'000) small.push_back(file);
    }
    ASSERT_GE(small.size(), 4U);
    expect_all_convert(small, small.size());
    // The same meshes as PLY and STL, written by the converter.
    const ScratchFolder folder;
    for (const char* suffix : {".ply", ".stl", ".obj"}) {
        Diagnostics ignored;
        const fs::path out = folder.path() / (std::string("mesh") + suffix);
        (void)convert(load_description(small.front(), {}, ignored), out);
        expect_converts(out);
    }
}

TEST(Convert, OddScenesToTheSameBits) {
    const fs::path corpus = testing::source_folder() / "tests" / "corpus";
    std::vector<fs::path> files;
    for (const char* folder : {"native", "ray", "nff", "uw_yaml", "gltf"}) {
        if (!fs::exists(corpus / folder)) continue;
        for (const auto& entry : fs::directory_iterator(corpus / folder)) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    expect_all_convert(files, 6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
