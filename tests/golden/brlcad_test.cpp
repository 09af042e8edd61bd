/// BRL-CAD's own models against its reference images.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"
#include "support/scratch_folder.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
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

struct Difference {
    double mean = 0.0;  ///< of the channels, in 255ths
    int worst = 0;      ///< of one channel, in 255ths
    int far = 0;        ///< pixels more than 1 off
};

/// The difference between a reference and the picture file of a scene in the view of a script.
Difference difference(const std::filesystem::path& model, const std::filesystem::path& view,
                      const std::filesystem::path& reference_path) {
    LoadOptions options;
    options.import.view_script = view;
    const LoadedScene loaded = load(model, options);
    const RenderResult result = render(loaded.scene, loaded.description.picture, {});
    const EncodedImage picture =
        encode(result.film.data(), 512, 512, loaded.description.conventions.film.encoding(), 8);
    const Image reference = read_image(reference_path);
    Difference difference;
    for (std::size_t pixel = 0; pixel < std::size_t{512} * 512; ++pixel) {
        const Rgb theirs = reference.rgb(int(pixel % 512), int(pixel / 512));
        bool near = true;
        for (int c = 0; c < 3; ++c) {
            const int step = std::abs(int(picture.samples[3 * pixel + std::size_t(c)]) -
                                      int(std::lround(255 * theirs[c])));
            difference.mean += step / (3.0 * 512 * 512);
            difference.worst = std::max(difference.worst, step);
            near = near && step <= 1;
        }
        difference.far += near ? 0 : 1;
    }
    return difference;
}

/// Twenty-five spheres on a half space, of five highlights and five sharpnesses, and a light at
/// infinity: the model that BRL-CAD's regression test `spdi` builds.
std::string spheres_of_spdi() {
    std::string text = "title {spdi}\nunits mm\n";
    std::string members;
    const auto add = [&](const std::string& name, const std::string& solid,
                         const std::string& shader, const char* color) {
        text += "put {" + name + ".s} " + solid + "\nput {" + name +
                ".r} comb region yes tree {l {" + name + ".s}}\nattr set {" + name +
                ".r} {region} {R} {rgb} {" + color + "} {shader} {" + shader + "}\n";
        const std::string leaf = "{l {" + name + ".r}}";
        members = members.empty() ? leaf : "{u " + members + " " + leaf + "}";
    };
    add("half", "half N {0 0 1} d -1", "plastic", "76/158/113");
    for (int row = 1; row <= 5; ++row) {
        for (int column = 1; column <= 5; ++column) {
            const std::string name = "sphere" + std::to_string(row) + std::to_string(column);
            add(name,
                "ell V {" + std::to_string((column - 3) * 640) + " " +
                    std::to_string((row - 3) * 640) + " 256} A {256 0 0} B {0 256 0} C {0 0 256}",
                "plastic sp " + std::to_string(0.2 * column) + " di " +
                    std::to_string(1.0 - 0.2 * column) + " sh " + std::to_string(4 * row),
                "100/200/200");
        }
    }
    add("light", "ell V {-464 339 2213} A {0 100 0} B {0 0 100} C {100 0 0}", "light i 1 s 1 v 0",
        "255/255/255");
    return text + "put {all.g} comb region no tree " + members + "\n";
}

TEST(BrlcadPictures, MossLooksLikeItsReferencePicture) {
    ALHAZEN_NEEDS_DATA(kReference);
    const Difference moss = difference(testing::test_data() / kModels / "moss.asc",
                                       testing::source_folder() / "tests/golden/moss.rt",
                                       testing::test_data() / kReference);
    EXPECT_EQ(moss.mean, 0.0);
    EXPECT_EQ(moss.worst, 0);
}

TEST(BrlcadPictures, SpheresOfEveryHighlightAreTheReferencePicture) {
    const std::string reference = "csg/brlcad/regress/spdi/spdi.ref.png";
    ALHAZEN_NEEDS_DATA(reference);
    testing::ScratchFolder folder;
    folder.write("spdi.asc", spheres_of_spdi());
    folder.write("spdi.rt", "viewsize 3200; orientation 0 0 0 1; eye_pt 0 0 2413; start 0; end;\n");
    const Difference spheres = difference(folder.path() / "spdi.asc", folder.path() / "spdi.rt",
                                          testing::test_data() / reference);
    EXPECT_LT(spheres.mean, 1e-5);
    EXPECT_LE(spheres.worst, 1);
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
}  // namespace alhazen::ALHAZEN_TEST_FILE
