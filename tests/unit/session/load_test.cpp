#include "alhazen/session/load.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/session/statistics.h"
#include "support/scratch_folder.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Counts the phases that begin.
class Phases final : public ProgressSink {
  public:
    int loads = 0, builds = 0;

    void update(std::string_view phase, std::size_t done, std::size_t) override {
        loads += phase == "load" && done == 0;
        builds += phase == "build" && done == 0;
    }
};

TEST(Load, TheAggregateIsBuiltWhenItIsAskedFor) {
    const std::filesystem::path path = testing::source_folder() / "scenes/one_plane.alhazen";
    Phases phases;
    LoadOptions options;
    options.progress = &phases;
    const LoadedScene whole = load(path, options);
    EXPECT_EQ(phases.builds, 1);
    options.with_aggregate = false;
    LoadedScene loaded = load(path, options);
    EXPECT_EQ(phases.loads, 2);
    EXPECT_EQ(loaded.scene.aggregate, nullptr);
    RenderOptions render_options;
    render_options.width = 16;
    render_options.height = 12;
    EXPECT_THROW((void)render(loaded, render_options), Error);
    const RenderResult nothing(Film(1, 1, {0, 0, 1, 1}));
    const auto report = statistics("none", loaded, render_options, nothing, 0.0);
    EXPECT_TRUE(report["accelerator"].is_null());
    EXPECT_EQ(report["memory"]["accelerator_bytes"], 0);
    build_aggregate(loaded, options);
    const Aggregate* built = loaded.scene.aggregate.get();
    ASSERT_NE(built, nullptr);
    build_aggregate(loaded, options);
    EXPECT_EQ(loaded.scene.aggregate.get(), built);
    EXPECT_EQ(render(loaded, render_options).film.to_image().samples,
              render(whole, render_options).film.to_image().samples);
}

TEST(Load, WarnsOfOptionsOfTheWideBvhInScenesWithoutOne) {
    const testing::ScratchFolder folder;
    const std::string ball = "alhazen 1\nsphere { radius = 1 }\n";
    const auto plain = folder.write("plain.alhazen", ball);
    const auto own = folder.write(
        "own.alhazen", ball +
                           "object \"o\" { accelerator = \"wide_bvh\"; sphere { radius = 1 } }\n"
                           "instance \"o\" { }\n");
    const auto warnings = [](const std::filesystem::path& path, const char* accelerator,
                             const BuildOptions& build) {
        LoadOptions options;
        options.compile.accelerator = accelerator;
        options.compile.build = build;
        return load(path, options).diagnostics.warning_count();
    };
    for (const BuildOptions& build :
         {BuildOptions{.quality = BuildQuality::High}, BuildOptions{.leaves = Leaves::Indices},
          BuildOptions{.width = 4}}) {
        EXPECT_EQ(warnings(plain, "wide_bvh", build), 0u);
        EXPECT_EQ(warnings(plain, "list", build), 1u);
        EXPECT_EQ(warnings(plain, "kd_tree:max_depth=9", build), 1u);
        EXPECT_EQ(warnings(own, "list", build), 0u);
    }
    EXPECT_EQ(warnings(plain, "list", {}), 0u);
}

TEST(Load, StrictTurnsWarningsIntoErrors) {
    const std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) / "load_strict.obj";
    write_file_atomically(path, "mtllib absent.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    LoadOptions options;
    EXPECT_EQ(load(path, options).diagnostics.warning_count(), 1);
    options.strict = true;
    try {
        (void)load(path, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Scene);
        EXPECT_NE(std::string(error.what()).find("load_strict.obj:1: error: "), std::string::npos)
            << error.what();
    }
    const auto plane = testing::source_folder() / "scenes/one_plane.alhazen";
    EXPECT_NO_THROW((void)load(plane, options));
    options.compile.accelerator = "list";
    options.compile.build.width = 4;
    try {
        (void)load(plane, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        EXPECT_NE(std::string(error.what()).find("is built without --build"), std::string::npos);
    }
}

TEST(Load, StrictRefusesBadTexels) {
    const testing::ScratchFolder folder;
    Image image(4, 2, 3);
    image.pixel(1, 0)[0] = std::numeric_limits<float>::infinity();
    write_image(folder.path() / "sky.pfm", image);
    const auto path =
        folder.write("sky.alhazen",
                     "alhazen 1\nenvironment { kind = picture; file = \"sky.pfm\" }\nsphere { }\n");
    LoadOptions options;
    EXPECT_EQ(load(path, options).diagnostics.warning_count(), 1u);
    options.strict = true;
    EXPECT_THROW((void)load(path, options), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
