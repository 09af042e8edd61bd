/// The footprints of textures in pixels whose samples are integrated: they end where the pixel
/// ends.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "support/scratch_folder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr int kSide = 8;
constexpr double kOrigin = 0.3, kWidth = 3.0;

/// Stripes across the columns: white for k = 0, 2, ... in [kOrigin + k kWidth, ... + kWidth]. A
/// pixel is a unit square, the first column begins at -4.
Film stripes(const std::string& renderer, const std::string& antialias,
             const std::string& size = "3", const std::string& origin = "0.3") {
    const testing::ScratchFolder folder;
    const std::string texture =
        "solid_texture \"st\" { kind = stripes; color = (1, 1, 1); "
        "other = (0, 0, 0); direction = (1, 0, 0); size = " +
        size + "; origin = (" + origin + ", 0, 0) }\n";
    const auto path = folder.write("stripes.alhazen", "alhazen 1\n" + texture + R"(
orthographic_camera "c" { eye = (0, 0, 5); look_at = (0, 0, 0); up = (0, 1, 0); height = 8 }
ambient_light { color = (1, 1, 1) }
material "m" { ambient = texture("st"); diffuse = 0 }
rectangle { corner = (-9, -9, 0); edge_u = (18, 0, 0); edge_v = (0, 18, 0); material = "m" }
)");
    RenderOptions options;
    options.renderer = renderer;
    options.antialias = parse_antialias(antialias);
    options.width = options.height = kSide;
    options.threads = 1;
    return render(load(path), options).film;
}

/// Length of the white stripes before x.
double white_before(double x) {
    const double at = (x - kOrigin) / (2.0 * kWidth);
    const double whole = std::floor(at);
    return 2.0 * kWidth * (0.5 * whole + std::min(at - whole, 0.5));
}

/// White share of a column.
double share_of(int column) {
    const double left = column - 0.5 * kSide;
    return white_before(left + 1.0) - white_before(left);
}

TEST(TextureFootprints, ExactAreasHoldForStripesWithinTheError) {
    for (const char* error : {"1e-4", "1e-6"}) {
        const Film film = stripes("beam_tracing", std::string("exact:error=") + error);
        for (int i = 0; i < kSide; ++i) {
            EXPECT_NEAR(film.at(i, 3).r, share_of(i), 1e-4) << i;
        }
    }
}

TEST(TextureFootprints, ExactAreasAverageStripesFinerThanAPixel) {
    for (const char* size : {"0.5", "0.25", "0.125", "0.0625"}) {
        for (const char* origin : {"0", "0.113", "0.2"}) {
            const Film film = stripes("beam_tracing", "exact", size, origin);
            for (int i = 0; i < kSide; ++i) {
                EXPECT_NEAR(film.at(i, 3).r, 0.5, 0.01) << size << " " << origin << " " << i;
            }
        }
    }
}

/// Whatever is within a pixel counts, also next to its border.
TEST(TextureFootprints, ExactAreasSeeEdgesNextToTheBorderOfAPixel) {
    for (const char* origin : {"0.01", "0.05", "0.08", "0.95"}) {
        const double x = std::stod(origin);
        const Film film = stripes("beam_tracing", "exact", "3", origin);
        EXPECT_NEAR(film.at(kSide / 2, 3).r, 1.0 - x, 1e-3) << origin;
    }
}

/// The integrals of the tent over a pixel and over those beside it are 3/4 and 1/8.
TEST(TextureFootprints, AFilterWeighsTheMeansOfPixels) {
    const Film film = stripes("beam_tracing", "exact:filter=tent");
    for (int i = 0; i < kSide; ++i) {
        EXPECT_NEAR(film.at(i, 3).r,
                    0.75 * share_of(i) + 0.125 * (share_of(i - 1) + share_of(i + 1)), 1e-4)
            << i;
    }
}

TEST(TextureFootprints, PixelsBesideAnEdgeHaveNoneOfItInAdaptiveSupersampling) {
    const Film film = stripes("whitted", "whitted");
    for (int i = 0; i < kSide; ++i) {
        const double share = share_of(i);
        const bool crossed = share > 1e-9 && share < 1.0 - 1e-9;
        EXPECT_NEAR(film.at(i, 3).r, share, crossed ? 0.02 : 1e-9) << i;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
