// Parts visible only to some kinds of rays.

#include <gtest/gtest.h>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/random.h"
#include "support/scene_maker.h"
#include "support/show_last_to.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::glowing;
using testing::Random;
using testing::SceneMaker;
using testing::show_last_to;

constexpr RayMask kEye = mask_of(RayKind::Eye), kShadow = mask_of(RayKind::Shadow),
                  kReflection = mask_of(RayKind::Reflection),
                  kRefraction = mask_of(RayKind::Refraction);

Material white() {
    Material m;
    m.diffuse.color = {1, 1, 1};
    return m;
}

/// A wall behind a ball, both between the camera and a light that stands behind it.
Scene ball_before_wall(RayMask visible_to) {
    SceneMaker maker;
    const MaterialId wall = maker.material(white());
    const MaterialId ball = maker.material(glowing({0, 0, 1}));
    maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}}, wall);
    maker.add(Sphere{.center = {0, 0, 2}, .radius = 0.5}, ball);
    show_last_to(maker, visible_to);
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {0.5, 0.5, 0.5}});
    return maker.compile("wide_bvh");
}

TEST(RayMasks, WhatTheEyeDoesNotSeeCastsItsShadowAllTheSame) {
    const Rgb lit{0.5, 0.5, 0.5}, dark{0, 0, 0}, ball{0, 0, 1};
    EXPECT_EQ(center(ball_before_wall(kAllRays)), ball);
    EXPECT_EQ(center(ball_before_wall(kShadow)), dark);
    EXPECT_EQ(center(ball_before_wall(kAllRays & ~kEye & kRaysOfAllKinds)), dark);
    EXPECT_EQ(center(ball_before_wall(kReflection)), lit);
    EXPECT_EQ(center(ball_before_wall(kEye)), ball);
    EXPECT_EQ(center(ball_before_wall(0)), lit);
    EXPECT_EQ(center(ball_before_wall(kShadow), RayCasting{}), lit) << "it casts no shadows";
    EXPECT_EQ(center(ball_before_wall(kEye), RayCasting{}), ball);
}

TEST(RayMasks, GlassThatShadowRaysDoNotSeeDoesNotTintTheLight) {
    for (const bool seen : {false, true}) {
        SceneMaker maker;
        Material glass;
        glass.transmissive.color = {0.5, 0.25, 1};
        const MaterialId pane = maker.material(glass);
        maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  maker.material(white()));
        maker.add(Rectangle{.corner = {-9, -9, 8}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  pane);
        show_last_to(maker, seen ? kShadow : kEye);
        maker.light(DirectionalLight{.to_light = {0, 0, 1}});
        const Rgb color = center(maker.compile("wide_bvh"));
        EXPECT_EQ(color, (seen ? Rgb{0.5, 0.25, 1} : Rgb{1, 1, 1}));
    }
}

/// A mirror that shows what lies to the right; a ball stands there, another before the mirror.
Scene mirror(RayMask right, RayMask before) {
    SceneMaker maker;
    Material m;
    m.reflective.color = {0.5, 0.5, 0.5};
    maker.add(Rectangle{.corner = {-2, -2, 2}, .edge_u = {4, 0, -4}, .edge_v = {0, 4, 0}},
              maker.material(m));
    const MaterialId red = maker.material(glowing({1, 0, 0}));
    maker.add(Sphere{.center = {4, 0, 0}}, red);
    show_last_to(maker, right);
    maker.add(Sphere{.center = {0, 0, 3}, .radius = 0.5}, maker.material(glowing({0, 1, 0})));
    show_last_to(maker, before);
    return maker.compile("wide_bvh");
}

TEST(RayMasks, WhatOnlyReflectionsSeeIsSeenInTheMirrorOnly) {
    EXPECT_EQ(center(mirror(kAllRays, kAllRays)), (Rgb{0, 1, 0}));
    EXPECT_EQ(center(mirror(kAllRays, kReflection)), (Rgb{0.5, 0, 0}));
    EXPECT_EQ(center(mirror(kReflection, kReflection)), (Rgb{0.5, 0, 0}));
    EXPECT_EQ(center(mirror(kEye | kShadow | kRefraction, kReflection)), (Rgb{0, 0, 0}));
}

TEST(RayMasks, WhatRefractionsDoNotSeeIsNotThereBehindGlass) {
    for (const RayMask mask : {kRefraction, kEye, kReflection}) {
        SceneMaker maker;
        Material glass;
        glass.transmissive.color = {0.5, 0.5, 0.5};
        maker.add(Rectangle{.corner = {-9, -9, 1}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
                  maker.material(glass));
        maker.add(Sphere{.center = {0, 0, -2}}, maker.material(glowing({0, 0, 1})));
        show_last_to(maker, mask);
        EXPECT_EQ(center(maker.compile("wide_bvh")),
                  (mask == kRefraction ? Rgb{0, 0, 0.5} : Rgb{0, 0, 0}));
    }
}

/// The ball of `ball_before_wall` in objects around it; used once they become part of the scene,
/// used twice they are instances.
Rgb center_of_nested(RayMask ball, RayMask inner, RayMask outer, bool used_twice) {
    SceneMaker maker;
    const MaterialId blue = maker.material(glowing({0, 0, 1}));
    const ObjectIndex a = maker.object("inner"), b = maker.object("outer");
    maker.add(Sphere{.center = {0, 0, 2}, .radius = 0.5}, blue, {}, a);
    show_last_to(maker, ball, a);
    maker.add(a, blue, {}, b);
    show_last_to(maker, inner, b);
    maker.add(b);
    show_last_to(maker, outer);
    if (used_twice) {
        maker.add(a, blue, Affine::translate({40, 0, 0}), b);
        maker.add(b, blue, Affine::translate({0, 40, 0}));
    }
    return center(maker.compile("wide_bvh"));
}

TEST(RayMasks, EveryObjectAroundAPartMustBeSeenToo) {
    for (const bool twice : {false, true}) {
        EXPECT_EQ(center_of_nested(kAllRays, kAllRays, kAllRays, twice), (Rgb{0, 0, 1}));
        EXPECT_EQ(center_of_nested(kEye, kEye | kShadow, kAllRays, twice), (Rgb{0, 0, 1}));
        EXPECT_EQ(center_of_nested(kShadow, kAllRays, kAllRays, twice), (Rgb{0, 0, 0}));
        EXPECT_EQ(center_of_nested(kAllRays, kShadow, kAllRays, twice), (Rgb{0, 0, 0}));
        EXPECT_EQ(center_of_nested(kAllRays, kAllRays, kShadow, twice), (Rgb{0, 0, 0}));
        EXPECT_EQ(center_of_nested(kEye, kEye, kReflection, twice), (Rgb{0, 0, 0}));
    }
}

TEST(RayMasks, EachPlaceOfAMeshHasItsOwn) {
    SceneMaker maker;
    const MaterialId blue = maker.material(glowing({0, 0, 1}));
    TriangleMesh fine = testing::tetrahedron();
    // More triangles than are copied: both places share one.
    for (int i = 0; i < 80; ++i) fine.triangles.push_back({0, 1, 2});
    const MeshIndex mesh = maker.mesh(std::move(fine));
    maker.add(mesh, blue);
    show_last_to(maker, kShadow);
    maker.add(mesh, blue, Affine::translate({40, 0, 0}));
    EXPECT_EQ(center(maker.compile("wide_bvh")), (Rgb{0, 0, 0}));
    maker.description().objects[0].parts[0].visible_to = kEye;
    EXPECT_EQ(center(maker.compile("wide_bvh")), (Rgb{0, 0, 1}));
}

/// Mirrors, glass, meshes and spheres in a room with two lights; `mask(i)` of part i.
template <class MaskOf>
Scene room(const std::string& accelerator, MaskOf&& mask) {
    SceneMaker maker;
    Random random(5);
    std::vector<MaterialId> some;
    for (int i = 0; i < 4; ++i) {
        Material m = white();
        m.diffuse.color = {0.2 + 0.2 * i, 0.5, 0.8 - 0.2 * i};
        if (i % 2 == 0) m.reflective.color = {0.4, 0.5, 0.6};
        if (i >= 2) m.transmissive.color = {0.7, 0.6, 0.8};
        m.index.value = 1.2;
        some.push_back(maker.material(m));
    }
    const MeshIndex mesh = maker.mesh(testing::tetrahedron());
    for (int i = 0; i < 40; ++i) {
        const Vec3 center{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 1)};
        const MaterialId material = some[static_cast<std::size_t>(i) % some.size()];
        if (i % 3 == 0) {
            maker.add(mesh, material, Affine::translate(center) * Affine::scale({0.4, 0.4, 0.4}));
        } else {
            maker.add(Sphere{.center = center, .radius = random.uniform(0.2, 0.6)}, material);
        }
        show_last_to(maker, mask(i));
    }
    maker.add(Rectangle{.corner = {-9, -9, -6}, .edge_u = {18, 0, 0}, .edge_v = {0, 18, 0}},
              some[1]);
    maker.light(PointLight{.position = {3, 4, 5}});
    maker.light(DirectionalLight{.to_light = {-1, 2, 1}, .color = {0.5, 0.4, 0.3}});
    maker.description().picture.background = Rgb{0.2, 0.3, 0.4};
    return maker.compile(accelerator);
}

constexpr int kMaskSide = 24;

Film picture_of(const Scene& scene, const TiledRenderer& renderer) {
    Film film(kMaskSide, kMaskSide, {0, 0, kMaskSide, kMaskSide});
    RayCounters counters;
    renderer.render_tile({scene, scene.cameras[0].camera, 1, 0, false},
                         {0, 0, kMaskSide, kMaskSide}, film, counters);
    return film;
}

int pixels_that_differ(const Film& a, const Film& b) {
    int count = 0;
    for (int i = 0; i < kMaskSide * kMaskSide; ++i) {
        count += !(a.at(i % kMaskSide, i / kMaskSide) == b.at(i % kMaskSide, i / kMaskSide));
    }
    return count;
}

TEST(RayMasks, ThePictureDoesNotDependOnTheAcceleratorOrOnWhatIsTracedTogether) {
    const auto mask = [](int i) { return static_cast<RayMask>(i * 7 % 16); };
    const Scene scene = room("wide_bvh", mask);
    ASSERT_TRUE(scene.has_masks);
    const Film picture = picture_of(scene, Whitted(1));
    for (const std::size_t rays : {3, 64, 5000}) {
        EXPECT_EQ(pixels_that_differ(picture, picture_of(scene, Whitted(rays))), 0) << rays;
    }
    EXPECT_EQ(pixels_that_differ(picture, picture_of(room("list", mask), Whitted(64))), 0);
    const Film all = picture_of(room("wide_bvh", [](int) { return kAllRays; }), Whitted(64));
    EXPECT_GT(pixels_that_differ(picture, all), kMaskSide * kMaskSide / 4);
}

TEST(RayMasks, WhatAllKindsOfRaysSeeNeedsNoMask) {
    const Scene listed = room("wide_bvh", [](int) { return kRaysOfAllKinds; });
    const Scene plain = room("wide_bvh", [](int) { return kAllRays; });
    EXPECT_FALSE(listed.has_masks);
    EXPECT_TRUE(listed.aggregate->primitives().all_seen(kEye));
    EXPECT_EQ(pixels_that_differ(picture_of(listed, Whitted{}), picture_of(plain, Whitted{})), 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
