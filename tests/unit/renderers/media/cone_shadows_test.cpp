// Sides, far walls and ways through bodies of cones, against single rays.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "alhazen/renderers/cone_tracing/cone_tracing.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using ShadowTint = ShadingConventions::ShadowTint;

/// The colour of a pixel that is a thousandth of a milliradian wide, by a cone or by a ray.
struct Pair {
    Rgb cone, ray;
};
Pair colors_of(SceneMaker& maker, const Vec3& eye, const Vec3& at) {
    const Scene scene = maker.compile();
    const Camera camera = look_along(eye, at - eye, {0.1, 0.8, 0.6}, 1e-6, 1.0);
    Film cone(1, 1, {0, 0, 1, 1}), ray = cone;
    const RenderJob job{
        .scene = scene, .camera = camera, .description = &maker.description(), .control = {}};
    EXPECT_TRUE(ConeTracing().render(job, cone).complete());
    EXPECT_TRUE(Whitted().render(job, ray).complete());
    return {cone.at(0, 0), ray.at(0, 0)};
}

/// Both renderers have this colour.
void expect_both(SceneMaker& maker, const Vec3& eye, const Vec3& at, const Rgb& expected) {
    const Pair pair = colors_of(maker, eye, at);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_NEAR(pair.ray[channel], expected[channel], 1e-6) << channel;
        EXPECT_NEAR(pair.cone[channel], expected[channel], 1e-6) << channel;
    }
}

const Vec3 kBesides{0, -3, 0.5};
const Rgb kTint{0.5, 0.7, 0.9};

Material white() {
    Material material;
    material.diffuse.color = {1, 1, 1};
    return material;
}
Material tinted() {
    Material material;
    material.transmissive.color = kTint;
    material.index.value = 1;
    return material;
}
Material blended(double alpha) {
    Material material;
    material.alpha_mode = AlphaMode::Blend;
    material.alpha.value = alpha;
    return material;
}
/// A floor at z = 0 and a light at z = 9, or elsewhere.
void add_floor(SceneMaker& maker, const Vec3& light = {0, 0, 9}) {
    maker.add(Rectangle{.corner = {-5, -5, 0}, .edge_u = {10, 0, 0}, .edge_v = {0, 10, 0}},
              maker.material(white()));
    maker.light(PointLight{.position = light});
}
Rectangle sheet(double z, bool faces_up) {
    const Vec3 u{4, 0, 0}, v{0, 4, 0};
    return {.corner = {-2, -2, z}, .edge_u = faces_up ? u : v, .edge_v = faces_up ? v : u};
}

TEST(ConeShadows, ASingleSidedSurfaceBlocksLightToItsFrontAlone) {
    for (const bool faces_light : {true, false}) {
        SceneMaker maker;
        add_floor(maker);
        Material material = white();
        material.double_sided = false;
        maker.add(sheet(2, faces_light), maker.material(material));
        expect_both(maker, kBesides, {}, grey(faces_light ? 0 : 1));
    }
}

TEST(ConeShadows, ALightInsideASingleSidedSolidShinesOut) {
    for (const double height : {5.0, 9.0}) {
        SceneMaker maker;
        add_floor(maker, {0, 0, height});
        Material material = white();
        material.double_sided = false;
        maker.add(BoxShape{{-1, -1, 4}, {1, 1, 6}}, maker.material(material));
        // Light from inside comes to the back, light from outside leaves by the front.
        expect_both(maker, kBesides, {}, grey(height < 6 ? 1 : 0));
    }
}

TEST(ConeShadows, BothWallsOfASolidWithAlphaBlock) {
    SceneMaker plain, clear;
    add_floor(plain);
    plain.add(BoxShape{{-2, -2, 1}, {2, 2, 3}}, plain.material(blended(0.4)));
    expect_both(plain, kBesides, {}, grey(0.36));
    add_floor(clear);
    Material material = blended(0.4);
    material.transmissive.color = kTint;
    clear.add(Sphere{{0, 0, 2}, 1}, clear.material(material));
    Rgb passed;
    for (int k = 0; k < 3; ++k) passed[k] = std::pow(0.6 + 0.4 * kTint[k], 2);
    expect_both(clear, kBesides, {}, passed);
}

TEST(ConeTracing, TheFarWallOfASolidWithAlphaIsSeen) {
    Material material = blended(0.4);
    material.emission.color = {1, 1, 1};
    SceneMaker ball, box, mesh;
    ball.add(Sphere{}, ball.material(material));
    expect_both(ball, {0, -6, 0.01}, {}, grey(0.64));
    box.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, box.material(material));
    expect_both(box, {0, -6, 0.01}, {}, grey(0.64));
    mesh.add(mesh.mesh(testing::tetrahedron()), mesh.material(material));
    expect_both(mesh, {0.1, -6, 0.01}, {}, grey(0.64));
}

TEST(ConeTracing, AWideConeSeesTheFarWallBehindTheFrontOnly) {
    // A ball that covers a part of the cone covers no more of it with both sides than with one.
    Material glow;
    glow.emission.color = {1, 1, 1};
    const OrthographicCamera camera{{0, 0, 100}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
    const auto covered = [&](Material material) {
        SceneMaker maker;
        maker.add(Sphere{.center = {0.5, 0, 0}, .radius = 0.4}, maker.material(material));
        const Scene scene = maker.compile();
        Film film(1, 1, {0, 0, 1, 1});
        const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
        EXPECT_TRUE(ConeTracing().render(job, film).complete());
        return film.at(0, 0).r;
    };
    const double whole = covered(glow);
    ASSERT_GT(whole, 0.1);
    ASSERT_LT(whole, 0.9);
    glow.alpha_mode = AlphaMode::Mask;
    EXPECT_NEAR(covered(glow), whole, 1e-12);
    glow.alpha_mode = AlphaMode::Blend;
    glow.alpha.value = 0.4;
    EXPECT_NEAR(covered(glow), 0.64 * whole, 1e-12);
}

TEST(ConeShadows, AbsorbingGlassTintsByTheWayInside) {
    Material glass;
    glass.index.value = 1;
    glass.metallic_roughness.emplace();
    glass.metallic_roughness->metallic.value = 0;
    glass.metallic_roughness->roughness.value = 0;
    glass.metallic_roughness->transmission.value = 1;
    glass.metallic_roughness->thickness.value = 1;
    glass.metallic_roughness->specular.value = 0;
    glass.metallic_roughness->attenuation_distance = 0.5;
    glass.metallic_roughness->attenuation_color = kTint;
    for (const int shape : {0, 1, 2}) {
        for (const double light : {9.0, 2.0}) {
            SceneMaker maker;
            add_floor(maker, {0, 0, light});
            const MaterialId id = maker.material(glass);
            if (shape == 0) maker.add(Sphere{{0, 0, 2}, 0.5}, id);
            if (shape == 1) maker.add(BoxShape{{-1, -1, 1.5}, {1, 1, 2.5}}, id);
            if (shape == 2) {
                // The line x = y = 0 is inside from -1/3 to 1/3.
                TriangleMesh mesh = testing::tetrahedron();
                mesh.transform(Affine::translate({0, 0, 2}) * Affine::rotate({1, -1, 0}, 0.3));
                maker.add(maker.mesh(mesh), id);
                const Pair pair = colors_of(maker, kBesides, {});
                EXPECT_LT(pair.ray.r, 0.9);
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(pair.cone[k], pair.ray[k], 1e-6);
                continue;
            }
            expect_both(maker, kBesides, {}, light > 3 ? kTint * kTint : kTint);
        }
    }
}

TEST(ConeShadows, ALightInsideATintedSolidPassesOneWall) {
    for (const bool by_distance : {false, true}) {
        for (const int shape : {0, 1}) {
            SceneMaker maker;
            add_floor(maker, {0, 0, 5});
            if (by_distance) {
                maker.description().conventions.shading.shadow_tint = ShadowTint::PerDistance;
            }
            const MaterialId id = maker.material(tinted());
            if (shape == 0) maker.add(Sphere{{0, 0, 5}, 0.5}, id);
            if (shape == 1) maker.add(BoxShape{{-1, -1, 4.5}, {1, 1, 5.5}}, id);
            Rgb passed = kTint;
            for (int k = 0; by_distance && k < 3; ++k) passed[k] = std::sqrt(kTint[k]);
            expect_both(maker, kBesides, {}, passed);
        }
    }
}

TEST(ConeShadows, AnOpenSheetTintsByDistanceInFrontOfTheLightAlone) {
    for (const bool faces_light : {true, false}) {
        SceneMaker maker;
        add_floor(maker);
        maker.description().conventions.shading.shadow_tint = ShadowTint::PerDistance;
        maker.add(sheet(2, faces_light), maker.material(tinted()));
        expect_both(maker, kBesides, {}, faces_light ? kTint * kTint : Rgb{1, 1, 1});
    }
}

TEST(ConeShadows, SingleSidedSurfacesInOnePlaneDoNotShadeEachOther) {
    SceneMaker maker;
    Material material = white();
    material.double_sided = false;
    const MaterialId id = maker.material(material);
    maker.add(sheet(0, true), id);
    maker.add(sheet(0, true), id);
    maker.light(DirectionalLight{.to_light = {0, 0.6, 0.8}});
    const Scene scene = maker.compile();
    const Camera camera = look_along({0, -3, 1}, {0, 3, -1}, {0, 0, 1}, 0.1, 1.0);
    Film film(1, 1, {0, 0, 1, 1});
    const RenderJob job{.scene = scene, .camera = camera, .description = &maker.description()};
    EXPECT_TRUE(ConeTracing().render(job, film).complete());
    EXPECT_NEAR(film.at(0, 0).r, 0.8, 1e-12);
}

/// A prism from z = 1.5 to 2.5, whose upper half has a colour of its own.
TriangleMesh prism(float upper) {
    TriangleMesh mesh;
    for (const double z : {1.5, 2.5}) {
        for (const Vec2& p : {Vec2{-1, -1}, Vec2{1, -1}, Vec2{0, 1.5}}) {
            mesh.positions.push_back({p.x, p.y, z});
            const float share = z > 2 ? upper : 1.0f;
            mesh.colors.push_back({share, share, share, 1});
        }
    }
    mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                      {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    return mesh;
}

TEST(ConeShadows, EachWallOfASolidTintsByItsOwnColour) {
    // Slabs of thickness 1: white from z = 2 to 3, dark from 1 to 2.
    const SolidTexture slabs{.kind = SolidTexture::Kind::Stripes,
                             .color = {1, 1, 1, 1},
                             .other = {0.125, 0.25, 0.5, 1},
                             .origin = {0, 0, 2}};
    Material material = tinted();
    material.transmissive = {{1, 1, 1}, TextureId{0}};
    for (const int shape : {0, 1, 2}) {
        SceneMaker maker;
        add_floor(maker);
        maker.description().textures.push_back({"", slabs, {}});
        const MaterialId id = maker.material(material);
        if (shape == 0) maker.add(Sphere{{0, 0, 2}, 0.5}, id);
        if (shape == 1) maker.add(BoxShape{{-1, -1, 1.5}, {1, 1, 2.5}}, id);
        if (shape == 2) maker.add(maker.mesh(prism(1)), id);
        expect_both(maker, kBesides, {}, {0.125, 0.25, 0.5});
    }
}

TEST(ConeShadows, WallsOfAMeshTintByTheirVertexColours) {
    SceneMaker maker;
    add_floor(maker);
    Material glass;
    glass.index.value = 1;
    MetallicRoughness& clear = glass.metallic_roughness.emplace();
    clear.metallic.value = 0;
    clear.roughness.value = 0;
    clear.transmission.value = 1;
    clear.thickness.value = 1;
    clear.specular.value = 0;
    maker.add(maker.mesh(prism(0.25)), maker.material(glass));
    expect_both(maker, kBesides, {}, grey(0.25));
}

Material absorbing() {
    Material material;
    material.dielectric = Dielectric{{0.5, 0.2, 0.1}};
    material.index.value = 1;
    return material;
}
/// Adds two blocks of unit thickness above each other, as boxes that share edges or as one mesh.
void add_blocks(SceneMaker& maker, const Material& lower, const Material& upper, bool as_mesh) {
    if (!as_mesh) {
        maker.add(BoxShape{{-1, -1, 1}, {1, 1, 2}}, maker.material(lower));
        maker.add(BoxShape{{-1, -1, 2}, {1, 1, 3}}, maker.material(upper));
        return;
    }
    TriangleMesh both = prism(1);
    TriangleMesh other = both;
    other.transform(Affine::translate({0, 0, 2}));
    for (auto triangle : other.triangles) {
        for (auto& corner : triangle) corner += 6;
        both.triangles.push_back(triangle);
    }
    both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
    both.colors.clear();
    maker.add(maker.mesh(both), maker.material(lower));
}

TEST(ConeShadows, PartsOfASurfaceBehindEachOtherTintOneAfterTheOther) {
    for (const bool as_mesh : {false, true}) {
        const auto expect_passed = [&](const Material& material, ShadowTint tint,
                                       const Rgb& expected) {
            SceneMaker maker;
            add_floor(maker);
            maker.description().conventions.shading.shadow_tint = tint;
            add_blocks(maker, material, material, as_mesh);
            expect_both(maker, kBesides, {}, expected);
        };
        expect_passed(absorbing(), ShadowTint::PerCrossing,
                      {std::exp(-1.0), std::exp(-0.4), std::exp(-0.2)});
        expect_passed(tinted(), ShadowTint::PerDistance, kTint * kTint);
        expect_passed(tinted(), ShadowTint::PerCrossing, kTint * kTint * kTint * kTint);
    }
}

TEST(ConeShadows, AnOpaqueBlockOnOneOfGlassBlocks) {
    for (const bool below : {false, true}) {
        SceneMaker maker;
        add_floor(maker);
        add_blocks(maker, below ? white() : absorbing(), below ? absorbing() : white(), false);
        expect_both(maker, kBesides, {}, {});
    }
}

TEST(ConeTracing, AnOpaqueSheetIsSeenThroughOneWithAlphaThatSharesItsEdge) {
    Material leaf = blended(0.4);
    Material glow;
    glow.emission.color = {1, 1, 1};
    SceneMaker maker;
    // Both share the edge from (-2, -2, 0) to (-2, 2, 0).
    maker.add(Rectangle{{-2, -2, 0}, {4, 0, 1}, {0, 4, 0}}, maker.material(leaf));
    maker.add(Rectangle{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}, maker.material(glow));
    expect_both(maker, {0, 0, 6}, {}, grey(0.6));
}

/// Random bodies above each other, with a light above or inside.
class RandomPile {
  public:
    explicit RandomPile(unsigned seed) : random_(seed) {
        ShadingConventions& shading = maker.description().conventions.shading;
        shading.shadow_tint = std::array{ShadowTint::PerCrossing, ShadowTint::PerDistance,
                                         ShadowTint::Opaque}[below(3)];
        by_distance_ = shading.shadow_tint == ShadowTint::PerDistance;
        maker.description().picture.background = Rgb{0.1, 0.2, 0.3};
        double z = 0.4;
        std::vector<Vec3> lights;
        for (std::size_t k = 1 + below(3); k > 0; --k) {
            const double height = between(0.5, 1.2);
            add_body(z, height);
            lights.push_back(
                {between(-0.05, 0.05), between(-0.05, 0.05), z + between(0.35, 0.6) * height});
            z += height + between(0.1, 0.4);
        }
        const Vec3 above{between(-0.2, 0.2), between(-0.2, 0.2), z + 1};
        add_floor(maker, below(2) == 0 ? above : lights[below(lights.size())]);
        eye = std::array{Vec3{0.03, -3, 0.2}, Vec3{0.3, -0.2, z + 3}, Vec3{0.02, 0.03, z + 2},
                         Vec3{2, 2, 0.9}}[below(4)];
        at = {between(-0.1, 0.1), between(-0.1, 0.1), eye.z == 0.9 ? between(0.5, 1.5) : 0.0};
    }

    SceneMaker maker;
    Vec3 eye, at;

  private:
    std::size_t below(std::size_t n) { return random_() % n; }
    double between(double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(random_()) * 0x1p-32);
    }
    Rgb color() { return {between(0.2, 1), between(0.2, 1), between(0.2, 1)}; }
    Material any_material(bool closed) {
        Material material;
        material.index.value = 1;
        material.diffuse.color = color();
        material.emission.color = color();
        const std::size_t kind = below(closed ? 8 : 7);
        if (kind == 0 || kind == 1 || kind == 2) {
            material.alpha_mode = AlphaMode::Blend;
            material.alpha.value = between(0.2, 0.8);
        }
        if (kind == 1 || kind == 3) material.double_sided = false;
        if (kind == 4 || (kind == 2 && !by_distance_)) material.transmissive.color = color();
        if (kind == 5) {
            material.alpha_mode = AlphaMode::Mask;
            material.alpha.value = below(2) == 0 ? 0.2 : 0.8;
        }
        if (kind < 7) return material;
        MetallicRoughness& glass = material.metallic_roughness.emplace();
        material.emission.color = {};
        glass.metallic.value = 0;
        glass.roughness.value = 0;
        glass.transmission.value = 1;
        glass.thickness.value = 1;
        glass.specular.value = 0;
        glass.attenuation_distance = 0.5;
        glass.attenuation_color = color();
        return material;
    }
    void add_body(double z, double height) {
        const std::size_t shape = below(4);
        const MaterialId id = maker.material(any_material(shape != 3));
        const double middle = z + height / 2;
        if (shape == 0) {
            maker.add(Sphere{{between(-0.1, 0.1), between(-0.1, 0.1), middle}, height / 2}, id);
        } else if (shape == 1) {
            maker.add(BoxShape{{-0.6, -0.7, z}, {0.8, 0.6, z + height}}, id);
        } else if (shape == 2) {
            TriangleMesh mesh;
            mesh.positions = {
                {-1, -1, z}, {1, -1, z + 0.05}, {0, 1.3, z + 0.02}, {0.1, 0.1, z + height}};
            mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
            maker.add(maker.mesh(mesh), id);
        } else {
            maker.add(sheet(middle, below(2) == 0), id);
        }
    }

    std::mt19937 random_;
    bool by_distance_ = false;
};

TEST(ConeTracing, AThinConeIsARayThroughAlphaSidesTintsAndGlass) {
    constexpr unsigned kCount = 3000;
    unsigned alike = 0;
    for (unsigned seed = 1; seed <= kCount; ++seed) {
        RandomPile pile(seed);
        const Pair pair = colors_of(pile.maker, pile.eye, pile.at);
        double most = 0;
        for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(pair.cone[k] - pair.ray[k]));
        // Cones of less than 1 / 256 are not followed.
        EXPECT_LT(most, 0.02) << "seed " << seed;
        alike += most < 1e-6;
    }
    EXPECT_GT(alike, 0.95 * kCount);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
