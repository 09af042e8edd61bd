// Transmittance of straight connections through volumes, and the densities of walks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "alhazen/renderers/light_transport/connection_batch.h"
#include "alhazen/renderers/light_transport/free_flight.h"
#include "alhazen/renderers/volumes/coincident_faces.h"
#include "alhazen/renderers/volumes/media_finder.h"
#include "alhazen/sampling/random.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

Material absorbing(const Rgb& absorption, double index = 1.0) {
    Material m;
    m.index.value = index;
    m.dielectric = Dielectric{absorption};
    return m;
}

struct Passed {
    Spectrum share, in_batch;
    FreeFlight flight;
    bool same = false;  ///< from the other end
};

/// The transmittance between two points, by all three queries.
Passed pass(const Scene& scene, const Vec3& from, const Vec3& to) {
    RayCounters counters;
    ConnectionBatch batch(scene, counters, nullptr);
    const MediaFinder finder(scene);
    Passed passed;
    const double distance = length(to - from);
    const Ray ray{from, normalize(to - from), 0.0, distance};
    const Ray back{to, normalize(from - to), 0.0, distance};
    const MediumStack media = finder.around(from, 0), media_back = finder.around(to, 0);
    passed.share = batch.passing(ray, 0, media, kColorChannels, &passed.flight);
    const Spectrum other = batch.passing(back, 0, media_back, kColorChannels);
    passed.same = true;
    for (int i = 0; i < 4; ++i) {
        passed.same = passed.same && std::abs(other[i] - passed.share[i]) < 1e-12;
    }
    batch.add(ray, 0, media, kColorChannels, Spectrum::all(1), passed.in_batch);
    batch.finish();
    return passed;
}

const Rgb kFog{0.1, 0.3, 0.2}, kDenser{0.5, 0.6, 0.9}, kAbsorbs{0.7, 0.1, 0.4};

/// Fog from x = 0 to 10, inside it an absorbing volume from 2 to 8, inside that denser fog from 4
/// to 6.
SceneMaker nested(double index = 1.0) {
    SceneMaker maker;
    const auto layer = [&](double lo, double hi, const Material& m) {
        maker.add(BoxShape{{lo, -9, -9}, {hi, 9, 9}}, maker.material(m));
    };
    layer(0, 10, fog(kAbsorbs, kFog, 0.3, index));
    layer(2, 8, absorbing(kAbsorbs, index));
    layer(4, 6, fog({}, kDenser, 0, index));
    return maker;
}

TEST(ConnectedVolumes, ARayTakesItsShareOfEachVolumeThatItCrosses) {
    const Scene scene = nested().compile();
    struct {
        double from, to, in_fog, absorbed, in_denser;
    } const ways[] = {{-3, 13, 4, 4, 2},   {1, 9, 2, 4, 2},  {3, 5, 0, 1, 1},
                      {5, 5.5, 0, 0, 0.5}, {-3, 1, 1, 0, 0}, {7, 20, 2, 1, 0}};
    for (const auto& way : ways) {
        const Passed passed = pass(scene, {way.from, 0.1, 0.2}, {way.to, 0.1, 0.2});
        EXPECT_TRUE(passed.same);
        double passing = 0.0, stopping = 0.0;
        for (int i = 0; i < 3; ++i) {
            const double scattered =
                (kFog[i] + kAbsorbs[i]) * way.in_fog + kDenser[i] * way.in_denser;
            const double expected = std::exp(-scattered - kAbsorbs[i] * way.absorbed);
            EXPECT_NEAR(passed.share[i], expected, 1e-12) << way.from << " " << i;
            EXPECT_NEAR(passed.in_batch[i], expected, 1e-12) << way.from << " " << i;
            const int times = i == 2 ? 2 : 1;  // blue twice
            passing += 0.25 * times * std::exp(-scattered);
            stopping += 0.25 * times * kDenser[i] * std::exp(-scattered);
        }
        EXPECT_NEAR(passed.flight.passing(), passing, 1e-12) << way.from;
        EXPECT_NEAR(passed.flight.stopping({kDenser.r, kDenser.g, kDenser.b, kDenser.b}), stopping,
                    1e-12);
    }
}

TEST(ConnectedVolumes, WhatBendsLightBlocksConnections) {
    for (const double index : {kNearlyOne, 1.3}) {
        const Scene scene = nested(index).compile();
        EXPECT_TRUE(pass(scene, {-3, 0.1, 0.2}, {1, 0.1, 0.2}).share.is_black()) << index;
        EXPECT_TRUE(pass(scene, {-3, 0.1, 0.2}, {1, 0.1, 0.2}).in_batch.is_black()) << index;
        // No refraction between volumes of the same index.
        EXPECT_FALSE(pass(scene, {1, 0.1, 0.2}, {3, 0.1, 0.2}).share.is_black()) << index;
    }
}

/// The touching faces of volumes of one index are one face without refraction, in either order.
TEST(ConnectedVolumes, FacesThatCoincideAreOne) {
    for (const double index : {1.0, 1.3}) {
        for (const bool turned : {false, true}) {
            SceneMaker maker;
            const MaterialId a = maker.material(fog(kAbsorbs, kFog, 0.3, index));
            const MaterialId b = maker.material(fog({}, kDenser, 0, index));
            if (!turned) maker.add(BoxShape{{0, -9, -9}, {4, 9, 9}}, a);
            maker.add(BoxShape{{4, -9, -9}, {10, 9, 9}}, b);
            if (turned) maker.add(BoxShape{{0, -9, -9}, {4, 9, 9}}, a);
            const Passed passed = pass(maker.compile(), {3, 0.1, 0.2}, {6, 0.2, 0.4});
            const double length = std::sqrt(9.0 + 0.01 + 0.04);
            EXPECT_TRUE(passed.same) << index << turned;
            for (int i = 0; i < 3; ++i) {
                const double depth =
                    length * ((kFog[i] + kAbsorbs[i]) / 3.0 + kDenser[i] * 2.0 / 3.0);
                EXPECT_NEAR(passed.share[i], std::exp(-depth), 1e-12) << index << turned;
                EXPECT_NEAR(passed.in_batch[i], std::exp(-depth), 1e-12) << index << turned;
            }
        }
    }
}

/// Either side may be the unbounded one, and its boundary at any distance.
TEST(ConnectedVolumes, VolumesWithoutEndAreFoundFromBothSides) {
    for (int k = 0; k < 6; ++k) {
        Vec3 normal;
        (k % 3 == 0 ? normal.x : k % 3 == 1 ? normal.y : normal.z) = k < 3 ? 1.0 : -1.0;
        for (const double away : {0.5, 3.0, 3000.0}) {
            SceneMaker maker;
            maker.add(ball({0, 0, 0}, 0.2), maker.material(matt({1, 1, 1})));
            maker.add(Plane{away * normal, normal}, maker.material(absorbing(kAbsorbs)));
            const Scene scene = maker.compile();
            const MediaFinder finder(scene);
            EXPECT_NE(finder.around({0.3, 0.1, 0.2}, 0).here(), nullptr) << k << " " << away;
            EXPECT_EQ(finder.around(2.0 * away * normal, 0).here(), nullptr) << k << " " << away;
        }
    }
}

/// Of volumes that share a face the one left last lies outside, whichever is named first.
TEST(ConnectedVolumes, FlushVolumesNestInAnyOrder) {
    for (const std::size_t count : {2u, 3u, 5u}) {
        std::vector<std::size_t> order(count);
        std::iota(order.begin(), order.end(), std::size_t{0});
        // Connections to the sides of a flat inner volume and through its other end.
        for (const bool rod : {false, true}) {
            do {
                SceneMaker maker;
                for (const std::size_t i : order) {
                    const double size = 1.0 + double(i);
                    maker.add(BoxShape{{-size, -size, 0}, {size, size, rod ? 1.0 : size}},
                              maker.material(fog({}, (size / 10.0) * kFog)));
                }
                const Scene scene = maker.compile();
                const Vec3 from{0.1, 0.2, -1}, to{0.1, 0.2, 0.6};
                const Passed passed = pass(scene, from, to);
                EXPECT_TRUE(passed.same);
                // Out of all.
                const Passed out = pass(scene, to, {0.1, 0.2, 9});
                EXPECT_TRUE(out.same);
                double sizes = 0.4;
                for (std::size_t i = 1; i < count && !rod; ++i) sizes += 1.0 + double(i);
                for (int i = 0; i < 3; ++i) {
                    EXPECT_NEAR(passed.share[i], std::exp(-0.06 * kFog[i]), 1e-12);
                    EXPECT_NEAR(passed.in_batch[i], std::exp(-0.06 * kFog[i]), 1e-12);
                    EXPECT_NEAR(out.share[i], std::exp(-0.1 * sizes * kFog[i]), 1e-12);
                }
            } while (std::next_permutation(order.begin(), order.end()));
        }
    }
}

/// A bounded volume of the same material also contains the point: leaving removes that one alone.
TEST(ConnectedVolumes, VolumesWithoutEndLieAroundThoseOfTheirMaterial) {
    for (int k = 0; k < 6; ++k) {
        Vec3 normal;
        (k % 3 == 0 ? normal.x : k % 3 == 1 ? normal.y : normal.z) = k < 3 ? 1.0 : -1.0;
        SceneMaker maker;
        const MaterialId water = maker.material(fog(kAbsorbs, kFog));
        maker.add(ball({0, 0, 0}, 0.2), water);
        maker.add(Plane{5.0 * normal, normal}, water);
        const Passed passed = pass(maker.compile(), {0.1, 0, 0}, {1.1, 0, 0});
        EXPECT_TRUE(passed.same) << k;
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(passed.share[i], std::exp(-kFog[i] - kAbsorbs[i]), 1e-12) << k;
        }
    }
}

/// Two planes bound one volume, which is left through either.
TEST(ConnectedVolumes, ALayerBetweenTwoPlanesIsOneVolume) {
    SceneMaker maker;
    const MaterialId water = maker.material(fog(kAbsorbs, kFog));
    maker.add(Plane{{0, 0, 1}, {0, 0, 1}}, water);
    maker.add(Plane{{0, 0, -1}, {0, 0, -1}}, water);
    const Scene scene = maker.compile();
    for (const double side : {-1.0, 1.0}) {
        const Passed passed = pass(scene, {0, 0, 0}, {0, 0, 3.0 * side});
        EXPECT_TRUE(passed.same) << side;
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(passed.share[i], std::exp(-kFog[i] - kAbsorbs[i]), 1e-12) << side;
        }
    }
}

/// Bounded surfaces, closed or open, contain no point at infinity.
TEST(ConnectedVolumes, NothingBoundedReachesToInfinity) {
    SceneMaker maker;
    TriangleMesh sheet;
    sheet.positions = {{-9, -9, -1}, {9, -9, 1}, {0, 9, 0}};
    for (const bool turned : {false, true}) {
        sheet.triangles = {{0, 1, 2}};
        if (turned) std::swap(sheet.triangles[0][1], sheet.triangles[0][2]);
        maker.add(maker.mesh(sheet), maker.material(absorbing(kAbsorbs)));
    }
    maker.add(Plane{{0, 0, -20}, {0, 0, 1}}, maker.material(absorbing(kFog)));
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    EXPECT_NE(finder.around({1, 1, -1}, 0).here(), nullptr);
    EXPECT_EQ(finder.without_end_around({1, 1, -1}, 0).here(), nullptr);
    EXPECT_EQ(finder.without_end_around({1.2, 0.9, -1.5}, 0).here(), nullptr);
    EXPECT_NE(finder.without_end_around({4, 3, -25}, 0).here(), nullptr);
}

/// No boundary behind an opaque surface is crossed.
TEST(ConnectedVolumes, NothingIsCrossedWithAnOpaqueFace) {
    SceneMaker maker;
    maker.add(BoxShape{{-1, -1, 0}, {1, 1, 1}}, maker.material(fog({}, kFog)));
    maker.add(BoxShape{{-2, -2, 0}, {2, 2, 2}}, maker.material(fog({}, kDenser)));
    maker.add(BoxShape{{-3, -3, -1}, {3, 3, 0}}, maker.material(matt({1, 1, 1})));
    const Scene scene = maker.compile();
    CoincidentFaces faces(scene);
    for (const double x : {0.1, 1.5}) {
        const Ray ray{{x, 0.2, 0.5}, {0, 0, -1}};
        Hit hit;
        ASSERT_TRUE(scene.aggregate->closest(ray, hit, {nullptr, kAllRays, 0.0f}));
        ShadingPoint point;
        const Arrival arrival{true, 0.0, 0.0f, false};
        set_shading_point(scene, ray, hit, arrival, {}, point);
        faces.find(point, ray.direction, arrival, kAllRays);
        EXPECT_TRUE(faces.opaque().has_value()) << x;
        EXPECT_TRUE(faces.others().empty()) << x;
    }
}

TEST(ConnectedVolumes, WhereNothingScattersVolumesOfTheIndexOfTheAirLetLightThrough) {
    const auto block = [](const Material& material, double air = 1.0) {
        SceneMaker maker;
        maker.description().conventions.shading.air_index = air;
        maker.add(BoxShape{{0, -9, -9}, {10, 9, 9}}, maker.material(material));
        return maker;
    };
    const Vec3 before{-3, 0.1, 0.2}, in{1, 0.1, 0.2}, behind{12, 0.1, 0.2};
    for (const double index : {1.0, kNearlyOne, 1.3}) {
        for (const double air : {1.0, 1.3}) {
            const Scene scene = block(absorbing(kAbsorbs, index), air).compile();
            const Passed into = pass(scene, before, in), through = pass(scene, before, behind);
            if (index != air) {
                EXPECT_TRUE(into.share.is_black()) << index;
                EXPECT_TRUE(through.in_batch.is_black()) << index;
            } else {
                EXPECT_NEAR(into.share.a, std::exp(-0.7), 1e-12);
                EXPECT_NEAR(into.in_batch.c, std::exp(-0.4), 1e-12);
                EXPECT_NEAR(through.share.b, std::exp(-1.0), 1e-12);
                EXPECT_TRUE(into.same && through.same);
            }
            EXPECT_NEAR(pass(scene, in, {3, 0.1, 0.2}).share.a, std::exp(-1.4), 1e-12);
        }
    }
    Material tinted, matt_too = matt({0.5, 0.5, 0.5});
    tinted.diffuse.color = {};
    tinted.transmissive.color = matt_too.transmissive.color = {0.5, 0.4, 0.3};
    // Each of the two faces takes its share.
    EXPECT_NEAR(pass(block(tinted).compile(), before, behind).share.a, 0.25, 1e-12);
    EXPECT_TRUE(pass(block(matt_too).compile(), before, behind).share.is_black());
    SceneMaker nested = block(absorbing(kAbsorbs));
    nested.add(BoxShape{{2, -8, -8}, {4, 8, 8}}, nested.material(absorbing(kFog)));
    nested.add(BoxShape{{4, -8, -8}, {5, 8, 8}}, nested.material(absorbing(kDenser)));
    EXPECT_NEAR(pass(nested.compile(), before, behind).share.b, std::exp(-0.7 - 0.6 - 0.6), 1e-12);
}

/// A block around a solid of two media side by side.
TEST(ConnectedVolumes, ASolidOfSeveralMediaLeavesTheVolumeAroundItAsItWas) {
    for (const double index : {1.0, 1.3}) {
        SceneMaker maker;
        maker.add(BoxShape{{0, -9, -9}, {10, 9, 9}}, maker.material(fog(kAbsorbs, kFog, 0, index)));
        const ObjectIndex solid = maker.object("solid");
        maker.description().objects.back().combine = Combine::Union;
        const auto add = [&](double from, double to, const Rgb& absorption) {
            maker.add(BoxShape{{from, -8, -8}, {to, 8, 8}},
                      maker.material(absorbing(absorption, index)), {}, solid);
        };
        add(2, 4, kFog);
        add(4, 7, kDenser);
        maker.add(solid);
        const Scene scene = maker.compile();
        const double before = index == 1.0 ? -3 : 0.5, behind = index == 1.0 ? 13 : 9.5;
        const double around = (index == 1.0 ? 10 : 9) - 5;
        const Passed through = pass(scene, {before, 0.1, 0.2}, {behind, 0.1, 0.2});
        EXPECT_TRUE(through.same) << index;
        for (int i = 0; i < 3; ++i) {
            const double lost = around * (kAbsorbs[i] + kFog[i]) + 2 * kFog[i] + 3 * kDenser[i];
            EXPECT_NEAR(through.share[i], std::exp(-lost), 1e-12) << index << " " << i;
        }
        const Passed within = pass(scene, {3, 0.1, 0.2}, {8, 0.1, 0.2});
        EXPECT_NEAR(within.share.a, std::exp(-0.1 - 1.5 - 0.8), 1e-12) << index;
        EXPECT_TRUE(within.same) << index;
    }
}

/// A block across the wall between the two media of a solid, which both lie around it.
TEST(ConnectedVolumes, AWallOfASolidWithinAnotherVolumeChangesNothingYet) {
    SceneMaker maker;
    const ObjectIndex solid = maker.object("solid");
    maker.description().objects.back().combine = Combine::Union;
    maker.add(BoxShape{{2, -8, -8}, {4, 8, 8}}, maker.material(absorbing(kFog)), {}, solid);
    maker.add(BoxShape{{4, -8, -8}, {7, 8, 8}}, maker.material(absorbing(kDenser)), {}, solid);
    maker.add(solid);
    maker.add(BoxShape{{3, -7, -7}, {5, 7, 7}}, maker.material(absorbing(kAbsorbs)));
    const Passed through = pass(maker.compile(), {-3, 0.1, 0.2}, {13, 0.1, 0.2});
    EXPECT_TRUE(through.same);
    for (int i = 0; i < 3; ++i) {
        const double lost = kFog[i] + 2 * kAbsorbs[i] + 2 * kDenser[i];
        EXPECT_NEAR(through.share[i], std::exp(-lost), 1e-12) << i;
    }
}

TEST(ConnectedVolumes, SheetsAndCutOutsInVolumesLetLightThrough) {
    SceneMaker maker = nested();
    Material sheet = smooth_glass(), half = matt({1, 1, 1});
    sheet.metallic_roughness->thickness.value = 0;
    sheet.metallic_roughness->base_color.color = {0.5, 0.5, 0.5};
    half.alpha_mode = AlphaMode::Blend;
    half.alpha.value = 0.25;
    const Scene clear = nested().compile();
    maker.add(rectangle({1, -1, -1}, {0, 2, 0}, {0, 0, 2}), maker.material(half));
    const Scene scene = maker.compile();
    const Vec3 from{-1, 0.1, 0.2}, to{5, 0.1, 0.2};
    EXPECT_NEAR(pass(scene, from, to).share.b, 0.75 * pass(clear, from, to).share.b, 1e-12);
    maker.add(rectangle({5.5, -1, -1}, {0, 2, 0}, {0, 0, 2}), maker.material(sheet));
    const Scene both = maker.compile();
    const Vec3 in{5, 0.1, 0.2}, out{12, 0.1, 0.2};
    const double tinted = pass(both, in, out).share.b / pass(clear, in, out).share.b;
    EXPECT_GT(tinted, 0.4);
    EXPECT_LT(tinted, 0.5);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
