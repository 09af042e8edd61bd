/// BRL-CAD's own models against its reference images.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"
#include "support/test_data.h"

namespace alhazen {
namespace {

const std::string kModels = "csg/brlcad/db";
const std::string kReference = "csg/brlcad/bench/ref/moss.png";

/// Pixels in which the reference image and the rendered silhouette of moss.asc differ.
std::vector<std::string> wrong_pixels(const LoadOptions& options, std::size_t& background) {
    const LoadedScene moss = load(testing::test_data() / kModels / "moss.asc", options);
    EXPECT_EQ(moss.diagnostics.all().size(), 0u);
    RenderOptions render_options;
    render_options.aovs.add(AovKind::Depth);
    const RenderResult result = render(moss.scene, moss.description.picture, render_options);
    const Image reference = read_image(testing::test_data() / kReference);
    const LayerChannel* depth = result.layers.find("depth.Z");
    std::vector<std::string> wrong;
    EXPECT_EQ(depth->values.size(), std::size_t{512} * 512);
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 512; ++x) {
            const Rgb c = reference.rgb(x, y);
            const bool empty = c.r == 0.0 && c.g == 0.0 && std::lround(255 * c.b) == 1;
            const bool ours = std::isinf(depth->values[std::size_t(y) * 512 + std::size_t(x)]);
            background += ours ? 1 : 0;
            if (empty != ours) wrong.push_back(std::to_string(x) + "," + std::to_string(y));
        }
    }
    return wrong;
}

TEST(BrlcadPictures, EveryPixelOfTheSilhouetteOfMossIsRight) {
    ALHAZEN_NEEDS_DATA(kReference);
    for (const char* accelerator : {"list", "wide_bvh"}) {
        LoadOptions options;
        options.compile.accelerator = accelerator;
        options.import.view_script = testing::source_folder() / "tests/golden/moss.rt";
        std::size_t background = 0;
        const std::vector<std::string> wrong = wrong_pixels(options, background);
        EXPECT_EQ(wrong, std::vector<std::string>{}) << accelerator;
        EXPECT_EQ(background, 149586u) << accelerator;
    }
}

/// Mean difference of the channels, in 255ths.
double mean_error(const Image& picture, const Image& reference) {
    double sum = 0.0;
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 512; ++x) {
            const Rgb a = picture.rgb(x, y), b = reference.rgb(x, y);
            for (int c = 0; c < 3; ++c) sum += std::abs(std::clamp(a[c], 0.0, 1.0) - b[c]);
        }
    }
    return 255.0 * sum / (3.0 * 512 * 512);
}

TEST(BrlcadPictures, MossLooksLikeItsReferencePicture) {
    ALHAZEN_NEEDS_DATA(kReference);
    LoadOptions options;
    options.import.view_script = testing::source_folder() / "tests/golden/moss.rt";
    const LoadedScene moss = load(testing::test_data() / kModels / "moss.asc", options);
    const RenderResult result = render(moss.scene, moss.description.picture, {});
    const Image picture = result.film.to_image();
    EXPECT_LT(mean_error(picture, read_image(testing::test_data() / kReference)), 6.0);
}

TEST(BrlcadPictures, EveryModelLoadsAndHasItsDefaultCamera) {
    ALHAZEN_NEEDS_DATA(kModels);
    const auto models = testing::files_below(kModels, ".asc");
    EXPECT_GE(models.size(), 10u);
    for (const auto& model : models) {
        const LoadedScene loaded = load(model);
        EXPECT_EQ(loaded.description.format, "brlcad") << model;
        ASSERT_FALSE(loaded.description.cameras.empty()) << model;
        EXPECT_EQ(loaded.description.cameras[0].name, "35,25") << model;
    }
}

}  // namespace
}  // namespace alhazen
