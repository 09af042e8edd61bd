/// Photons behind balls of glass and in rings, against optics.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/renderers/photons/photon_shooting.h"
#include "support/fresnel.h"
#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/photons/photon_shots.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::fresnel;
using testing::matt;
using testing::power_of;
using testing::SceneMaker;
using testing::shot_of;
using testing::smooth_glass;

/// A ball of glass around the origin in the beam of a spot light that it takes whole, and a black
/// sphere around both.
struct BallLens {
    static constexpr double kIndex = 1.5, kAway = 50;
    double half_angle = 0;  ///< of the beam
    double power = 0;
    Scene scene;
};

BallLens ball_lens(double radius_of_beam) {
    BallLens lens;
    lens.half_angle = std::asin(radius_of_beam / BallLens::kAway);
    lens.power = kPi * 2 * kPi * (1 - std::cos(lens.half_angle));
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 1), maker.material(smooth_glass(BallLens::kIndex)));
    maker.add(ball({0, 0, 0}, 100), maker.material(matt({0, 0, 0.0001})));
    SpotLight spot;
    spot.position = {0, 0, BallLens::kAway};
    spot.direction = {0, 0, -1};
    spot.inner_angle = spot.outer_angle = lens.half_angle;
    spot.color = {1, 1, 1};
    spot.attenuation = {0, 0, 1};
    maker.light(spot);
    lens.scene = maker.compile();
    return lens;
}

TEST(Caustics, ABallLensSendsTheRefractedPowerIntoItsCone) {
    constexpr double kCone = 0.5;
    const BallLens lens = ball_lens(0.98);
    // Orders of rays that leave the ball after 0, 1, ... chords.
    double expected = 0.0, whole = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = std::acos(1 - (1 - std::cos(lens.half_angle)) * (i + 0.5) / kSteps);
        const double b = BallLens::kAway * std::sin(angle);
        const double in = std::asin(b), out = std::asin(b / BallLens::kIndex);
        const double r = fresnel(std::cos(in), BallLens::kIndex);
        for (int chords = 0; chords < 8; ++chords) {
            const double turned =
                chords == 0 ? 2 * in - kPi : 2 * (in - out) + (chords - 1) * (kPi - 2 * out);
            const double share = chords == 0 ? r : (1 - r) * (1 - r) * std::pow(r, chords - 1);
            whole += share / kSteps;
            if (std::cos(turned - angle) > std::cos(kCone)) expected += share / kSteps;
        }
    }
    EXPECT_NEAR(whole, 1.0, 1e-3);
    EXPECT_GT(expected, 0.3);
    EXPECT_LT(expected, 0.9);
    const ShotPhotons shot = shot_of(lens.scene, {100000, {PhotonKind::Caustic}, 64, 5});
    double cone = 0.0;
    for (const Photon& p : shot.photons) {
        if (p.from.vector().z > std::cos(kCone)) cone += p.light().b;
    }
    EXPECT_NEAR(power_of(shot.photons).g, lens.power, 2e-3 * lens.power);
    EXPECT_NEAR(cone, expected * lens.power, 0.005 * lens.power);
}

/// Parallel rays near the axis meet n / (2 (n - 1)) radii behind the centre of a ball.
TEST(Caustics, ABallLensHasItsFocusWhereTheFormulaPutsIt) {
    constexpr double kBeam = 0.1;
    const BallLens lens = ball_lens(kBeam);
    const ShotPhotons shot = shot_of(lens.scene, {20000, {PhotonKind::Caustic}, 3, 5});
    // A lens of this focal length, with the light at a distance.
    const double f = BallLens::kIndex / (2 * (BallLens::kIndex - 1));
    const double focus = 1 / (1 / f - 1 / BallLens::kAway);
    const auto spread = [&](double behind) {
        double sum = 0.0, count = 0.0;
        for (const Photon& p : shot.photons) {
            const Vec3 from = p.from.vector();
            if (from.z < 0.9) continue;
            const Vec3 at = p.point() + (p.point().z + behind) / -from.z * from;
            sum += at.x * at.x + at.y * at.y;
            count += 1.0;
        }
        return std::sqrt(sum / count);
    };
    double best = 0.0, least = 1e30;
    for (double behind = 1.0; behind < 2.0; behind += 0.01) {
        if (const double own = spread(behind); own < least) {
            least = own;
            best = behind;
        }
    }
    EXPECT_NEAR(best, focus, 0.02);
    EXPECT_LT(least, 0.1 * spread(1.0));
}

/// Light that falls into a ring of radius 1 along x is reflected into an envelope whose cusp is
/// half a radius from the centre.
TEST(Caustics, ARingHasItsCuspAtHalfItsRadius) {
    SceneMaker maker;
    Cylinder ring;
    ring.radius = 1;
    ring.base = {0, 0, 0};
    ring.top = {0, 0, 0.6};
    ring.capped = false;
    Material mirror;
    mirror.reflective.color = {1, 1, 1};
    maker.add(ring, maker.material(mirror));
    Disc floor;
    floor.radius = 1.5;
    maker.add(floor, maker.material(matt({0, 0, 0.0001})));
    maker.light(DirectionalLight{.to_light = normalize(Vec3{-1, 0, 0.6}), .color = {1, 1, 1}});
    const ShotPhotons shot = shot_of(maker.compile(), {1000000, {PhotonKind::Caustic}, 64, 5});
    // Photons of one reflection in strips across x near the axis: 0.3 .. 0.7.
    std::map<int, double> strips;
    for (const Photon& p : shot.photons) {
        const Vec3 at = p.point();
        if (p.from.vector().x < 0.0 || std::abs(at.y) > 0.01) continue;
        if (at.x > 0.2 && at.x < 0.9) strips[int(std::floor(at.x * 25))] += p.light().b;
    }
    const auto brightest = std::max_element(strips.begin(), strips.end(),
                                            [](auto& a, auto& b) { return a.second < b.second; });
    ASSERT_NE(brightest, strips.end());
    EXPECT_NEAR((brightest->first + 0.5) / 25, 0.5, 0.05);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
