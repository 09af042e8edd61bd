// Packets of coherent rays test shapes and small solids eight rays at a time, with the hits of the
// list.

#include <gtest/gtest.h>

#include "alhazen/sampling/random.h"
#include "support/scene_maker.h"
#include "unit/aggregates/coherent_rays.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// Many small CSG solids, some placed by transforms, and other shapes.
PrimitiveTable small_solids(std::uint64_t seed, bool with_boxes) {
    RandomStream random(seed);
    SceneMaker maker;
    maker.material({});
    const auto point = [&] {
        return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    };
    const Combine kinds[] = {Combine::Difference, Combine::Union, Combine::Intersection};
    for (int i = 0; i < 60; ++i) {
        const ObjectIndex object = maker.object("solid");
        maker.description().objects[static_cast<std::size_t>(object)].combine = kinds[i % 3];
        const bool placed = i % 4 == 0;
        const Vec3 at = placed ? Vec3{} : point();
        const double size = random.uniform(0.05, 0.2);
        maker.add(Sphere{at, size}, MaterialId{0}, {}, object);
        maker.add(Cylinder{.base = at - size * Vec3{0.2, 0.1, 1.2},
                           .top = at + size * Vec3{0.2, 0.1, 1.2},
                           .radius = 0.4 * size},
                  MaterialId{0}, {}, object);
        if (i % 5 == 0)
            maker.add(BoxShape{at, at + size * Vec3{1, 1, 1}}, MaterialId{0}, {}, object);
        const Affine placement = Affine::translate(point()) *
                                 Affine::rotate({0.3, 1, 0.2}, random.uniform(0, 6)) *
                                 Affine::scale({1.0, 0.7, 1.4});
        maker.add(object, MaterialId{0}, placed ? placement : Affine{});
    }
    for (int i = 0; i < 10; ++i) {
        maker.add(Sphere{point(), 0.1});
        maker.add(Torus{.center = point(), .major_radius = 0.1, .minor_radius = 0.03});
        if (!with_boxes) continue;  // tested one by one, so that packets do not pay
        maker.add(BoxShape{{0, 0, 0}, {0.1, 0.1, 0.1}}, MaterialId{0}, Affine::translate(point()));
    }
    return maker.compile().aggregate->primitives();
}

TEST(CoherentShapes, SmallSolidsAreHitAsByTheList) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const PrimitiveTable table = small_solids(seed, seed % 2 == 0);
        const std::string name = "small solids " + std::to_string(seed);
        // The count is no multiple of packets or of groups of eight.
        compare(name, table, eye_rays({0.1, 0.2, 4}, {0, 0, -1}, 0.6, 45));
        compare(name + " from inside", table, eye_rays({0.1, 0.2, 0.3}, {-1, 0.2, 0.3}, 0.4, 24));
        compare(name + " in shadow", table,
                shadow_rays({-1.2, -1.1, -1.3}, 0.3, {1.5, 1.3, 1.4}, 24));
        compare(name + " along an axis", table, eye_rays({0, 0, 4}, {0, 0, -1}, 0.0, 16), false);
    }
}

TEST(CoherentShapes, RaysThatTouchBallsHitWhatTheListHits) {
    // Packets around one solid each, whose groups of eight rays get as narrow as possible near the
    // silhouette of the bounding sphere.
    const PrimitiveTable table = small_solids(5, false);
    RandomStream random(6);
    for (const double off : {1e-2, 1e-5, 1e-7, 1e-9, 1e-14}) {
        Rays rays;
        for (std::size_t i = table.first(kInstanceKind); i < table.size(); ++i) {
            const BoundingSphere ball = table.sphere(i);
            const Vec3 eye = ball.center + Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 3};
            const Vec3 to = ball.center - eye;
            const Vec3 ahead = normalize(to), across = perpendicular(ahead);
            const double sine = ball.radius / length(to);
            for (int group = 0; group < 8; ++group) {
                const double turn = random.uniform(0, 7);
                const Vec3 limb = std::cos(turn) * across + std::sin(turn) * cross(ahead, across);
                for (int k = 0; k < 8; ++k) {
                    const double reach =
                        sine / std::sqrt(1 - sine * sine) * (1 + random.uniform(-off, off));
                    rays.push_back(
                        {eye, ahead + reach * limb, 0, std::numeric_limits<double>::infinity()});
                }
            }
        }
        compare("limbs, off by " + std::to_string(off), table, rays);
    }
}

TEST(CoherentShapes, RaysOfSeveralWaysInOnePacketHitWhatTheListHits) {
    // Solids longest along x, along y and along z next to each other.
    for (std::uint64_t seed = 7; seed < 10; ++seed) {
        const PrimitiveTable table = small_solids(seed, seed % 2 == 0);
        const std::string name = "ways " + std::to_string(seed);
        compare(name, table, eye_rays({-2, -2, -2}, {1, 1, 1}, 0.7, 40));
        compare(name + " of two", table, eye_rays({-2, -2, 0}, {1, 1, 0.1}, 0.5, 40));
        // Few rays of one direction, far from the first of their packet.
        compare(name + " of a corner", table, eye_rays({2, 2, 2}, {-1, -1.02, -1.05}, 0.1, 40));
    }
}

TEST(CoherentShapes, RaysInThePlanesOfCoordinatesAreThoseOfTheList) {
    // Zeros of either sign at a solid without a transform.
    SceneMaker maker;
    maker.material({});
    const ObjectIndex object = maker.object("ball with a hole");
    maker.description().objects[static_cast<std::size_t>(object)].combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, object);
    maker.add(Cylinder{.base = {0, -2, 0}, .top = {0, 2, 0}, .radius = 0.1}, MaterialId{0}, {},
              object);
    maker.add(object);
    RandomStream random(3);
    const auto zero = [&] { return random.uniform(0, 1) < 0.5 ? 0.0 : -0.0; };
    Rays rays;
    for (int i = 0; i < 512; ++i) {
        rays.push_back({{-random.uniform(0.4, 0.5), -random.uniform(0.4, 0.5), zero()},
                        {zero(), zero(), 1},
                        i % 2 == 0 ? 0.0 : 0.1,
                        std::numeric_limits<double>::infinity()});
    }
    compare("rays in a plane", maker.compile().aggregate->primitives(), rays);
}

/// Stacked bodies as thin as paper, slightly tilted: their slabs are nearly, but not quite,
/// perpendicular.
PrimitiveTable sheets(double lean) {
    SceneMaker maker;
    maker.material({});
    for (int i = 0; i < 12; ++i) {
        Affine flat = Affine::scale({0.95, 1e-7, 0.95});
        Affine shear;
        shear.linear.x_axis.y = i % 2 == 0 ? -lean : 0.0;
        maker.add(Sphere{}, MaterialId{0},
                  Affine::translate({0, 5e-6 * (i % 2 + i / 4), 0}) * shear * flat);
    }
    return maker.compile().aggregate->primitives();
}

TEST(CoherentShapes, FlatBodiesThatLeanAreHitAsByTheList) {
    for (const double lean : {0.0, 1e-7, 1.8e-6, 1.5e-5, 1e-3, 0.3}) {
        const PrimitiveTable table = sheets(lean);
        const std::string name = "lean of " + std::to_string(lean);
        compare(name + " from above", table, eye_rays({-0.85, 1.5, 0}, {0, -1, 0}, 0.1, 24));
        Rays along;
        for (int i = 0; i < 256; ++i) {
            along.push_back({{-0.9, 0.9 * lean + 1e-8 * (i - 128), 1.2}, {1e-9 * i, 0, -1}, 0, 5});
        }
        compare(name + " along", table, along, false);
    }
}

TEST(CoherentShapes, GroupsWithoutAUsableRayMeetNothing) {
    // Sheared, so that packets have only bounding boxes of balls.
    SceneMaker maker;
    maker.material({});
    RandomStream random(4);
    Affine shear;
    shear.linear.x_axis.y = 0.4;
    Blob blob;
    blob.threshold = 0.5;
    blob.components = {{.base = {0, 0, 0}, .radius = 0.5}, {.base = {0.3, 0, 0}, .radius = 0.4}};
    Algebraic quartic;
    quartic.expression = "x^4 + y^4 + z^4 - 0.02";
    quartic.clip_box = {{-1, -1, -1}, {1, 1, 1}};
    for (int i = 0; i < 8; ++i) {
        const auto placement = [&] {
            return Affine::translate({random.uniform(-1, 1), random.uniform(-1, 1), 0}) * shear;
        };
        maker.add(Torus{.major_radius = 0.4, .minor_radius = 0.1}, MaterialId{0}, placement());
        maker.add(blob, MaterialId{0}, placement());
        maker.add(quartic, MaterialId{0}, placement());
    }
    Rays rays = eye_rays({0.1, 0.2, 12}, {0, 0, -1}, 0.5, 16);
    for (std::size_t i = 8; i < 16; ++i) rays[i].direction.x = std::nan("");
    for (std::size_t i = 64; i < 104; ++i) rays[i].t_max = -1;
    compare("refused rays", maker.compile().aggregate->primitives(), rays);
}

/// Spheres and, if `mixed`, cylinders, cones and discs above a large ground.
PrimitiveTable bodies_on_a_ground(std::uint64_t seed, bool mixed) {
    RandomStream random(seed);
    SceneMaker maker;
    maker.material({});
    const auto point = [&] {
        return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    };
    maker.add(Polygon{.vertices = {{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}}});
    for (int i = 0; i < 900; ++i) {
        const Vec3 at = point(), top = at + 0.1 * point();
        const double radius = random.uniform(0.001, 0.05);
        const int kind = mixed ? i % 6 : 0;
        const bool capped = i % 4 == 1;
        if (kind == 0) maker.add(Sphere{at, radius});
        if (kind == 1 || kind == 2) {
            maker.add(Cylinder{.base = at, .top = top, .radius = radius, .capped = capped});
        }
        if (kind == 3 || kind == 4) {
            maker.add(Cone{.base = at,
                           .top = top,
                           .base_radius = kind == 3 ? radius : 0.0,
                           .top_radius = kind == 3 ? (i % 5) * 0.02 : radius,
                           .capped = capped});
        }
        if (kind == 5) maker.add(Disc{.center = at, .normal = point(), .radius = radius});
    }
    return maker.compile().aggregate->primitives();
}

TEST(CoherentShapes, BodiesOnAGroundAreHitAsByTheList) {
    for (std::uint64_t seed = 11; seed < 14; ++seed) {
        const PrimitiveTable table = bodies_on_a_ground(seed, seed != 13);
        const std::string name = "bodies on a ground " + std::to_string(seed);
        compare(name, table, eye_rays({0.1, 0.2, 4}, {0, 0, -1}, 0.4, 45));
        compare(name + " from inside", table, eye_rays({0.1, 0.2, 0.3}, {-1, 0.2, 0.3}, 0.4, 24));
        compare(name + " from afar", table, eye_rays({300, 200, 400}, {-3, -2, -4}, 0.002, 24));
        compare(name + " in shadow", table,
                shadow_rays({-1.2, -1.1, -1.3}, 0.3, {1.5, 1.3, 1.4}, 24));
        compare(name + " along an axis", table, eye_rays({0, 0, 4}, {0, 0, -1}, 0.0, 16), false);
    }
}

TEST(CoherentShapes, AGroundDoesNotKeepRaysFromPackets) {
    const Rays rays = eye_rays({0.1, 0.2, 4}, {0, 0, -1}, 0.2, 32);
    for (const std::string& target : simd_targets()) {
        if (target.find("AVX") == std::string::npos) continue;  // others have no lane packets here
        const SimdTargetOverride use(target);
        const auto tree = make_aggregate("wide_bvh", bodies_on_a_ground(14, true));
        std::vector<Hit> hits(rays.size());
        TraversalStats any, coherent;
        tree->closest_batch(rays, hits, &any);
        tree->closest_batch(rays, hits, &coherent, Coherence::Coherent);
        EXPECT_GT(coherent.node_visits, 0u) << target;
        EXPECT_LT(3 * coherent.node_visits, any.node_visits) << target;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
