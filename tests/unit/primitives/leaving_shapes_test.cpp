// Rays that leave a shape do not hit it again where it is in or nearly in a plane of coordinates,
// along whose axis its points have no rounding.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "alhazen/primitives/surface.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

Vec3 unit_direction_of(RandomStream& random) {
    while (true) {
        const Vec3 d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double l = length_squared(d);
        if (l > 0.01 && l <= 1.0) return d / std::sqrt(l);
    }
}

/// Any direction, or one nearly along the surface.
Vec3 leaving_direction_of(RandomStream& random, const Vec3& normal) {
    Vec3 d = unit_direction_of(random);
    if (random.uniform(0, 1) < 0.5) {
        d = d - dot(d, normal) * normal + std::pow(10.0, random.uniform(-9, 0)) * normal;
    }
    return normalize(random.uniform(0, 1) < 0.5 ? d : -d);
}

struct Leaving {
    int hits = 0, again = 0;
};

/// A point of the plane, from p, and its normal; x, y along the plane.
struct FlatFrame {
    Vec3 x, y, z;
    double height = 0;
    [[nodiscard]] Vec3 point(double a, double b, double up = 0) const {
        return a * x + b * y + (height + up) * z;
    }
};
FlatFrame frame_of(int axis, double height) {
    FlatFrame frame;
    frame.x[(axis + 1) % 3] = frame.y[(axis + 2) % 3] = frame.z[axis] = 1;
    frame.height = height;
    return frame;
}

/// Rays towards points of the plane, and rays that leave what they hit: `again` counts those that
/// hit within `near`. `world`: the placement of the plane.
Leaving leave_plane(const Scene& scene, const FlatFrame& plane, const Affine& world,
                    const Vec2& size, double near, std::uint64_t seed) {
    RandomStream random(seed);
    Leaving count;
    for (int i = 0; i < 10; ++i) {
        const Vec3 target =
            plane.point(size.x * random.uniform(-1, 1), size.y * random.uniform(-1, 1));
        const double far = std::pow(10.0, random.uniform(-1, 6)) * size.x;
        const Vec3 end = world.point(target);
        Vec3 origin = end + far * unit_direction_of(random);
        const Ray ray{origin, normalize(end - origin)};
        Hit hit;
        if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
        const Surface surface = surface_at(*scene.aggregate, ray, hit);
        for (int k = 0; k < 10; ++k) {
            const Vec3 away = leaving_direction_of(random, surface.normal);
            ++count.hits;
            count.again += scene.aggregate->occluded(leaving_ray(surface, away, near), nullptr);
        }
    }
    return count;
}

/// Control points of a patch over the plane, u-major.
std::vector<Vec3> net_of(const FlatFrame& plane, int n, int m, const Vec2& size, double wave,
                         RandomStream& random) {
    std::vector<Vec3> points;
    for (int i = 0; i <= n; ++i) {
        for (int k = 0; k <= m; ++k) {
            const double a = (2.0 * i / n - 1.0) + random.uniform(-0.05, 0.05);
            const double b = (2.0 * k / m - 1.0) + random.uniform(-0.05, 0.05);
            points.push_back(plane.point(size.x * a, size.y * b, wave * random.uniform(-1, 1)));
        }
    }
    return points;
}

/// Shapes of all kinds of patches over the plane.
std::vector<AnyShape> patches_over(const FlatFrame& plane, const Vec2& size, double wave,
                                   RandomStream& random) {
    std::vector<AnyShape> shapes;
    for (const auto& [n, m] : {std::pair{1, 1}, {2, 2}, {3, 3}, {4, 3}, {7, 7}}) {
        BezierPatch patch;
        patch.degree_u = std::uint32_t(n), patch.degree_v = std::uint32_t(m);
        patch.points = net_of(plane, n, m, size, wave, random);
        shapes.push_back(patch);
        for (std::size_t i = 0; i < patch.points.size(); ++i) {
            patch.weights.push_back(random.uniform(0.5, 2));
        }
        shapes.push_back(patch);
        PatchMesh mesh;
        mesh.degree_u = patch.degree_u, mesh.degree_v = patch.degree_v;
        mesh.points = patch.points;
        for (std::uint32_t i = 0; i < mesh.points.size(); ++i) mesh.patches.push_back(i);
        shapes.push_back(mesh);
    }
    NurbsSurface nurbs;
    nurbs.degree_u = 2, nurbs.degree_v = 3;
    nurbs.knots_u = {0, 0, 0, 0.4, 1, 1, 1}, nurbs.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    nurbs.points = net_of(plane, 3, 3, size, wave, random);
    shapes.push_back(nurbs);
    const std::vector<Vec3> p = net_of(plane, 1, 1, size, wave, random);
    shapes.push_back(BilinearPatch{.p00 = p[0], .p10 = p[2], .p01 = p[1], .p11 = p[3]});
    const std::vector<Vec3> q = net_of(plane, 2, 2, size, wave, random);
    SteinerPatch steiner;
    steiner.points = {q[0], q[3], q[6], q[1], q[4], q[2]};
    shapes.push_back(steiner);
    return shapes;
}

enum class Pose { World, Placed, Turned, Instance, Moving };

Scene scene_of(const AnyShape& shape, Pose pose, const Affine& placement) {
    SceneMaker maker;
    maker.material({});
    const bool inner = pose == Pose::Instance;
    const ObjectIndex owner = inner ? maker.object("inner") : ObjectIndex{0};
    const Affine own = pose == Pose::World || inner ? Affine{} : placement;
    std::visit([&](const auto& s) { maker.add(s, MaterialId{0}, own, owner); }, shape);
    if (inner) maker.add(owner, MaterialId{0}, placement);
    if (pose == Pose::Moving) {
        Part& part = maker.description().objects[0].parts[0];
        part.object_from_part = {};
        part.motion = std::make_shared<const PartMotion>(
            PartMotion{{}, {{0, placement}, {1, Affine::translate({1, 0, 0}) * placement}}, {}});
    }
    return maker.compile();
}

Affine placement_of(Pose pose) {
    if (pose == Pose::World) return {};
    if (pose == Pose::Placed) return Affine::scale({2, 3, 1e-3});
    if (pose == Pose::Turned) return Affine::rotate({1, 2, 3}, 0.7) * Affine::scale({1, 0.01, 4});
    return Affine::translate({0.3, -40, 0}) * Affine::rotate({0, 0, 1}, 0.4);
}

TEST(LeavingShapes, MissThePatchInAPlaneOfCoordinatesThatTheyLeave) {
    RandomStream random(3);
    for (const Pose pose :
         {Pose::World, Pose::Placed, Pose::Turned, Pose::Instance, Pose::Moving}) {
        for (const double height : {0.0, 1e-18, 1e-9, 1e-4, 0.3}) {
            const int axis = static_cast<int>(3 * random.uniform(0, 1));
            for (const Vec2& size : {Vec2{2, 2}, {1e-3, 50}, {400, 300}}) {
                const FlatFrame plane = frame_of(axis, height);
                for (const AnyShape& shape : patches_over(plane, size, 0.0, random)) {
                    const Affine world = placement_of(pose);
                    const Leaving count = leave_plane(scene_of(shape, pose, world), plane, world,
                                                      size, kInfinity, random.bits());
                    EXPECT_GT(count.hits, 5) << shape.index();
                    EXPECT_EQ(count.again, 0)
                        << "of " << count.hits << ", shape " << shape.index() << ", axis " << axis
                        << ", height " << height << ", size " << size.y << ", pose " << int(pose);
                }
            }
        }
    }
}

TEST(LeavingShapes, MissTheGentleWavesOfAPatchThatTheyLeave) {
    RandomStream random(4);
    for (const double wave : {1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 3e-4, 1e-3}) {
        const FlatFrame plane = frame_of(2, 0);
        for (const AnyShape& shape : patches_over(plane, {2, 2}, wave, random)) {
            // Waves hide one another only far away.
            const Leaving count = leave_plane(scene_of(shape, Pose::World, {}), plane, {}, {2, 2},
                                              1e-9, random.bits());
            EXPECT_GT(count.hits, 10) << shape.index();
            EXPECT_EQ(count.again, 0)
                << "of " << count.hits << ", shape " << shape.index() << ", wave " << wave;
        }
    }
}

TEST(LeavingShapes, MissTheUnboundedQuadricThatTheyLeaveFarFromItsCentre) {
    for (int axis = 0; axis < 3; ++axis) {
        const FlatFrame plane = frame_of(axis, 0);
        for (const double bend : {0.0, 1e-9, 1e-7, 1e-5}) {
            for (const double size : {3.0, 40.0, 1000.0}) {
                if (bend * size * size > 0.2) continue;
                Quadric slab;
                slab.squares = bend * (plane.x + plane.y) + plane.z;
                slab.linear = plane.z;
                slab.constant = 0;
                SceneMaker maker;
                maker.add(slab);
                const Leaving count = leave_plane(maker.compile(), plane, {}, {size, size}, 1e-6,
                                                  static_cast<std::uint64_t>(axis) + 8);
                EXPECT_GT(count.hits, 10);
                EXPECT_EQ(count.again, 0) << "of " << count.hits << ", axis " << axis << ", bend "
                                          << bend << ", size " << size;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
