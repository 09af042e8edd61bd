#include "alhazen/tracer/tracer_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/tracer/tracer.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Message of the error that `action` throws.
template <class Action>
std::string refusal(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

bool holds(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

const std::vector<Vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<std::array<std::uint32_t, 3>> kTriangle{{0, 1, 2}};

TEST(TracerScene, RefusesMeshesThatAreNone) {
    TracerScene scene;
    scene.add_mesh(kCorners, kTriangle);
    const std::vector<std::array<std::uint32_t, 3>> beyond{{0, 1, 3}};
    const std::string index = refusal([&] { scene.add_mesh(kCorners, beyond); });
    EXPECT_TRUE(holds(index, "geometry 1") && holds(index, "3")) << index;
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e200}) {
        std::vector<Vec3> corners = kCorners;
        corners[2].y = bad;
        const std::string message = refusal([&] { scene.add_mesh(corners, kTriangle); });
        EXPECT_TRUE(holds(message, "position 2 must be three finite numbers")) << message;
    }
    const std::vector<float> seven(7), six(6);
    const std::vector<std::uint32_t> four(4), three(3);
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(seven, three); }), "7 coordinates"));
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(six, four); }), "4 indices"));
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(std::shared_ptr<TriangleMesh>{}); }), "null"));
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = kCorners;
    mesh->triangles = kTriangle;
    mesh->vertex_materials = {0, 1, 4000000000u};
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(mesh); }), "materials"));
    EXPECT_EQ(scene.geometry_count(), 1u) << "what is refused is not counted";
    EXPECT_EQ(scene.add_sphere({}, 1), GeometryId{1});
}

TEST(TracerScene, RefusesShapesAndTransformsThatAreNone) {
    TracerScene scene;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(holds(refusal([&] { scene.add_sphere({0, nan, 0}, 1); }), "center"));
    EXPECT_TRUE(holds(refusal([&] { scene.add_sphere({}, -1); }), "radius"));
    EXPECT_TRUE(holds(refusal([&] { scene.add(Plane{.normal = {0, 0, 0}}); }), "normal"));
    const GeometryOptions flat{.world_from_geometry = Affine::scale({1, 0, 1})};
    EXPECT_TRUE(holds(refusal([&] { scene.add_sphere({}, 1, flat); }), "singular"));
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(kCorners, kTriangle, flat); }), "singular"));
    EXPECT_TRUE(holds(refusal([&] { scene.add_instance(Tracer{{}}, flat); }), "singular"));
    const GeometryOptions far{.world_from_geometry = Affine::scale({1e80, 1, 1})};
    EXPECT_TRUE(holds(refusal([&] { scene.add_mesh(kCorners, kTriangle, far); }), "position 1"));
    EXPECT_EQ(scene.geometry_count(), 0u);
    EXPECT_TRUE(Tracer(std::move(scene)).box().empty());
}

TEST(TracerScene, InstancesNestAsDeepAsAHitCanTell) {
    TracerScene innermost;
    innermost.add_sphere({}, 1);
    Tracer tracer(std::move(innermost));
    for (std::size_t level = 0; level < kMaxInstanceDepth; ++level) {
        TracerScene around;
        around.add_instance(tracer, {.world_from_geometry = Affine::translate({1, 0, 0})});
        tracer = Tracer(std::move(around));
    }
    const Ray ray{{double(kMaxInstanceDepth), 0, 5}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(tracer.intersect(ray, hit));
    EXPECT_EQ(tracer.details(ray, hit).instances.size(), kMaxInstanceDepth);
    TracerScene beyond;
    EXPECT_TRUE(holds(refusal([&] { beyond.add_instance(tracer); }), "nested"));
}

TEST(TracerScene, ACopyIsAsIndependentAsItLooks) {
    TracerScene one;
    one.add_sphere({}, 1);
    TracerScene two = one;
    two.add_sphere({5, 0, 0}, 1);
    const Ray ray{{5, 0, 9}, {0, 0, -1}};
    EXPECT_FALSE(Tracer(std::move(one)).occluded(ray));
    EXPECT_TRUE(Tracer(std::move(two)).occluded(ray));
}

TEST(TracerScene, AMeshWithoutATransformIsShared) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = kCorners;
    mesh->triangles = kTriangle;
    TracerScene scene;
    scene.add_mesh(mesh);
    EXPECT_EQ(mesh.use_count(), 2);
    const Tracer tracer(std::move(scene));
    EXPECT_TRUE(tracer.occluded({{0.2, 0.2, 1}, {0, 0, -1}}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
