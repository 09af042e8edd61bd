// The objects of the guarantee of adaptive supersampling, and the rays that search for them.

#include <gtest/gtest.h>

#include <numeric>

#include "alhazen/renderers/antialias/hit_store.h"
#include "alhazen/renderers/antialias/scene_objects.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "unit/renderers/antialias/antialiased_picture.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::AntialiasedPicture;
using testing::bright;
using testing::kPixel;
using testing::kSide;
using testing::picture;
using testing::SceneMaker;

Polygon polygon(std::vector<Vec3> corners) {
    Polygon p;
    p.vertices = std::move(corners);
    return p;
}

/// The faces of a box, turned a little so that corners have no short coordinates.
std::vector<Polygon> faces(const Vec3& at, double half) {
    const Affine turn = Affine::rotate({1, 2, 3}, 0.7);
    const auto corner = [&](int i) {
        return at +
               turn.point(half * Vec3{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    };
    std::vector<Polygon> result;
    for (const auto& f : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                          std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
        result.push_back(polygon({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])}));
    }
    return result;
}

Polygon triangle_at(const Vec3& p) {
    return polygon({p, p + Vec3{1, 0, 0}, p + Vec3{0, 1, 0}});
}

TEST(SceneObjects, PolygonsThatShareSidesAreOneObject) {
    SceneMaker maker;
    const MaterialId light = bright(maker);
    maker.add(Sphere{{-1, 1, 0}, 0.2}, light);
    for (const Polygon& face : faces({0.1, -0.1, 0}, 0.5)) maker.add(face, light);
    const Scene scene = maker.compile("wide_bvh");
    const SceneObjects objects(*scene.aggregate);
    ASSERT_EQ(objects.objects().size(), 2U);
    const SceneObject& box = objects.objects()[1];
    EXPECT_NEAR(box.sphere.radius, 0.5 * std::sqrt(3.0), 1e-12);
    EXPECT_LT(length(box.sphere.center - Vec3{0.1, -0.1, 0}), 1e-12);
    // Its back faces are not searched.
    const AntialiasedPicture p = picture(scene, {});
    EXPECT_EQ(p.counts().objects, 2U);
    EXPECT_EQ(p.counts().met, 2U);
    EXPECT_EQ(p.counts().sought, 0U);
    EXPECT_EQ(p.counts().searching, 0U);
}

TEST(SceneObjects, PolygonsApartAndOfOtherMaterialsStayObjects) {
    SceneMaker maker;
    const MaterialId light = bright(maker), other = bright(maker);
    maker.add(triangle_at({0, 0, 0}), light);
    maker.add(triangle_at({0, 0, 1e-9}), light);
    EXPECT_EQ(SceneObjects(*maker.compile().aggregate).objects().size(), 2U);
    maker.add(triangle_at({1, 0, 0}), light);  // shares a corner with the first
    EXPECT_EQ(SceneObjects(*maker.compile().aggregate).objects().size(), 3U);
    maker.add(polygon({{1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), light);  // sides with both
    maker.add(triangle_at({0, 1, 0}), other);
    maker.add(triangle_at({0, 1, 0}), light);
    maker.description().objects[0].parts.back().visible_to = mask_of(RayKind::Shadow);
    EXPECT_EQ(SceneObjects(*maker.compile().aggregate).objects().size(), 4U);
}

TEST(SceneObjects, TouchingSolidsStayTwo) {
    SceneMaker maker;
    const MaterialId light = bright(maker);
    const std::vector<Polygon> box = faces({0, 0, 0}, 0.5);
    // A corner of one is the opposite corner of the other, to the last bit.
    const Vec3 step = box[1].vertices[2] - box[0].vertices[0];
    for (Polygon face : box) {
        maker.add(face, light);
        for (Vec3& v : face.vertices) v = v == box[0].vertices[0] ? box[1].vertices[2] : v + step;
        maker.add(face, light);
    }
    EXPECT_EQ(SceneObjects(*maker.compile().aggregate).objects().size(), 2U);
}

TEST(SceneObjects, JoinedPolygonsOfAnInstanceMoveWithIt) {
    SceneMaker maker;
    const MaterialId light = bright(maker);
    const ObjectIndex crate = maker.object("crate");
    for (const Polygon& face : faces({0, 0, 0}, 0.04 * kPixel)) maker.add(face, light, {}, crate);
    const Affine grown = Affine::scale({2, 1, 1});
    for (const double x : {-1.031, 0.017, 1.043}) {
        maker.add(crate, light, Affine::translate({x, 0.333, 0}) * grown);
    }
    const Scene scene = maker.compile("wide_bvh");
    const SceneObjects objects(*scene.aggregate);
    ASSERT_EQ(objects.objects().size(), 3U);
    for (const SceneObject& o : objects.objects()) {
        for (std::size_t k = 0; k < kDiagonals.size(); ++k) {
            EXPECT_TRUE(o.diagonals[k].contains(dot(kDiagonals[k], o.sphere.center)));
            EXPECT_LT(o.diagonals[k].width(), 4 * std::sqrt(3.0) * 0.04 * kPixel);
            EXPECT_GT(o.diagonals[k].width(), 2 * 0.04 * kPixel);
        }
    }
    const AntialiasedPicture p = picture(scene, {.depth = 6});
    EXPECT_EQ(p.counts().met, 3U);
    EXPECT_EQ(p.counts().below_depth, 0U);
}

TEST(ObjectSearch, ABallHalfBehindAnEdgeIsFound) {
    // 0.3 pixels wide, in the middle of a pixel; of it the half right of the wall's edge is seen.
    SceneMaker maker;
    Material black;
    const MaterialId dark = maker.material(black), light = bright(maker);
    const double edge = 0.46 * kPixel;
    maker.add(
        Rectangle{.corner = {-9, -9, 1}, .edge_u = {9 + 0.8 * edge, 0, 0}, .edge_v = {0, 18, 0}},
        dark);
    maker.add(Sphere{{edge, 0.52 * kPixel, 0}, 0.15 * kPixel}, light);
    const Scene scene = maker.compile("wide_bvh");
    const AntialiasedPicture p = picture(scene, {});
    EXPECT_EQ(p.counts().sought, 1U);
    EXPECT_EQ(p.counts().met, 2U);
    const double seen = 0.5 * 3.14159265 * 0.15 * 0.15;
    EXPECT_NEAR(p.film.at(kSide / 2, kSide / 2 - 1).r, seen, 0.2 * seen);
    EXPECT_EQ(picture(scene, {.guarantee = false}).film.at(kSide / 2, kSide / 2 - 1).r, 0.0);
}

TEST(ObjectSearch, ABallBehindAGapIsFoundByGuaranteeAll) {
    // Through a slit of 0.2 pixels in the middle of a pixel; all corners show the walls.
    SceneMaker maker;
    const MaterialId dark = maker.material(Material{}), light = bright(maker);
    const double left = 0.4 * kPixel, right = 0.6 * kPixel;
    maker.add(Rectangle{.corner = {-9, -9, 0}, .edge_u = {9 + left, 0, 0}, .edge_v = {0, 18, 0}},
              dark);
    maker.add(
        Rectangle{.corner = {right, -9, 0}, .edge_u = {9 - right, 0, 0}, .edge_v = {0, 18, 0}},
        dark);
    const double away = 3 * kPixel, grown = (5 + away) / 5;
    maker.add(Sphere{{0.5 * kPixel * grown, 0.5 * kPixel * grown, -away}, 0.2 * kPixel * grown},
              light);
    const Scene scene = maker.compile("wide_bvh");
    const AntialiasedPicture on = picture(scene, {.threshold = 0.001, .depth = 6});
    const AntialiasedPicture all =
        picture(scene, {.threshold = 0.001, .depth = 6, .behind_all = true});
    EXPECT_EQ(on.counts().met, 2U);
    EXPECT_EQ(on.counts().sought, 0U);
    EXPECT_EQ(on.counts().passed_over, 1U);
    EXPECT_EQ(all.counts().met, 3U);
    EXPECT_EQ(all.counts().sought, 1U);
    EXPECT_EQ(all.counts().passed_over, 0U);
    EXPECT_EQ(on.film.at(kSide / 2, kSide / 2 - 1).r, 0.0);
    // The part of a disc of radius 0.2 within 0.1 of its middle line.
    EXPECT_NEAR(all.film.at(kSide / 2, kSide / 2 - 1).r, 0.0765, 0.015);
}

/// A tube hidden behind the edge of a wall, so close that no bound proves it hidden.
Scene hidden_tube() {
    SceneMaker maker;
    Material matt;
    matt.diffuse.color = {0.5, 0.5, 0.5};
    matt.reflective.color = {0.2, 0.2, 0.2};
    const MaterialId grey = maker.material(matt);
    maker.light(DirectionalLight{.to_light = normalize(Vec3{1, 1, 3})});
    maker.add(Rectangle{.corner = {-9, -9, 1}, .edge_u = {9.03, 0, 0}, .edge_v = {0, 18, 0}}, grey);
    maker.add(Cylinder{.base = {-0.256, -1, -1}, .top = {-0.256, 1, -1}, .radius = 0.3}, grey);
    return maker.compile("wide_bvh");
}

TEST(ObjectSearch, WhatStaysHiddenCostsEyeRaysAlone) {
    const Scene scene = hidden_tube();
    AovFilm aovs(parse_aovs("count.rays,unmet"), {0, 0, kSide, kSide});
    const AntialiasedPicture p = picture(scene, {}, Whitted{}, 2, &aovs);
    EXPECT_EQ(p.counts().below_depth, 1U);
    EXPECT_GT(p.counts().searching, 100U);
    const RayCounters& with = p.report.counters;
    EXPECT_EQ(with[RayKind::Eye].cast, p.counts().eye_rays());
    const auto total = [&](const char* channel) {
        const LayerChannel* found = aovs.layers().find(channel);
        return std::accumulate(found->values.begin(), found->values.end(), 0.0) +
               std::accumulate(found->whole.begin(), found->whole.end(), 0.0);
    };
    EXPECT_EQ(total("count.rays"), double(with[RayKind::Eye].cast));
    EXPECT_EQ(total("unmet"), double(p.counts().below_depth_pixels));
    const AntialiasedPicture plain = picture(scene, {.guarantee = false});
    const RayCounters& without = plain.report.counters;
    EXPECT_EQ(plain.counts().total_points(), p.counts().total_points());
    for (const RayKind kind : {RayKind::Shadow, RayKind::Reflection}) {
        EXPECT_GT(without[kind].cast, 0U);
        EXPECT_EQ(with[kind].cast, without[kind].cast);
    }
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) EXPECT_EQ(p.film.at(x, y), plain.film.at(x, y));
    }
}

TEST(ObjectSearch, SlabsAreTightAroundWhatLiesAskew) {
    // A thin rod along a diagonal of space: rays through its box pass it by.
    SceneMaker maker;
    const MaterialId light = bright(maker);
    maker.add(Cylinder{.base = {-1, -1, -1}, .top = {1, 1, 1}, .radius = 0.01}, light);
    const Scene scene = maker.compile();
    const SceneObjects objects(*scene.aggregate);
    ASSERT_EQ(objects.objects().size(), 1U);
    const SceneObject& rod = objects.objects()[0];
    EXPECT_GT(rod.box.hi.x - rod.box.lo.x, 2.0);
    EXPECT_NEAR(rod.diagonals[0].width(), 2 * std::sqrt(3.0), 0.05);
    for (std::size_t k = 1; k < kDiagonals.size(); ++k) {
        EXPECT_NEAR(rod.diagonals[k].width(), 2.0 / std::sqrt(3.0), 0.05);
    }
}

/// Shading that starts from stored hits has the bits of rays that are traced.
template <class AnyRenderer>
void expect_equal_shades(const Scene& scene) {
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    const AnyRenderer renderer;
    const std::unique_ptr<RayAnswers> answers = renderer.answers(job);
    std::vector<Ray> rays;
    const Vec3 eye{0, 0, 5};
    for (int i = 0; i < 256; ++i) {
        const Vec3 to{0.25 * (i % 16) - 1.87, 0.25 * (i / 16) - 1.83, 0};
        rays.push_back({eye, normalize(to - eye)});
    }
    std::vector<Rgb> traced(256), shaded(256);
    std::vector<Hit> hits(256), found(256);
    RayCounters whole, parts;
    answers->trace(rays, traced, hits, whole);
    answers->find(rays, found, parts);
    EXPECT_EQ(parts.total_cast(), 256U);
    HitStore store;
    store.resize(256);
    for (std::size_t i = 0; i < 256; ++i) store.set(i, found[i]);
    for (std::size_t i = 0; i < 256; ++i) {
        EXPECT_EQ(found[i].t, hits[i].t);
        found[i] = store.get(i);
        EXPECT_EQ(found[i].primitive, hits[i].primitive);
        EXPECT_EQ(found[i].path, hits[i].path);
    }
    answers->shade(rays, found, shaded, parts);
    EXPECT_EQ(traced, shaded);
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        EXPECT_EQ(parts.rays[k].cast, whole.rays[k].cast) << k;
    }
    // The next batch starts without a remainder.
    answers->trace(std::span(rays).first(9), std::span(shaded).first(9), {}, parts);
    EXPECT_TRUE(std::equal(shaded.begin(), shaded.begin() + 9, traced.begin()));
}

TEST(ObjectSearch, ShadesFromStoredHitsHaveTheBitsOfTracedRays) {
    SceneMaker maker;
    Material glass;
    glass.diffuse.color = {0.3, 0.4, 0.5};
    glass.transmissive.color = {0.5, 0.5, 0.5};
    glass.reflective.color = {0.3, 0.3, 0.3};
    const MaterialId clear = maker.material(glass), light = bright(maker);
    maker.light(PointLight{.position = {3, 4, 5}});
    const ObjectIndex ball = maker.object("ball"), pair = maker.object("pair");
    maker.add(Sphere{{0, 0, 0}, 0.3}, clear, {}, ball);
    maker.add(ball, clear, Affine::translate({0.4, 0, 0}), pair);
    maker.add(ball, clear, Affine::translate({-0.4, 0, 0.1}), pair);
    maker.add(pair, clear, Affine::translate({0, 0.6, 0}));
    maker.add(pair, clear, Affine::translate({0, -0.6, 0}));
    maker.add(Rectangle{.corner = {-1, -1, -1}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}}, light);
    maker.add(Sphere{{0.2, 0.1, 1}, 0.3}, light);
    maker.description().objects[0].parts.back().visible_to =
        mask_of(RayKind::Shadow);  // rays of each kind go alone
    const Scene scene = maker.compile("wide_bvh");
    expect_equal_shades<Whitted>(scene);
    expect_equal_shades<RayCasting>(scene);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
