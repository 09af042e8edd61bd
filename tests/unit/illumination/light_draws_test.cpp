// Lights sampled for many points at once have the bits of those sampled one by one.

#include "alhazen/illumination/light_draws.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <memory>

#include "alhazen/sampling/random.h"
#include "alhazen/simd/targets.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

Rectangle rectangle(const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v) {
    Rectangle r;
    r.corner = corner;
    r.edge_u = edge_u;
    r.edge_v = edge_v;
    return r;
}

/// One rectangle; with `several` more on both sides of the points, one of them oblique, and lights
/// of other forms; with `many` also small ones, most of them far from a point.
enum class Lamps { One, Several, Many };

/// Triangles, squares and parallelograms, some of them in planes of the grid of points.
void add_small_lamps(SceneMaker& maker, MaterialId one_sided, MaterialId two_sided) {
    RandomStream random(8);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
        const double size = i % 5 == 0 ? 0.5 : 0.02;
        const double turn = random.uniform(0, 6), wide = size * std::cos(turn),
                     high = size * std::sin(turn);
        Vec3 at{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
        if (i % 4 == 0) at.z = 0.5 * std::round(2.0 * at.z);
        const MaterialId material = i % 3 == 0 ? two_sided : one_sided;
        maker.add(rectangle(at, {wide, high, 0}, {-high, wide, 0}), material);
        maker.add(rectangle(-at, {wide, high, 0}, {0, size, 0.3 * size}), material);
        const std::uint32_t first = 3 * i;
        mesh.positions.insert(mesh.positions.end(),
                              {at, at + Vec3{wide, high, 0}, at + Vec3{0, high, size}});
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    maker.add(maker.mesh(mesh), one_sided);
    maker.add(maker.mesh(mesh), two_sided);
}

Scene lamps(Lamps which) {
    const bool one = which == Lamps::One;
    SceneMaker maker;
    const auto shining = [&](bool two_sided) {
        Material m;
        m.emission.color = {2, 3, 4};
        m.double_sided = two_sided;
        return maker.material(m);
    };
    maker.add(rectangle({-1, -0.5, 3}, {0, 1.5, 0}, {2, 0, 0}), shining(false));
    if (!one) {
        maker.add(rectangle({-3, -2, 0.25}, {1.5, 0.5, 0.25}, {-0.5, 1.5, 0}), shining(true));
        maker.add(rectangle({2, -2, -1}, {0, 0, 0.75}, {0, 3, 0}), shining(false));
        maker.add(rectangle({40, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01}), shining(true));
        maker.add(Sphere{{0.3, 2, 1}, 0.4}, shining(true));
        Image image(4, 4, 3);
        for (std::size_t i = 0; i < image.samples.size(); ++i) {
            image.samples[i] = static_cast<float>(i * 7 % 11);
        }
        ImageTexture texture;
        texture.image = std::make_shared<const StoredImage>(stored(image));
        maker.description().textures.push_back({"picture", texture, {}});
        Material pictured;
        pictured.emission = {.color = {1, 2, 1}, .texture = TextureId{0}};
        maker.add(rectangle({-2, 2, 0.5}, {1, 0, 0.5}, {0, 1, 0}), maker.material(pictured));
        TriangleMesh mesh;
        mesh.positions = {{-1, -1, -3}, {1, -1, -3.5}, {0.2, 1.5, -2.5}};
        mesh.triangles = {{0, 1, 2}};
        maker.add(maker.mesh(mesh), shining(true));
        maker.light(PointLight{.position = {1, 1, 2}, .color = {9, 9, 9}});
    }
    if (which == Lamps::Many) add_small_lamps(maker, shining(false), shining(true));
    return maker.compile();
}

/// A picture of all directions, with the disc of the sun in front.
std::shared_ptr<const Environment> clear_sky_with_sun() {
    EnvironmentSettings settings;
    settings.kind = EnvironmentKind::Sky;
    return std::make_shared<const Environment>(settings, Vec3{0, 0, 1});
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const Vec3& a, const Vec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

/// A point anywhere, or on a coarse grid: in the planes of the lights or beside their edges.
Vec3 random_point(RandomStream& random, bool on_grid) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
        p[k] = random.uniform(-4, 4);
        if (on_grid) p[k] = 0.5 * std::round(2.0 * p[k]);
    }
    return p;
}

TEST(LightDraws, ManyAtOnceHaveTheBitsOfThoseOneByOne) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        for (const Lamps which : {Lamps::One, Lamps::Several, Lamps::Many}) {
            for (const bool sky : {false, true}) {
                Scene scene = lamps(which);
                if (sky) scene.environment = clear_sky_with_sun();
                const Illumination lights(scene);
                LightDraws draws(lights);
                const Wavelengths four = Wavelengths::drawn(0.3);
                RandomStream random(31);
                std::size_t shone = 0, below = 0;
                for (int batch = 0; batch < 4000; ++batch) {
                    draws.clear();
                    // The caller fills the lanes itself.
                    const bool in_lanes = batch % 3 == 0;
                    // Some lanes stay empty.
                    const std::size_t count = 1 + random.below(LightDraws::kMost);
                    std::vector<LightDraw> expected;
                    std::vector<LitPoint> points;
                    for (std::size_t i = 0; i < count; ++i) {
                        const bool both_sides = random.below(3) > 0;
                        const Vec3 normal =
                            random.below(2) == 0 ? Vec3{0, 0, 1} : Vec3{0.6, 0, -0.8};
                        const LitPoint at{random_point(random, batch % 2 == 0), normal, both_sides};
                        points.push_back(at);
                        const double choice = random.uniform(0, 1);
                        const Vec2 u{random.uniform(0, 1),
                                     random.below(9) == 0 ? 0.0 : random.uniform(0, 1)};
                        const bool is_spectral = !in_lanes && random.below(4) == 0;
                        const Wavelengths& waves = is_spectral ? four : kColorChannels;
                        expected.push_back(lights.draw(at, choice, u, waves));
                        if (!in_lanes) {
                            draws.add(at, choice, u, waves);
                            continue;
                        }
                        LightCallLanes& calls = draws.calls();
                        calls.at.set(i, at);
                        calls.choice[i] = choice;
                        calls.u[0][i] = u.x;
                        calls.u[1][i] = u.y;
                    }
                    if (in_lanes) {
                        draws.draw(count);
                    } else {
                        draws.draw();
                    }
                    ASSERT_EQ(draws.size(), count);
                    for (std::size_t i = 0; i < count; ++i) {
                        const LightDraw &a = draws[i], &b = expected[i];
                        // Of the picture, light from below is not looked up.
                        const bool is_below = !points[i].both_sides && !b.singular &&
                                              std::isinf(b.distance) &&
                                              !(dot(b.to_light, points[i].normal) > 0.0);
                        if (is_below) {
                            ++below;
                            if (a.density == 0.0) continue;
                        }
                        ASSERT_TRUE(same_bits(a.density, b.density)) << target << " " << batch;
                        ASSERT_TRUE(same_bits(a.distance, b.distance)) << target << " " << batch;
                        ASSERT_TRUE(same_bits(a.to_light, b.to_light)) << target << " " << batch;
                        ASSERT_EQ(a.radiance, b.radiance);
                        ASSERT_EQ(a.singular, b.singular);
                        ASSERT_EQ(a.place.source, b.place.source);
                        ASSERT_TRUE(same_bits(a.place.parameters.x, b.place.parameters.x));
                        ASSERT_TRUE(same_bits(a.place.parameters.y, b.place.parameters.y));
                        shone += a.density > 0.0;
                    }
                }
                EXPECT_GT(shone, 3000u);
                EXPECT_EQ(below > 50u, sky);
            }
        }
    }
}

/// Rounding alone decides on which side of the only rectangle they are; others are beside it.
TEST(LightDraws, PointsInThePlaneOfASoleRectangleHaveTheBitsOfThoseOneByOne) {
    const Vec3 corner{-3, -2, 0.25}, edge_u{1.5, 0.5, 0.25}, edge_v{-0.5, 1.5, 0};
    SceneMaker maker;
    Material shining;
    shining.emission.color = {2, 3, 4};
    maker.add(rectangle(corner, edge_u, edge_v), maker.material(shining));
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        LightDraws draws(lights);
        RandomStream random(7);
        for (int batch = 0; batch < 200; ++batch) {
            draws.clear();
            std::vector<LightDraw> expected;
            for (std::size_t i = 0; i < LightDraws::kMost; ++i) {
                const double u = random.uniform(-1, 2), v = random.uniform(-1, 2);
                const Vec3 away{0, 0, i % 2 == 0 ? 0.0 : 1.0};
                const LitPoint at{corner + u * edge_u + v * edge_v + away, {0, 0, 1}, true};
                const Vec2 place{random.uniform(0, 1), random.uniform(0, 1)};
                draws.add(at, 0.5, place, kColorChannels);
                expected.push_back(lights.draw(at, 0.5, place, kColorChannels));
            }
            draws.draw();
            for (std::size_t i = 0; i < LightDraws::kMost; ++i) {
                EXPECT_TRUE(same_bits(draws[i].density, expected[i].density)) << target;
                EXPECT_TRUE(same_bits(draws[i].to_light, expected[i].to_light)) << target;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
