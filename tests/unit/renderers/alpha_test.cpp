// Partly transparent, single-sided, thin, absorbing and unlit surfaces.

#include <gtest/gtest.h>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_near;
using testing::glowing;
using testing::SceneMaker;

Material see_through(const Rgb& color, AlphaMode mode, double alpha) {
    Material m = glowing(color);
    m.alpha_mode = mode;
    m.alpha.value = alpha;
    return m;
}
Rectangle wall(double z) {
    return {.corner = {-2, -2, z}, .edge_u = {4, 0, 0}, .edge_v = {0, 4, 0}};
}
/// Faces away from the camera.
Rectangle turned_wall(double z) {
    return {.corner = {-2, -2, z}, .edge_u = {0, 4, 0}, .edge_v = {4, 0, 0}};
}

TEST(Alpha, BlendedSurfacesCoverWhatIsBehindInTheirOrder) {
    SceneMaker maker;
    maker.add(wall(0), maker.material(see_through({1, 0, 0}, AlphaMode::Blend, 0.5)));
    maker.add(wall(-1), maker.material(see_through({0, 1, 0}, AlphaMode::Blend, 0.25)));
    maker.add(wall(-2), maker.material(glowing({0, 0, 1})));
    const Scene scene = maker.compile();
    RayCounters counters;
    expect_near(center(scene, counters), {0.5, 0.125, 0.375});
    EXPECT_EQ(counters[RayKind::Eye].cast, 1u);
    EXPECT_EQ(counters[RayKind::Eye].hit, 1u);
    expect_near(center(scene, RayCasting{}), {0.5, 0.125, 0.375});
}

TEST(Alpha, WhatIsMaskedOutIsNotThere) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{0.25, 0.5, 0.75};
    maker.add(wall(0), maker.material(see_through({1, 0, 0}, AlphaMode::Mask, 0.25)));
    const Scene scene = maker.compile();
    RayCounters counters;
    expect_near(center(scene, counters), {0.25, 0.5, 0.75});
    EXPECT_EQ(counters[RayKind::Eye].hit, 0u);
    VisibleHit found;
    EXPECT_FALSE(first_visible_hit(scene, eye_ray(scene.cameras[0].camera, 0.5, 0.5), {}, false,
                                   nullptr, found));
}

TEST(Alpha, TheFirstVisibleHitKnowsItsDistanceFromTheEye) {
    SceneMaker maker;
    maker.add(wall(1), maker.material(see_through({1, 0, 0}, AlphaMode::Mask, 0)));
    maker.add(wall(0), maker.material(see_through({1, 0, 0}, AlphaMode::Blend, 0.25)));
    maker.add(wall(-2), maker.material(glowing({0, 0, 1})));
    const Scene scene = maker.compile();
    const Ray ray = eye_ray(scene.cameras[0].camera, 0.5, 0.5);
    VisibleHit found;
    ASSERT_TRUE(first_visible_hit(scene, ray, {}, false, nullptr, found));
    EXPECT_NEAR(found.t, 5, 1e-9);
    EXPECT_EQ(found.point.material->coverage, 0.25);
}

TEST(Alpha, ManyInvisibleSurfacesEndSomewhere) {
    SceneMaker maker;
    const MaterialId nothing = maker.material(see_through({1, 0, 0}, AlphaMode::Blend, 0.0));
    for (int i = 0; i < 100; ++i) maker.add(wall(-i), nothing);
    maker.add(wall(-200), maker.material(glowing({0, 0, 1})));
    expect_near(center(maker.compile()), {0, 0, 1});
}

/// A white floor lit from above through an object, as the camera sees it.
Rgb lit_behind(const Rectangle& between, const Material& m,
               void (*change)(SceneDescription&) = nullptr) {
    SceneMaker maker;
    Material white;
    white.diffuse.color = {1, 1, 1};
    maker.add(wall(0), maker.material(white));
    Rectangle aside = between;  // over the light's path, not over the camera's
    aside.corner = aside.corner + Vec3{4, 0, 0};
    maker.add(aside, maker.material(m));
    maker.light(DirectionalLight{.to_light = normalize(Vec3{4, 0, 1})});
    if (change != nullptr) change(maker.description());
    const double cosine = 1 / std::sqrt(17.0);
    return 1 / cosine * center(maker.compile());
}

TEST(Alpha, ShadowsAreAsThickAsTheSurface) {
    expect_near(lit_behind(wall(1), glowing({0, 0, 0})), {0, 0, 0});
    expect_near(lit_behind(wall(1), see_through({0, 0, 0}, AlphaMode::Blend, 0.25)),
                {0.75, 0.75, 0.75});
    expect_near(lit_behind(wall(1), see_through({0, 0, 0}, AlphaMode::Mask, 0.25)), {1, 1, 1});
    expect_near(lit_behind(wall(1), see_through({0, 0, 0}, AlphaMode::Mask, 0.75)), {0, 0, 0});
    Material tinted = see_through({0, 0, 0}, AlphaMode::Blend, 0.5);
    tinted.transmissive.color = {1, 0.5, 0};
    expect_near(lit_behind(wall(1), tinted), {1, 0.75, 0.5});
}

TEST(Alpha, ShadowsWithoutTintAreCutOutToo) {
    const auto opaque = [](SceneDescription& d) {
        d.conventions.shading.shadow_tint = ShadingConventions::ShadowTint::Opaque;
    };
    Material half = see_through({0, 0, 0}, AlphaMode::Blend, 0.5);
    half.transmissive.color = {1, 0.5, 0};
    expect_near(lit_behind(wall(1), half, opaque), {0.5, 0.5, 0.5});
    Material mask = see_through({0, 0, 0}, AlphaMode::Mask, 0.25);
    expect_near(lit_behind(wall(1), mask, opaque), {1, 1, 1});
    mask.alpha.value = 0.75;
    expect_near(lit_behind(wall(1), mask, opaque), {0, 0, 0});
    Material front_only = glowing({0, 0, 0});
    front_only.double_sided = false;
    expect_near(lit_behind(turned_wall(1), front_only, opaque), {1, 1, 1});
    expect_near(lit_behind(wall(1), front_only, opaque), {0, 0, 0});
    Material glass = glowing({0, 0, 0});
    glass.transmissive.color = {1, 1, 1};
    expect_near(lit_behind(wall(1), glass, opaque), {0, 0, 0});
}

/// Slabs of thickness 1, white and dark in turn, the white one from z on.
SolidTexture slabs_from(double z) {
    return {.kind = SolidTexture::Kind::Stripes,
            .color = {1, 1, 1, 1},
            .other = {0.125, 0.125, 0.125, 1},
            .origin = {0, 0, z}};
}

TEST(Alpha, ShadowsReadSolidTexturesWhereTheyAreCrossed) {
    Material slabs = glowing({0, 0, 0});
    slabs.transmissive = {{1, 1, 1}, TextureId{0}};
    expect_near(lit_behind(wall(1), slabs,
                           [](SceneDescription& d) {
                               d.textures.push_back({"", slabs_from(0.5), {}});
                           }),
                {1, 1, 1});
    expect_near(lit_behind(wall(1), slabs,
                           [](SceneDescription& d) {
                               d.textures.push_back({"", slabs_from(1.5), {}});
                           }),
                {0.125, 0.125, 0.125});
}

TEST(SingleSided, TheBackIsNotSeenAndLightPassesItFromThere) {
    Material front_only = glowing({1, 0, 0});
    front_only.double_sided = false;
    for (const bool turned : {false, true}) {
        SceneMaker maker;
        maker.add(turned ? turned_wall(0) : wall(0), maker.material(front_only));
        maker.add(wall(-1), maker.material(glowing({0, 0, 1})));
        const Rgb expected = turned ? Rgb{0, 0, 1} : Rgb{1, 0, 0};
        expect_near(center(maker.compile()), expected);
        expect_near(center(maker.compile(), RayCasting{}), expected);
    }
    expect_near(lit_behind(turned_wall(1), front_only), {1, 1, 1});
    expect_near(lit_behind(wall(1), front_only), {0, 0, 0});
}

/// Two triangles in the place of a wall between the light and what the camera sees.
TriangleMesh wall_mesh(double z) {
    TriangleMesh mesh;
    mesh.positions = {{2, -2, z}, {6, -2, z}, {6, 2, z}, {2, 2, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

TEST(SingleSided, MeshesLetLightPassFromBehindHoweverTheyArePlaced) {
    Material front_only = glowing({1, 0, 0});
    front_only.double_sided = false;
    Affine turned;  // about the line x = 4, z = 1: the light sees the back
    turned.linear = Mat3{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    turned.translation = {8, 0, 2};
    Affine mirrored;  // in x: the front stays the front
    mirrored.linear = Mat3{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mirrored.translation = {8, 0, 0};
    for (const char* accelerator : {"list", "wide_bvh"}) {
        for (const bool instanced : {false, true}) {
            for (const auto& [placement, passes] :
                 {std::pair{Affine{}, false}, std::pair{turned, true}, std::pair{mirrored, false},
                  std::pair{turned * mirrored, true}}) {
                SceneMaker maker;
                Material white;
                white.diffuse.color = {1, 1, 1};
                maker.add(wall(0), maker.material(white));
                const ObjectIndex object = maker.object("wall");
                maker.add(maker.mesh(wall_mesh(1)), maker.material(front_only), {}, object);
                maker.add(object, MaterialId{0}, placement);
                if (instanced) {
                    Affine away;
                    away.translation = {0, 0, -100};
                    maker.add(object, MaterialId{0}, away);
                }
                maker.light(DirectionalLight{.to_light = normalize(Vec3{4, 0, 1})});
                const double lit = passes ? 1 / std::sqrt(17.0) : 0.0;
                expect_near(center(maker.compile(accelerator)), {lit, lit, lit});
            }
        }
    }
}

Material physical(double transmission, double thickness) {
    Material m;
    m.index.value = 1.5;
    MetallicRoughness p;
    p.metallic.value = 0;
    p.roughness.value = 0;
    p.transmission.value = transmission;
    p.thickness.value = thickness;
    m.metallic_roughness = p;
    return m;
}

TEST(Unlit, ShowsItsColourWithoutLights) {
    Material m = physical(0, 0);
    m.metallic_roughness->unlit = true;
    m.metallic_roughness->base_color.color = {0.25, 0.5, 2};
    SceneMaker maker;
    maker.add(wall(0), maker.material(m));
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {9, 9, 9}});
    const Scene scene = maker.compile();
    RayCounters counters;
    expect_near(center(scene, counters), {0.25, 0.5, 2});
    EXPECT_EQ(counters[RayKind::Shadow].cast, 0u);
    expect_near(center(scene, RayCasting{}), {0.25, 0.5, 2});
    expect_near(lit_behind(wall(1), m), {0, 0, 0});
}

TEST(Transmission, AThinSheetLetsTheRayGoStraightOn) {
    SceneMaker maker;
    Material m = physical(1, 0);
    m.metallic_roughness->base_color.color = {1, 0.5, 0.25};
    maker.add(wall(0), maker.material(m), Affine::rotate({0, 1, 0}, 0.7));
    maker.add(Sphere{.center = {0, 0, -3}, .radius = 0.05}, maker.material(glowing({1, 1, 1})));
    // Fresnel by Schlick at 0.7 radians.
    const double f = 0.04 + 0.96 * std::pow(1 - std::cos(0.7), 5);
    expect_near(center(maker.compile()), {1 - f, 0.5 * (1 - f), 0.25 * (1 - f)}, 1e-9);
}

TEST(Transmission, LightFallsByTheLengthInsideAVolume) {
    SceneMaker maker;
    Material m = physical(1, 1);
    m.double_sided = false;
    m.metallic_roughness->attenuation_color = {0.5, 0.25, 1};
    m.metallic_roughness->attenuation_distance = 2;
    maker.add(BoxShape{{-1, -1, -2}, {1, 1, 2}}, maker.material(m));
    maker.add(wall(-3), maker.material(glowing({1, 1, 1})));
    maker.description().conventions.shading.max_depth = 2;
    // Four units inside: twice the distance; two surfaces pass 96 % each. One internal reflection
    // is also visible: 0.96 of it leaves towards the background.
    const double two = 0.96 * 0.96;
    expect_near(center(maker.compile()), {two * 0.25, two * 0.0625, two}, 1e-9);
}

TEST(Transmission, ShadowsAreTintedAndAbsorbedOnce) {
    // Light comes vertically down through a slab of two units; the camera looks obliquely under it.
    SceneMaker maker;
    Material white;
    white.diffuse.color = {1, 1, 1};
    maker.add(wall(0), maker.material(white));
    Material m = physical(1, 1);
    m.metallic_roughness->attenuation_color = {0.5, 0.25, 1};
    m.metallic_roughness->attenuation_distance = 2;
    m.double_sided = false;
    maker.add(BoxShape{{2, -2, 0.5}, {4, 2, 1.5}}, maker.material(m));
    maker.light(DirectionalLight{.to_light = normalize(Vec3{3, 0, 1})});
    // From (0,0,0): enters at x = 2 (z = 2/3), leaves at x = 4 (z = 4/3).
    const double inside = 2 * std::sqrt(10.0) / 3;
    const double cosine = 1 / std::sqrt(10.0);
    const Rgb c = center(maker.compile());
    EXPECT_NEAR(c.r, cosine * std::pow(0.5, inside / 2), 1e-9);
    EXPECT_NEAR(c.g, cosine * std::pow(0.25, inside / 2), 1e-9);
    EXPECT_NEAR(c.b, cosine, 1e-9);
}

TEST(Transmission, AThinSheetWithOneSideTintsLightThatComesToThatSide) {
    Material red = physical(1, 0);
    red.metallic_roughness->base_color.color = {1, 0, 0};
    red.double_sided = false;
    expect_near(lit_behind(wall(1), red), {1, 0, 0});
    expect_near(lit_behind(turned_wall(1), red), {1, 1, 1});
}

TEST(Transmission, ShadowsAreAbsorbedOverTheWholeWayThroughAVolumeWithSomethingInIt) {
    SceneMaker maker;
    Material white;
    white.diffuse.color = {1, 1, 1};
    maker.add(wall(0), maker.material(white));
    Material m = physical(1, 1);
    m.metallic_roughness->attenuation_color = {0.5, 0.25, 1};
    m.metallic_roughness->attenuation_distance = 2;
    maker.add(BoxShape{{2, -2, 0.5}, {4, 2, 1.5}}, maker.material(m));
    // A sheet of clear film in the middle of it.
    maker.add(Rectangle{.corner = {3, -2, 0.5}, .edge_u = {0, 4, 0}, .edge_v = {0, 0, 1}},
              maker.material(physical(1, 0)));
    maker.light(DirectionalLight{.to_light = normalize(Vec3{3, 0, 1})});
    const double inside = 2 * std::sqrt(10.0) / 3;
    const double cosine = 1 / std::sqrt(10.0);
    const Rgb c = center(maker.compile());
    EXPECT_NEAR(c.r, cosine * std::pow(0.5, inside / 2), 1e-9);
    EXPECT_NEAR(c.g, cosine * std::pow(0.25, inside / 2), 1e-9);
}

TEST(VertexColors, MultiplyTheDiffuseAndTheAlpha) {
    TriangleMesh mesh;
    mesh.positions = {{-2, -2, 0}, {4, -2, 0}, {-2, 4, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.colors.assign(3, {0.5f, 0.25f, 1, 0.5f});
    Material m;
    m.diffuse.color = {1, 1, 0.5};
    m.alpha_mode = AlphaMode::Blend;
    SceneMaker maker;
    maker.add(maker.mesh(mesh), maker.material(m));
    maker.light(DirectionalLight{.to_light = {0, 0, 1}});
    expect_near(center(maker.compile()), {0.25, 0.125, 0.25});
}

TEST(NormalMaps, BendTheLightAsTheSurfaceWouldLookTilted) {
    // A texel that tilts by 45 degrees towards +v (green up), on a wall whose v runs along +y.
    Image image(1, 1, 3);
    const float half = float(0.5 + 0.5 * std::sqrt(0.5));
    image.samples = {0.5f, half, half};
    SceneMaker maker;
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    maker.description().textures.push_back({"", texture, {}});
    Material m;
    m.diffuse.color = {1, 1, 1};
    m.normal_map.texture = TextureId{0};
    maker.add(wall(0), maker.material(m));
    maker.light(DirectionalLight{.to_light = normalize(Vec3{0, 1, 1})});
    EXPECT_NEAR(center(maker.compile()).r, 1.0, 1e-6);
    // Seen from behind, the same material tilts the normal in the other direction: the normal is
    // reversed.
    SceneMaker behind;
    behind.description().textures.push_back({"", texture, {}});
    behind.add(Rectangle{.corner = {2, -2, 0}, .edge_u = {-4, 0, 0}, .edge_v = {0, 4, 0}},
               behind.material(m));
    behind.light(DirectionalLight{.to_light = normalize(Vec3{0, -1, 1})});
    EXPECT_NEAR(center(behind.compile()).r, 1.0, 1e-6);
}

TEST(NormalMaps, AreTheSameOnAMirroredInstanceOfAMesh) {
    // Tangents and coordinates must agree however the mesh is placed.
    Image image(1, 1, 3);
    image.samples = {0.9f, 0.7f, 0.8f};
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    for (const Vec3 scale : {Vec3{1, 1, 1}, {-1, 1, 1}, {1, -2, 1}, {1, 1, -1}}) {
        for (const bool shared : {false, true}) {
            Rgb seen[2];
            for (const bool tangents : {false, true}) {
                TriangleMesh mesh;
                mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
                mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
                mesh.normals.assign(4, {0, 0, 1});
                mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
                if (tangents) mesh.tangents.assign(4, {1, 0, 0, 1});
                SceneMaker maker;
                maker.description().textures.push_back({"", texture, {}});
                Material m;
                m.diffuse.color = {1, 1, 1};
                m.normal_map.texture = TextureId{0};
                const MaterialId id = maker.material(m);
                const ObjectIndex owner = shared ? maker.object("o") : ObjectIndex{0};
                maker.add(maker.mesh(mesh), id, shared ? Affine{} : Affine::scale(scale), owner);
                if (shared) {
                    maker.add(owner, id, Affine::scale(scale));
                    maker.add(owner, id, Affine::translate({100, 0, 0}));
                }
                maker.light(DirectionalLight{.to_light = normalize(Vec3{0.3, 0.5, 1})});
                seen[tangents] = center(maker.compile());
            }
            EXPECT_GT(seen[0].r, 0.1);
            expect_near(seen[0], seen[1], 1e-6);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
