// Lights behind parts that only shadow rays see, or that shadow rays do not see: light at a point
// that scatters by a density is what shadow rays find.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/light_pictures.h"
#include "support/show_last_to.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::expect_same_light;
using testing::fog;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
using testing::show_last_to;

constexpr RayMask kShadow = mask_of(RayKind::Shadow);
constexpr RayMask kNoShadow = kRaysOfAllKinds & ~kShadow;
constexpr Rgb kFloor{0.5, 0.5, 0.5};
/// Half the side of the picture.
constexpr double kSeen = 0.5;

/// A floor of side 2, seen from above.
SceneMaker small_floor(const Rgb& color = kFloor) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.25}, {0, 0, -1}, {2 * kSeen, 0, 0}, {0, 2 * kSeen, 0}};
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), maker.material(matt(color)));
    return maker;
}

/// A rectangle parallel to the floor.
struct Flat {
    double x0, y0, x1, y1, z;
};

/// Faces the floor.
void add(SceneMaker& maker, const Flat& f, const Material& material) {
    maker.add(rectangle({f.x0, f.y0, f.z}, {0, f.y1 - f.y0, 0}, {f.x1 - f.x0, 0, 0}),
              maker.material(material));
}

/// The share of a cosine-weighted hemisphere that a rectangle covers, seen from (x, y, 0).
double share_of(const Flat& f, double x, double y) {
    const auto corner = [&](double u, double v) {
        u /= f.z;
        v /= f.z;
        const double a = std::sqrt(1 + u * u), b = std::sqrt(1 + v * v);
        return (u / a * std::atan(v / a) + v / b * std::atan(u / b)) / (2 * std::numbers::pi);
    };
    return corner(f.x1 - x, f.y1 - y) - corner(f.x0 - x, f.y1 - y) - corner(f.x1 - x, f.y0 - y) +
           corner(f.x0 - x, f.y0 - y);
}

/// The part of a light that a blocker hides from (x, y, 0).
Flat hidden(const Flat& light, const Flat& blocker, double x, double y) {
    const double scale = light.z / blocker.z;
    const double x0 = std::max(light.x0, x + scale * (blocker.x0 - x));
    const double y0 = std::max(light.y0, y + scale * (blocker.y0 - y));
    return {x0, y0, std::max(x0, std::min(light.x1, x + scale * (blocker.x1 - x))),
            std::max(y0, std::min(light.y1, y + scale * (blocker.y1 - y))), light.z};
}

/// The mean over the picture.
template <class F>
double mean_over_floor(F&& at) {
    constexpr int kSide = 200;
    double sum = 0.0;
    for (int i = 0; i < kSide * kSide; ++i) {
        sum += at(kSeen * ((2 * (i % kSide) + 1.0) / kSide - 1.0),
                  kSeen * ((2 * (i / kSide) + 1.0) / kSide - 1.0));
    }
    return sum / (kSide * kSide);
}

/// Expects the mean of the picture: `share` of light 1, once reflected by the floor. `bias`:
/// allowed in addition to noise, relative.
void expect_light(const Scene& scene, const std::string& name, double share,
                  const std::vector<std::string>& renderers, int samples = 32, double bias = 0.0) {
    constexpr int kRuns = 12;
    for (const std::string& renderer : renderers) {
        const int times = renderer == "light_tracing" ? 4 : 1;
        double sum = 0.0, squares = 0.0;
        for (int run = 0; run < kRuns; ++run) {
            const double mean =
                mean_of(picture_of(scene, renderer, 8, times * samples, std::uint64_t(70 + run))).g;
            sum += mean;
            squares += mean * mean;
        }
        const double mean = sum / kRuns;
        const double error = std::sqrt(std::max(0.0, squares / kRuns - mean * mean) / (kRuns - 1));
        // A t of 11 degrees of freedom beyond 5.7 is seen in one of 7000 cases.
        EXPECT_NEAR(mean, kFloor.g * share, 5.7 * error + bias * share + 1e-5)
            << name << " " << renderer;
        EXPECT_LT(error, 0.04 * kFloor.g) << name << " " << renderer;
    }
}

const std::vector<std::string> kRenderers{"path_tracing",
                                          "path_tracing --spectral",
                                          "path_tracing:manifold=on",
                                          "path_tracing:polarization=on",
                                          "bidirectional",
                                          "bidirectional --spectral",
                                          "vcm:photons=500,radius=0.05,pilot=off",
                                          "light_tracing",
                                          "sppm:photons=200,radius=0.05",
                                          "photon_mapping:photons=1000,nearest=30,gather=0"};

std::vector<std::string> renderers_of(const std::string& name) {
    // Every day the first and a third of the others.
    std::vector<std::string> tried{kRenderers.front()};
    for (std::size_t i = 1; i < kRenderers.size(); ++i) {
        if (testing::is_tried(i, 3, testing::number_of(name))) tried.push_back(kRenderers[i]);
    }
    return tried;
}

/// Covers nearly half of the lights.
constexpr Flat kBlocker{-6, -6, 0, 6, 0.5};

void test_rectangle(const std::string& name, const Flat& light, RayMask mask_of_light) {
    for (const RayMask mask : {kShadow, kNoShadow}) {
        SceneMaker maker = small_floor();
        add(maker, light, shining({1, 1, 1}));
        show_last_to(maker, mask_of_light);
        add(maker, kBlocker, matt({0, 0, 0}));
        show_last_to(maker, mask);
        const Scene scene = maker.compile();
        EXPECT_TRUE(scene.hides_lights_from_some);
        const double share = mean_over_floor([&](double x, double y) {
            const double all = share_of(light, x, y);
            return mask == kShadow ? all - share_of(hidden(light, kBlocker, x, y), x, y) : all;
        });
        EXPECT_GT(share, 0.01);
        expect_light(scene, name + " " + std::to_string(mask), share,
                     renderers_of(name + std::to_string(mask)));
    }
}

TEST(HiddenLights, ALargeRectangleIsFoundByShadowRays) {
    test_rectangle("large", {-2, -2, 2, 2, 1}, kAllRays);
}

TEST(HiddenLights, ASmallRectangleIsFoundByShadowRays) {
    test_rectangle("small", {-0.25, -0.25, 0.25, 0.25, 1}, kAllRays);
}

TEST(HiddenLights, TheSurfaceOfAnAreaLightIsFoundByShadowRays) {
    test_rectangle("area light", {-1, -1, 1, 1, 1}, kLightSurfaceMask);
}

TEST(HiddenLights, VerticesInLanesFindLightsByShadowRays) {
    const Flat light{-1, -1, 1, 1, 1};
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.25}, {0, 0, -1}, {2 * kSeen, 0, 0}, {0, 2 * kSeen, 0}};
    TriangleMesh floor;
    floor.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    maker.add(maker.mesh(floor), maker.material(matt(kFloor)));
    add(maker, light, shining({1, 1, 1}));
    add(maker, kBlocker, matt({0, 0, 0}));
    show_last_to(maker, kShadow);
    const double share = mean_over_floor([&](double x, double y) {
        return share_of(light, x, y) - share_of(hidden(light, kBlocker, x, y), x, y);
    });
    expect_light(maker.compile(), "mesh", share, {"path_tracing"});
}

TEST(HiddenLights, ABallIsFoundByShadowRays) {
    for (const RayMask mask : {kShadow, kNoShadow}) {
        constexpr double kHeight = 1.5, kRadius = 0.4;
        SceneMaker maker = small_floor();
        maker.add(ball({0, 0, kHeight}, kRadius), maker.material(shining({1, 1, 1})));
        add(maker, {-6, -6, 6, 6, 0.5}, matt({0, 0, 0}));
        show_last_to(maker, mask);
        const double share = mean_over_floor([&](double x, double y) {
            const double squared = x * x + y * y + kHeight * kHeight;
            return kRadius * kRadius * kHeight / (squared * std::sqrt(squared));
        });
        const std::string name = "ball " + std::to_string(mask);
        expect_light(maker.compile(), name, mask == kShadow ? 0.0 : share, renderers_of(name));
    }
}

TEST(HiddenLights, TheEnvironmentIsFoundByShadowRays) {
    for (const RayMask mask : {kShadow, kNoShadow}) {
        const Flat blocker{-1, -1, 0.5, 1, 0.5};
        SceneMaker maker = small_floor();
        maker.description().environment = EnvironmentDescription{};
        add(maker, blocker, matt({0, 0, 0}));
        show_last_to(maker, mask);
        const double share = mean_over_floor([&](double x, double y) {
            return mask == kShadow ? 1.0 - share_of(blocker, x, y) : 1.0;
        });
        const std::string name = "environment " + std::to_string(mask);
        expect_light(maker.compile(), name, share, renderers_of(name));
    }
}

TEST(HiddenLights, MirrorsShowLightsThatShadowRaysDoNotFind) {
    // A mirror at x = 1 doubles the light; the blocker hides the light itself.
    const Flat light{-0.5, -0.5, 0.5, 0.5, 1}, image{1.5, -0.5, 2.5, 0.5, 1};
    Material mirror;
    mirror.reflective.color = {1, 1, 1};
    for (const RayMask mask : {kShadow, kNoShadow}) {
        SceneMaker maker = small_floor();
        add(maker, light, shining({1, 1, 1}));
        maker.add(rectangle({1, -9, 0}, {0, 18, 0}, {0, 0, 18}), maker.material(mirror));
        const Flat all{-6, -6, 1, 6, 0.5};
        add(maker, all, matt({0, 0, 0}));
        show_last_to(maker, mask);
        const double share = mean_over_floor(
            [&](double x, double y) { return share_of(mask == kShadow ? image : light, x, y); });
        EXPECT_GT(share, 0.01);
        const std::string name = "mirror " + std::to_string(mask);
        // The image is found by chance by eye paths, and as a caustic by photons.
        const Scene scene = maker.compile();
        expect_light(scene, name, share,
                     {"path_tracing", "path_tracing:manifold=on", "bidirectional", "light_tracing",
                      "vcm:photons=500,radius=0.05,pilot=off"},
                     64);
        expect_light(scene, name, share,
                     {"sppm:photons=1000,radius=0.05",
                      "photon_mapping:photons=1000,caustics=40000,nearest=50,gather=0"},
                     32, 0.02);
    }
}

const std::string kVcm = "vcm:photons=500,radius=0.05,pilot=off",
                  kSppm = "sppm:photons=2000,radius=0.05";

void expect_agreement(const Scene& scene, const std::string& name, int samples, double bias,
                      const std::vector<std::string>& photons) {
    expect_same_light(scene, name, {"path_tracing", "light_tracing", "bidirectional"}, samples);
    const double light = mean_of(picture_of(scene, "path_tracing", 8, 512)).g;
    ASSERT_GT(light, 0.01);
    for (const std::string& renderer : photons) {
        EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, 128)).g, light, bias * light)
            << name << " " << renderer;
    }
}

TEST(HiddenLights, AllStrategiesAgreeForEveryMask) {
    for (RayMask mask = 1; mask <= kRaysOfAllKinds; ++mask) {
        if (!testing::is_tried(mask, 4, 2)) continue;
        // A slope over one half of the floor, lit from above, by the sky and by the floor.
        SceneMaker maker = small_floor();
        maker.add(rectangle({-0.5, -0.5, 0.05}, {0.6, 0, 0.15}, {0, 1, 0}),
                  maker.material(matt({0.4, 0.6, 0.9})));
        show_last_to(maker, mask);
        add(maker, {0.1, -0.4, 0.9, 0.4, 0.8}, shining({2, 2, 2}, {0.2, 0.2, 0.2}));
        maker.description().environment = EnvironmentDescription{};
        expect_agreement(maker.compile(), "mask " + std::to_string(mask), 48, 0.02, {kVcm, kSppm});
    }
}

TEST(HiddenLights, AllStrategiesAgreeInFog) {
    for (const RayMask mask : {kShadow, kNoShadow}) {
        SceneMaker maker = small_floor();
        add(maker, {-0.8, -0.8, 0.8, 0.8, 1.2}, shining({3, 3, 3}));
        maker.add(BoxShape{{-2, -2, -1}, {2, 2, 2}},
                  maker.material(fog({0.1, 0.1, 0.1}, {0.5, 0.5, 0.5}, 0.3)));
        add(maker, {-3, -3, 0, 3, 0.6}, matt({0.2, 0.2, 0.2}));
        show_last_to(maker, mask);
        expect_agreement(maker.compile(), "fog " + std::to_string(mask), 64, 0.04,
                         {kVcm, kSppm, "photon_mapping:photons=40000,caustics=40000,nearest=50"});
    }
}

TEST(HiddenLights, OtherScenesAreNotConcerned) {
    constexpr RayMask kEye = mask_of(RayKind::Eye);
    for (const RayMask mask : {kAllRays, kLightSurfaceMask, kEye, kRaysOfAllKinds & ~kEye}) {
        SceneMaker maker = small_floor();
        add(maker, kBlocker, matt({0, 0, 0}));
        show_last_to(maker, mask);
        EXPECT_FALSE(maker.compile().hides_lights_from_some) << mask;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
