// Surfaces at the place of one that is passed, in the pictures of all renderers that trace rays.

#include <gtest/gtest.h>

#include <string>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "support/scratch_folder.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

constexpr const char* kBlue = "alhazen 1\npicture { background = (0, 0, 1) }\n";
constexpr const char* kAhead =
    "perspective_camera { eye = (0.3, 0.2, 3); look_at = (0, 0, 0); up = (0, 1, 0); "
    "fov_deg = 30 }\n";
/// Renderers without random light, then those of light transport.
const std::vector<std::string> kPlain{"whitted", "whitted:fresnel=on", "ray_casting",
                                      "distributed"};
const std::vector<std::string> kTransport{"path_tracing",   "light_tracing",  "bidirectional",
                                          "vcm:photons=64", "photon_mapping", "sppm"};

std::string square(const std::string& material, double z = 0) {
    const std::string at = std::to_string(z);
    return "mesh { points = [(-2, -2, " + at + "), (2, -2, " + at + "), (2, 2, " + at +
           "), (-2, 2, " + at + ")]\nfaces = [(0, 1, 2, 3)]\nmaterial = {" + material + "} }\n";
}

Rgb picture(const std::string& text, const std::string& renderer, int samples = 4) {
    const ScratchFolder folder;
    const LoadedScene loaded = load(folder.write("scene.alhazen", text));
    RenderOptions options;
    options.renderer = renderer;
    options.width = options.height = 8;
    options.threads = 1;
    if (renderer != "sppm" && renderer != "photon_mapping") options.samples_per_pixel = samples;
    const RenderResult result = render(loaded, options);
    Rgb sum;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) sum += result.film.at(x, y);
    }
    return (1.0 / 64) * sum;
}

void expect_color(const Rgb& found, const Rgb& expected, double tolerance,
                  const std::string& what) {
    EXPECT_NEAR(found.r, expected.r, tolerance) << what;
    EXPECT_NEAR(found.g, expected.g, tolerance) << what;
    EXPECT_NEAR(found.b, expected.b, tolerance) << what;
}

TEST(PassedSurfaces, ACardWoundBothWaysIsSeenFromBothSides) {
    const std::string card =
        "mesh { points = [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)]\n"
        "faces = [(0, 1, 2, 3), (3, 2, 1, 0)]\n"
        "material = { diffuse = (0, 0.5, 0); double_sided = false } }\n";
    for (const char* eye : {"(0.3, 0.2, 3)", "(0.3, 0.2, -3)", "(0, 0, 3)", "(0, 0, -3)"}) {
        const std::string text = std::string(kBlue) + "perspective_camera { eye = " + eye +
                                 "; look_at = (0, 0, 0); up = (0, 1, 0); fov_deg = 30 }\n" +
                                 "ambient_light { color = 1 }\n" + card;
        for (const std::string& renderer : kPlain) {
            expect_color(picture(text, renderer), {0, 0.5, 0}, 1e-6, renderer + eye);
        }
        for (const std::string& renderer : kTransport) {
            EXPECT_EQ(picture(text, renderer).b, 0) << renderer << eye;
        }
    }
}

TEST(PassedSurfaces, AWallIsSeenThroughWhatADecalLeavesOpen) {
    const std::string start = std::string(kBlue) + kAhead + "ambient_light { color = 1 }\n";
    const std::string open =
        square("diffuse = (1, 0, 0); emission = (1, 0, 0); alpha_mode = mask; alpha = 0.3");
    const std::string wall = square("diffuse = 0; emission = (0, 0.5, 0)");
    for (const std::string& text : {start + open + wall, start + open + open + wall}) {
        for (const std::string& renderer : kPlain) {
            expect_color(picture(text, renderer), {0, 0.5, 0}, 1e-6, renderer);
        }
        for (const std::string& renderer : kTransport) {
            expect_color(picture(text, renderer), {0, 0.5, 0}, 1e-6, renderer);
        }
    }
}

TEST(PassedSurfaces, ADecalIsBlendedWithTheWallAtItsPlace) {
    const std::string start = std::string(kBlue) + kAhead;
    const std::string half =
        square("diffuse = 0; emission = (1, 0, 0); alpha_mode = blend; alpha = 0.5");
    const std::string quarter =
        square("diffuse = 0; emission = (0, 0, 1); alpha_mode = blend; alpha = 0.25");
    const std::string wall = square("diffuse = 0; emission = (0, 0.5, 0)");
    const std::string one = start + half + wall, two = start + half + quarter + wall;
    for (const std::string& renderer : kPlain) {
        expect_color(picture(one, renderer), {0.5, 0.25, 0}, 1e-6, renderer);
        expect_color(picture(two, renderer), {0.5, 0.1875, 0.125}, 1e-6, renderer);
    }
    for (const std::string& renderer : kTransport) {
        // The standard error is below 0.004 with 256 samples, below 0.016 with 16.
        const bool few = renderer == "sppm" || renderer == "photon_mapping";
        const double tolerance = few ? 0.2 : 0.03;
        expect_color(picture(one, renderer, 256), {0.5, 0.25, 0}, tolerance, renderer);
        expect_color(picture(two, renderer, 256), {0.5, 0.1875, 0.125}, tolerance, renderer);
    }
}

TEST(PassedSurfaces, EdgesBetweenTrianglesCoverOnce) {
    // The diagonal runs through the middle of the pixels.
    const std::string text =
        "alhazen 1\northographic_camera { eye = (0, 0, 5); look_at = (0, 0, 0); up = (0, 1, 0); "
        "height = 2 }\nambient_light { color = 1 }\n" +
        square("diffuse = (1, 0.5, 0); alpha_mode = blend; alpha = 0.5");
    for (const std::string& renderer : kPlain) {
        expect_color(picture(text, renderer, 1), {0.5, 0.25, 0}, 1e-6, renderer);
    }
}

TEST(PassedSurfaces, LightDoesNotLeakThroughAWallBehindADecal) {
    const std::string text =
        "alhazen 1\nperspective_camera { eye = (0.3, 4, 3); look_at = (0, 0, -3); "
        "up = (0, 1, 0); fov_deg = 10 }\npoint_light { position = (0, 0, 5) }\n" +
        square("diffuse = (1, 0, 0); alpha_mode = mask; alpha = 0.3") + square("diffuse = 0") +
        "plane { point = (0, 0, -3); material = { diffuse = 0.8 } }\n";
    for (const std::string& renderer : kTransport) {
        EXPECT_LT(picture(text, renderer, 16).g, 0.01) << renderer;
    }
}

TEST(PassedSurfaces, LightMeetsTheFacesOfACardThatTheEyeSees) {
    for (const char* faces : {"(0, 1, 2, 3), (3, 2, 1, 0)", "(3, 2, 1, 0), (0, 1, 2, 3)"}) {
        for (const char* height : {"3", "-3"}) {
            const std::string above = std::string("0.3, 0.2, ") + height;
            const std::string text =
                "alhazen 1\nperspective_camera { eye = (" + above +
                "); look_at = (0, 0, 0); up = (0, 1, 0); fov_deg = 30 }\n" +
                "spot_light { position = (0, 0, " + height + "); direction = (0, 0, " +
                (height[0] == '-' ? "1" : "-1") + "); outer_angle_deg = 20 }\n" +
                "mesh { points = [(-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0)]\nfaces = [" +
                faces + "]\nmaterial = { diffuse = (0, 0.5, 0); double_sided = false } }\n";
            const double expected = picture(text, "path_tracing", 64).g;
            EXPECT_GT(expected, 0.01);
            EXPECT_NEAR(picture(text, "light_tracing", 256).g, expected, 0.1 * expected)
                << faces << height;
        }
    }
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
