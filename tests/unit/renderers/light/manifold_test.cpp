#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "alhazen/geometry/mirrors/alhazens_problem.h"
#include "alhazen/renderers/manifold/chain_solver.h"
#include "alhazen/renderers/manifold/normal_change.h"
#include "alhazen/renderers/manifold/sphere_chains.h"
#include "support/fresnel.h"
#include "support/light_pictures.h"
#include "support/lit_rooms.h"
#include "support/random.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::fresnel;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::Random;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
constexpr double kPi = std::numbers::pi;

Material clear_glass(double index, const Rgb& absorption = {}) {
    Material m;
    m.dielectric = Dielectric{absorption};
    m.index.value = index;
    return m;
}
Material mirror(const Rgb& color = {1, 1, 1}) {
    Material m;
    m.reflective.color = color;
    return m;
}
PointLight lamp_at(const Vec3& position, double color = 1.0) {
    return PointLight{
        .position = position, .color = {color, color, color}, .attenuation = {0, 0, 1}};
}

/// A point of the floor from which chains start.
ShapeSurface start_at(const Vec3& point) {
    ShapeSurface s;
    s.point = point;
    s.normal = s.shading_normal = {0, 0, 1};
    return s;
}

TriangleMesh smooth_mesh(int levels) {
    const testing::SphereMesh sphere(levels);
    TriangleMesh mesh;
    mesh.positions = sphere.positions;
    mesh.triangles = sphere.triangles;
    mesh.generate_normals();
    return mesh;
}

/// Shapes around (0, 0, 2), with every kind of derivative of the normal.
void add_shape(SceneMaker& maker, int which, MaterialId material) {
    const Affine up = Affine::translate({0, 0, 2});
    switch (which) {
        case 0:
            return maker.add(ball({0, 0, 2}, 0.7), material);
        case 1:
            return maker.add(ball({0, 0, 0}, 1), material,
                             up * Affine::rotate({1, 2, 0}, 0.4) * Affine::scale({1, 0.6, 0.4}));
        case 2: {
            Cylinder c;
            c.base = {-2, 0, 0};
            c.top = {2, 0, 0};
            c.radius = 0.6;
            return maker.add(c, material, up);
        }
        case 3: {
            Quadric q;
            q.squares = {1, 2, 3};
            q.products = {0.1, 0.2, 0.3};
            q.constant = -0.5;
            return maker.add(q, material, up);
        }
        case 4: {
            Torus t;
            return maker.add(t, material, up * Affine::scale({0.5, 0.5, 0.5}));
        }
        case 5: {
            return maker.add(maker.mesh(smooth_mesh(2)), material,
                             up * Affine::scale({0.8, 0.7, 0.6}));
        }
        case 6: {
            Ellipsoid e;
            e.axis_a = {0.7, 0.2, 0};
            e.axis_b = {-0.1, 0.5, 0.1};
            e.axis_c = {0, 0.1, 0.6};
            return maker.add(e, material, up);
        }
        default: {
            BoxShape box;
            return maker.add(box, material, up * Affine::rotate({1, 1, 0}, 0.1));
        }
    }
}
constexpr int kShapes = 8;

TEST(Manifold, NormalsChangeAsNeighbouringOnesDo) {
    Random random(5);
    for (int which = 0; which < kShapes; ++which) {
        SceneMaker maker;
        add_shape(maker, which, maker.material(mirror()));
        const Scene scene = maker.compile();
        int compared = 0;
        for (int i = 0; i < 200; ++i) {
            const Vec3 from{random.uniform(-1, 1), random.uniform(-1, 1), -1};
            const Ray ray{from, normalize(Vec3{0, 0, 2} + 0.4 * random.unit_vector() - from)};
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, {nullptr})) continue;
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            const auto exact = normal_change(*scene.aggregate, ray, hit, surface, 0.0f);
            const auto near = normal_change_by_differences(*scene.aggregate, ray, hit, surface, 0);
            if (!exact || !near) continue;
            ++compared;
            const Vec3 t = perpendicular(surface.normal);
            for (const Vec3& along : {t, cross(surface.normal, t)}) {
                ASSERT_LT(length(*exact * along - *near * along), 1e-4) << "shape " << which;
            }
        }
        EXPECT_GT(compared, 50) << "shape " << which;
    }
}

TEST(Manifold, ChainsChangeAsTheirDerivativesSay) {
    Random random(6);
    for (int which = 0; which < kShapes; ++which) {
        for (const ChainKind kind :
             {ChainKind::Reflection, ChainKind::Refraction, ChainKind::TwoRefractions}) {
            SceneMaker maker;
            add_shape(maker, which, maker.material(clear_glass(1.5)));
            const Scene scene = maker.compile();
            RayCounters counters;
            const ChainTracer tracer(scene, counters);
            const std::uint64_t key = [&] {
                Hit hit;
                const Ray ray{{0.45, 0.01, -9}, {0, 0, 1}};
                const bool found = scene.aggregate->closest(ray, hit, {nullptr});
                EXPECT_TRUE(found);
                return part_key(surface_at(*scene.aggregate, ray, hit));
            }();
            const ChainIndices indices{{1 / 1.5, 1.5}, {true, false}};
            int compared = 0;
            for (int i = 0; i < 100; ++i) {
                const ShapeSurface from =
                    start_at({random.uniform(-1, 1), random.uniform(-1, 1), -1});
                const Vec3 d = normalize(Vec3{0, 0, 2} + 0.5 * random.unit_vector() - from.point);
                Chain chain, plus, minus;
                if (!tracer.follow(from, d, kind, key, indices, 0, chain)) continue;
                const auto slope = tracer.slope(chain, 0);
                if (!slope) continue;
                constexpr double kStep = 1e-6;
                bool all = true;
                for (std::size_t k = 0; k < 2 && all; ++k) {
                    const Vec3 step = kStep * slope->first[k];
                    all = tracer.follow(from, normalize(d + step), kind, key, indices, 0, plus) &&
                          tracer.follow(from, normalize(d - step), kind, key, indices, 0, minus);
                    // Over an edge of a mesh there is none.
                    for (int v = 0; v < chain.length(); ++v) {
                        const auto n = static_cast<std::size_t>(v);
                        all = all && plus.at[n].hit.primitive == minus.at[n].hit.primitive &&
                              plus.at[n].hit.part == minus.at[n].hit.part;
                    }
                    if (!all) break;
                    const Vec3 turned = (plus.last().leaving - minus.last().leaving) / (2 * kStep);
                    const Vec3 moved =
                        (plus.last().surface.point - minus.last().surface.point) / (2 * kStep);
                    const double size = 1.0 + length(turned) + length(moved);
                    ASSERT_LT(length(turned - slope->direction[k]), 2e-5 * size * size)
                        << "shape " << which << ", kind " << int(kind);
                    ASSERT_LT(length(moved - slope->end[k]), 2e-5 * size * size);
                }
                compared += all;
            }
            EXPECT_GT(compared, 10) << "shape " << which << ", kind " << int(kind);
        }
    }
}

TEST(Manifold, AllChainsThroughABallAreFound) {
    // Directions of a fine fan whose last ray passes the light on the other side.
    Random random(8);
    int several = 0;
    for (int i = 0; i < 300; ++i) {
        const double index = random.uniform(1.0, 2.4);
        const Vec3 from{0, 0, -random.uniform(1.05, 4.0)};
        const double away = random.uniform(1.05, 4.0), angle = random.uniform(0.0, kPi);
        const Vec3 to{away * std::sin(angle), 0, away * std::cos(angle)};
        const bool infinite = i % 3 == 0;
        const ChainEnd end{infinite ? normalize(to) : to, infinite};
        // In the plane y = 0, the signed offset of the last ray from the light.
        const auto miss = [&](double turn, bool& valid) {
            const Vec3 d{std::sin(turn), 0, std::cos(turn)};
            const double b = dot(from, d), rest = b * b - (dot(from, from) - 1.0);
            valid = rest > 0.0;
            if (!valid) return 0.0;
            const Vec3 p = from + (-b - std::sqrt(rest)) * d;
            const auto bent = [](const Vec3& v, const Vec3& n, double eta) {
                const double c = -dot(v, n);
                return eta * v + (eta * c - std::sqrt(1.0 - eta * eta * (1.0 - c * c))) * n;
            };
            const Vec3 inside = bent(d, p, 1.0 / index);
            const Vec3 q = p - (2.0 * dot(p, inside)) * inside;
            const Vec3 out = bent(inside, -q, index);
            const Vec3 way = infinite ? end.at : end.at - q;
            valid = dot(out, way) > 0.0;
            return out.x * way.z - out.z * way.x;
        };
        int expected = 0;
        constexpr int kFan = 20001;
        const double most = std::asin(1.0 / length(from));
        double before = 0.0;
        bool valid_before = false;
        for (int k = 0; k < kFan; ++k) {
            bool valid = false;
            const double now = miss(most * (2.0 * (k + 0.37) / kFan - 1.0), valid);
            expected += valid && valid_before && now * before < 0.0;
            before = now;
            valid_before = valid;
        }
        const ChainSeeds seeds = refractions_by_ball({{0, 0, 0}, 1.0}, index, from, end);
        EXPECT_GE(int(seeds.size()), expected) << "seed 8, case " << i;
        EXPECT_LE(int(seeds.size()), expected + 1) << "seed 8, case " << i;  // at the very rim
        several += expected > 1;
        for (const Vec3& d : seeds) {
            bool valid = false;
            const double off = miss(std::atan2(d.x, d.z), valid);
            if (std::abs(std::atan2(d.x, d.z)) > 0.9999 * most) continue;
            EXPECT_TRUE(valid);
            EXPECT_NEAR(off, 0.0, 1e-7) << "seed 8, case " << i;
        }
    }
    EXPECT_GT(several, 5);
}

/// Irradiance, perpendicular to its direction, of the light of intensity 1 that a mirror of radius
/// r reflects: from the tangential and the sagittal focus.
double by_convex_mirror(double to_mirror, double to_floor, double cosine, double radius) {
    const double product = 2.0 * to_mirror * to_floor / radius;
    return 1.0 /
           ((to_mirror + to_floor + product / cosine) * (to_mirror + to_floor + product * cosine));
}

TEST(Manifold, ABallShowsTheFloorTheLampWhereAlhazenPutsIt) {
    const Vec3 lamp{1.2, 0.4, 1.5}, center{-0.6, 0.1, 0.8};
    constexpr double kRadius = 0.5;
    SceneMaker maker = floor_from_above(1e-4);
    maker.add(ball(center, kRadius), maker.material(mirror({0.8, 0.8, 0.8})));
    maker.light(lamp_at(lamp));
    const Scene scene = maker.compile();
    const double direct = mean_of(picture_of(scene, "path_tracing:depth=2", 1, 1)).g;
    const double all = mean_of(picture_of(scene, "path_tracing:depth=2,manifold=on", 1, 1)).g;
    const MirrorPoints p = reflecting_points(center, kRadius, MirrorFace::Outer, {lamp}, {{}});
    ASSERT_EQ(p.count, 1);
    const Vec3 z = p.points[0], to_floor = -z, to_lamp = lamp - z;
    const double cosine = dot(normalize(to_lamp), normalize(z - center));
    const double expected = 0.8 * (z.z / length(z)) *
                            by_convex_mirror(length(to_lamp), length(to_floor), cosine, kRadius);
    EXPECT_NEAR(all - direct, expected, 1e-3 * expected);
}

/// The four mirror points of a concave mirror, added up.
TEST(Manifold, AConcaveMirrorSendsTheLampAlongAllFourWays) {
    const Vec3 lamp{0.9, 0.1, 0.3};
    SceneMaker maker;
    maker.description().conventions.shading.clamp_attenuation = false;
    maker.description().cameras[0].camera =
        OrthographicCamera{{-0.9, 0.1, 0.2}, {0, 0, -1}, {1e-5, 0, 0}, {0, 1e-5, 0}};
    maker.add(rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), maker.material(matt({1, 1, 1})));
    const Vec3 center{0, 0, 0.2};
    maker.add(ball(center, 1.4), maker.material(mirror()));
    maker.light(lamp_at(lamp));
    const Scene scene = maker.compile();
    const double direct = mean_of(picture_of(scene, "path_tracing:depth=2", 1, 1)).g;
    const double all = mean_of(picture_of(scene, "path_tracing:depth=2,manifold=on", 1, 1)).g;
    const Vec3 floor{-0.9, 0.1, 0};
    const MirrorPoints p = reflecting_points(center, 1.4, MirrorFace::Inner, {lamp}, {floor});
    double expected = 0.0;
    int above = 0;
    for (int i = 0; i < p.count; ++i) {
        const Vec3 z = p.points[static_cast<std::size_t>(i)];
        if (z.z < 0.0) continue;  // below the floor
        ++above;
        const double a = length(lamp - z), b = length(floor - z);
        const double cosine = dot(normalize(lamp - z), normalize(center - z));
        expected += z.z / b * std::abs(by_convex_mirror(a, b, cosine, -1.4));
    }
    EXPECT_GE(above, 1);
    EXPECT_NEAR(all - direct, expected, 1e-3 * expected);
}

TEST(Manifold, APaneOfGlassShiftsTheLamp) {
    constexpr double kIndex = 1.5, kThick = 0.4, kAbove = 1.6;  // the rest is in air
    for (const double aside : {0.0, 0.7}) {
        SceneMaker maker = floor_from_above(1e-4);
        maker.description().conventions.shading.clamp_attenuation = false;
        BoxShape pane;
        pane.lo = {-3, -3, 1 - kThick / 2};
        pane.hi = {3, 3, 1 + kThick / 2};
        maker.add(pane, maker.material(clear_glass(kIndex, {0.5, 1.0, 0.0})));
        maker.light(lamp_at({aside, 0, kAbove + kThick}));
        const Scene scene = maker.compile();
        const Rgb seen = mean_of(picture_of(scene, "path_tracing:depth=3,manifold=on", 2, 512));
        // The angle at which light arrives `aside`, and the area that a cone of light covers there.
        const auto inside = [&](double sine) { return std::asin(sine / kIndex); };
        const auto place = [&](double angle) {
            return kAbove * std::tan(angle) + kThick * std::tan(inside(std::sin(angle)));
        };
        double angle = std::atan(aside / 2.0);
        for (int i = 0; i < 50; ++i) {
            angle -= (place(angle) - aside) / ((place(angle + 1e-6) - place(angle - 1e-6)) / 2e-6);
        }
        const double slope = (place(angle + 1e-5) - place(angle - 1e-5)) / 2e-5;
        const double area = aside > 0.0 ? slope * aside / std::sin(angle) : slope * slope;
        const double passes = std::pow(1.0 - fresnel(std::cos(angle), kIndex), 2);
        const double length = kThick / std::cos(inside(std::sin(angle)));
        const double expected = passes / area;
        EXPECT_NEAR(seen.b, expected, 0.04 * expected) << aside;
        EXPECT_NEAR(seen.r, expected * std::exp(-0.5 * length), 0.04 * expected) << aside;
        EXPECT_NEAR(seen.g / seen.b, std::exp(-1.0 * length), 1e-3) << aside;
    }
}

TEST(Manifold, APoolOfWaterIsLitFromAbove) {
    constexpr double kIndex = 1.33, kDepth = 1.0, kHigh = 1.5, kAside = 0.8;
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 3}, {0, 0, -1}, {1e-4, 0, 0}, {0, 1e-4, 0}};
    maker.add(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), maker.material(matt({1, 1, 1})));
    Plane water;
    water.point = {0, 0, kDepth};
    maker.add(water, maker.material(clear_glass(kIndex)));
    maker.light(lamp_at({kAside, 0, kDepth + kHigh}));
    const Scene scene = maker.compile();
    const double seen = mean_of(picture_of(scene, "path_tracing:depth=3,manifold=on", 4, 256)).g;
    const auto place = [&](double angle) {
        return kHigh * std::tan(angle) + kDepth * std::tan(std::asin(std::sin(angle) / kIndex));
    };
    double lo = 0.0, hi = 1.5;
    for (int i = 0; i < 60; ++i) (place(0.5 * (lo + hi)) < kAside ? lo : hi) = 0.5 * (lo + hi);
    const double slope = (place(lo + 1e-5) - place(lo - 1e-5)) / 2e-5;
    const double irradiance =
        (1.0 - fresnel(std::cos(lo), kIndex)) * std::sin(lo) / (kAside * slope);
    const double expected = (1.0 - fresnel(1.0, kIndex)) / (kIndex * kIndex) * irradiance;
    EXPECT_NEAR(seen, expected, 0.02 * expected);
}

/// Hides the last part from the eye, because light paths do not find surfaces seen in mirrors and
/// through glass.
void hide_last(SceneMaker& maker) {
    maker.description().objects[0].parts.back().visible_to =
        kRaysOfAllKinds & ~mask_of(RayKind::Eye);
}

/// One of 500 runs has a t of 22 degrees of freedom beyond it, with 4 blocks and 9 scenes.
constexpr double kMostT = 5.4;

void expect_chains(const std::string& name, int depth, const std::string& other,
                   const std::function<void(SceneMaker&)>& fill, int samples = 24) {
    SceneMaker maker;
    testing::add_walls(maker, {0.7, 0.7, 0.7});
    fill(maker);
    const std::string of_depth = ":depth=" + std::to_string(depth);
    expect_same_light(maker.compile("wide_bvh"), name,
                      {"path_tracing" + of_depth + ",manifold=on", other + of_depth}, samples,
                      kMostT);
}

TEST(Manifold, RoomsWithPointsOfLightAreAsLightTracingShowsThem) {
    expect_chains("mirror ball", 2, "light_tracing", [](SceneMaker& m) {
        m.add(ball({0.2, 0, 0.6}, 0.4), m.material(mirror({0.9, 0.8, 0.7})));
        hide_last(m);
        m.light(lamp_at({-0.4, -0.3, 1.6}, 2));
    });
    expect_chains("glass ball", 3, "light_tracing", [](SceneMaker& m) {
        m.add(ball({0.2, 0, 0.8}, 0.4), m.material(clear_glass(1.5, {0.2, 0.1, 0})));
        hide_last(m);
        m.light(lamp_at({0.3, -0.3, 1.8}, 2));
    });
    expect_chains("squeezed ball of glass", 3, "light_tracing", [](SceneMaker& m) {
        m.add(ball({0, 0, 0}, 1), m.material(clear_glass(1.4)),
              Affine::translate({0.1, 0, 0.9}) * Affine::scale({0.5, 0.4, 0.3}));
        hide_last(m);
        m.light(lamp_at({0.2, -0.2, 1.8}, 2));
    });
    expect_chains("lamp in a ball", 2, "light_tracing", [](SceneMaker& m) {
        m.add(ball({0.1, 0, 1.0}, 0.5), m.material(clear_glass(1.5)));
        hide_last(m);
        m.light(lamp_at({0.1, 0.1, 1.2}, 2));
    });
    expect_chains("ring of metal", 2, "light_tracing", [](SceneMaker& m) {
        Cylinder ring;
        ring.radius = 0.6;
        ring.base = {0, 0, 0.01};
        ring.top = {0, 0, 0.4};
        ring.capped = false;
        m.add(ring, m.material(mirror({0.9, 0.7, 0.4})));
        hide_last(m);
        m.light(lamp_at({-0.7, -0.5, 1.6}, 2));
    });
    expect_chains("sun by a tilted mirror", 2, "light_tracing", [](SceneMaker& m) {
        m.add(rectangle({0.2, -0.5, 0.1}, {0.5, 0.3, 0}, {0, 0.1, 0.8}),
              m.material(mirror({0.9, 0.9, 0.9})));
        hide_last(m);
        m.light(DirectionalLight{.to_light = normalize(Vec3{0.1, -1, 0.9}), .color = {1, 1, 0.5}});
    });
}

TEST(Manifold, LightOfLampsThatCanBeHitIsNotCountedTwice) {
    // Paths also find it, slowly; light paths need no specular chain.
    expect_chains(
        "lamp above a glass ball", 6, "light_tracing",
        [](SceneMaker& m) {
            m.add(ball({0.2, 0, 0.7}, 0.4), m.material(clear_glass(1.5)));
            hide_last(m);
            m.add(ball({0.2, -0.1, 1.7}, 0.15), m.material(shining({20, 18, 16})));
        },
        16);
    expect_chains(
        "lamp beside a mirror", 4, "path_tracing",
        [](SceneMaker& m) {
            m.add(rectangle({0.95, -1, 0}, {0, 0, 2}, {0, 2, 0}),
                  m.material(mirror({0.9, 0.9, 0.9})));
            m.add(ball({0.3, 0.2, 1.2}, 0.25), m.material(shining({9, 8, 7})));
        },
        16);
    expect_chains(
        "mesh of glass", 4, "path_tracing",
        [](SceneMaker& m) {
            m.add(m.mesh(smooth_mesh(2)), m.material(clear_glass(1.5)),
                  Affine::translate({0.1, 0, 0.7}) * Affine::scale({0.4, 0.4, 0.4}));
            m.add(ball({0.1, -0.1, 1.6}, 0.3), m.material(shining({6, 6, 6})));
        },
        24);
    expect_chains(
        "glossy floor", 4, "path_tracing",
        [](SceneMaker& m) {
            Material glossy = matt({0.3, 0.3, 0.3});
            glossy.specular.color = {0.4, 0.4, 0.4};
            glossy.shininess.value = 80;
            m.add(rectangle({-0.8, -0.8, 0.02}, {1.6, 0, 0}, {0, 1.6, 0}), m.material(glossy));
            m.add(rectangle({0.5, -0.7, 0.1}, {0, 0, 1.5}, {0, 1.4, 0}), m.material(mirror()));
            m.add(ball({-0.2, 0, 1.4}, 0.25), m.material(shining({6, 7, 8})));
        },
        16);
}

TEST(Manifold, PicturesDependOnNoThreadsAndNoTiles) {
    SceneMaker maker;
    testing::add_walls(maker, {0.7, 0.7, 0.7});
    maker.add(ball({0.2, 0, 0.7}, 0.4), maker.material(clear_glass(1.5)));
    maker.add(ball({0, 0, 0}, 1), maker.material(mirror()),
              Affine::translate({-0.5, 0, 0.4}) * Affine::scale({0.3, 0.2, 0.3}));
    maker.light(lamp_at({0.3, -0.3, 1.8}, 2));
    const Scene scene = maker.compile("wide_bvh");
    const Film one = picture_of(scene, "path_tracing:manifold=on", 24, 2, 3, 1, 32);
    const Film three = picture_of(scene, "path_tracing:manifold=on", 24, 2, 3, 3, 7);
    for (int i = 0; i < 24 * 24; ++i) ASSERT_EQ(one.at(i % 24, i / 24), three.at(i % 24, i / 24));
}

TEST(Manifold, ScenesWithoutMirrorsAreRenderedToTheSameBits) {
    SceneMaker maker;
    testing::add_walls(maker, {0.7, 0.7, 0.7});
    maker.light(lamp_at({0.3, -0.3, 1.8}, 2));
    const Scene scene = maker.compile();
    const Film off = picture_of(scene, "path_tracing", 8, 4);
    const Film on = picture_of(scene, "path_tracing:manifold=on", 8, 4);
    for (int i = 0; i < 64; ++i) ASSERT_EQ(off.at(i % 8, i / 8), on.at(i % 8, i / 8));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
