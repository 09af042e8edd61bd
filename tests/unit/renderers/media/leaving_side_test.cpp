// The medium of rays that leave a surface where interpolated normals and the true one disagree: it
// is that of the side on which they leave.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/core/renderer.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

/// How light is lost along the way in the block.
enum class Loss { KtByDistance, BeersLaw, Attenuation };

/// A block of which half the light passes a unit of length, or all. Its faces do not bend light.
struct Block {
    Vec3 up{0, 0, 1}, down{0, 0, -1};  ///< interpolated normals of the faces at z = 1 and -1
    Vec3 eye{0.1, 0.2, 5}, look{0, 0, -1};
    double index = 1.0;
    bool mirrors = false;
    bool opaque_below = false;  ///< the face at z = -1 is matt
    int depth = 1;
    Loss loss = Loss::KtByDistance;
    std::function<void(SceneMaker&)> rest;  ///< of the scene
};

TriangleMesh mesh_of(const Block& block) {
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            Vec3 normal;
            normal[axis] = side;
            if (axis == 2) normal = side > 0.0 ? block.up : block.down;
            for (const auto& [u, v] :
                 {std::array{-1.0, -side}, {1.0, -side}, {1.0, side}, {-1.0, side}}) {
                Vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = u;
                p[(axis + 2) % 3] = v;
                mesh.positions.push_back(p);
                mesh.normals.push_back(normal);
            }
            mesh.triangles.push_back({first, first + 1, first + 2});
            mesh.triangles.push_back({first, first + 2, first + 3});
        }
    }
    return mesh;
}

Material material_of(const Block& block, double passing) {
    Material m;
    m.index.value = block.index;
    if (block.loss == Loss::Attenuation) {
        MetallicRoughness& p = m.metallic_roughness.emplace();
        p.metallic.value = 0;
        p.roughness.value = 0;
        p.transmission.value = 0.5;
        p.thickness.value = 1;
        p.attenuation_distance = 1;
        p.attenuation_color = {passing, passing, passing};
        return m;
    }
    m.diffuse.color = {1, 1, 1};
    if (block.mirrors) m.reflective.color = {1, 1, 1};
    m.transmissive.color = {passing, passing, passing};
    return m;
}

double light_of(const std::string& renderer, const Block& block, double passing) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    if (block.loss == Loss::KtByDistance) {
        c.refraction_tint = ShadingConventions::RefractionTint::PerDistance;
        c.shadow_tint = ShadingConventions::ShadowTint::PerDistance;
    }
    c.optics.beer = block.loss == Loss::BeersLaw;
    c.correct_interpolated_normals = false;
    c.max_depth = block.depth;
    maker.description().cameras[0].camera = OrthographicCamera{
        block.eye, block.look, 1e-6 * cross(block.look, Vec3{0, 1, 0}), {0, 1e-6, 0}};
    const MaterialId glass = maker.material(material_of(block, passing));
    TriangleMesh mesh = mesh_of(block);
    if (block.opaque_below) {
        Material opaque = testing::matt({1, 1, 1});
        opaque.index.value = 1.0;
        const MaterialId below = maker.material(opaque);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const MaterialId m = mesh.normals[i] == block.down ? below : glass;
            mesh.vertex_materials.push_back(static_cast<std::uint32_t>(m));
        }
    }
    maker.add(maker.mesh(std::move(mesh)), glass);
    block.rest(maker);
    const Scene scene = maker.compile();
    EXPECT_TRUE(block.loss != Loss::KtByDistance || scene.is_closed(0));
    const RenderJob job{
        .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
    Film film(1, 1, {0, 0, 1, 1});
    EXPECT_TRUE(make_renderer(renderer)->render(job, film).complete());
    return film.at(0, 0).r;
}

/// Expects that half of the light is lost per unit of `way`.
void expect_way(const std::vector<std::string>& renderers, const Block& block, double way) {
    for (const std::string& renderer : renderers) {
        const double all = light_of(renderer, block, 1.0);
        EXPECT_GT(all, 0.05) << renderer;
        EXPECT_NEAR(light_of(renderer, block, 0.5) / all, std::pow(0.5, way), 1e-6) << renderer;
    }
}

const std::vector<std::string> kAll{"whitted", "distributed", "beam_tracing", "cone_tracing"};
const std::vector<std::string> kByRays{"whitted", "distributed"};
const std::vector<std::string> kByNormals{"whitted", "distributed", "cone_tracing"};

constexpr Loss kLosses[] = {Loss::KtByDistance, Loss::BeersLaw, Loss::Attenuation};
const std::vector<std::string>& renderers_of(Loss loss) {
    return loss == Loss::BeersLaw ? kByRays : kAll;
}

std::function<void(SceneMaker&)> lamp_at(const Vec3& position) {
    return [position](SceneMaker& m) {
        m.light(PointLight{.position = position, .color = {1, 1, 1}, .attenuation = {1, 0, 0}});
    };
}

/// A shining square across `direction`, seen at the distance 5.
std::function<void(SceneMaker&)> square_seen(const Vec3& from, const Vec3& direction) {
    return [from, direction](SceneMaker& m) {
        const Vec3 y{0, 0.4, 0}, x = cross(y, direction);
        m.add(rectangle(from + 5.0 * direction - 0.5 * (x + y), x, y),
              m.material(shining({1, 1, 1})));
    };
}

/// The face at z = -1 is seen from inside, and its light is outside.
TEST(LeavingSide, LightThatLeavesABodyIsNotTintedBehindIt) {
    for (const Loss loss : kLosses) {
        SCOPED_TRACE(static_cast<int>(loss));
        Block block{.down = {0.8, 0, -0.6}, .loss = loss};
        block.rest = lamp_at(Vec3{0.1, 0.2, -1} + 9.0 * Vec3{-0.96, 0, -0.28});
        expect_way(renderers_of(loss), block, 2.0);
    }
}

TEST(LeavingSide, LightLeavesABodyWhereItIsOpaque) {
    Block block{.down = {0.8, 0, -0.6}, .opaque_below = true};
    block.rest = lamp_at(Vec3{0.1, 0.2, -1} + 9.0 * Vec3{-0.96, 0, -0.28});
    expect_way(kAll, block, 2.0);
}

/// The face at z = 1 is seen from outside and lit from inside: from behind the block, and in it.
TEST(LeavingSide, LightToTheBackOfAFaceIsTintedByTheWayInTheBody) {
    for (const Loss loss : kLosses) {
        for (const double far : {9.0, 0.5}) {
            SCOPED_TRACE(std::to_string(static_cast<int>(loss)) + ", " + std::to_string(far));
            Block block{.up = {0.8, 0, 0.6}, .depth = 0, .loss = loss};
            block.rest = lamp_at(Vec3{0.1, 0.2, 1} + far * Vec3{0.96, 0, -0.28});
            expect_way(renderers_of(loss), block, far < 1.0 ? far : 0.9 / 0.96);
        }
    }
}

TEST(LeavingSide, ARayReflectedOutOfABodyIsNotTintedBehindIt) {
    for (const Loss loss : {Loss::KtByDistance, Loss::BeersLaw}) {
        Block block{.down = {0.8, 0, -0.6}, .mirrors = true, .depth = 2, .loss = loss};
        block.rest = square_seen({0.1, 0.2, -1}, {-0.96, 0, -0.28});
        expect_way(loss == Loss::BeersLaw ? kByRays : kByNormals, block, 2.0);
    }
}

TEST(LeavingSide, ARayReflectedIntoABodyIsTintedByTheWayInIt) {
    for (const Loss loss : {Loss::KtByDistance, Loss::BeersLaw}) {
        Block block{.up = {0.8, 0, 0.6}, .mirrors = true, .depth = 2, .loss = loss};
        block.rest = square_seen({0.1, 0.2, 1}, {0.96, 0, -0.28});
        expect_way(loss == Loss::BeersLaw ? kByRays : kByNormals, block, 0.9 / 0.96);
    }
}

/// The interpolated normal is turned away from the eye; the index bends the ray back out.
TEST(LeavingSide, ARefractedRayThatDoesNotEnterABodyIsNotTinted) {
    const Vec3 look = normalize(Vec3{0.95, 0, -0.3});
    Block block{.up = {0.5, 0, std::sqrt(0.75)}, .eye = Vec3{0.1, 0.2, 1} - 3.0 * look};
    block.look = look;
    block.index = 0.8;
    block.rest = [](SceneMaker& m) {
        m.add(rectangle({9, -50, -50}, {0, 100, 0}, {0, 0, 100}), m.material(shining({1, 1, 1})));
    };
    expect_way(kByNormals, block, 0.0);
}

/// The back of an opaque triangle in an absorbing block; its normal leans so far that the light is
/// behind it. A face that is opaque bounds nothing.
TEST(LeavingSide, LightBehindAnOpaqueFaceIsAbsorbedByTheBlockAround) {
    constexpr double kAbsorption = 0.7;
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0.1, 0.1, 3}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    Material clear;
    clear.index.value = 1.0;
    clear.dielectric = Dielectric{{kAbsorption, kAbsorption, kAbsorption}};
    maker.add(BoxShape{{-2, -2, -2}, {2, 2, 2}}, maker.material(clear));
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 2, 1}};
    mesh.normals.assign(3, normalize(Vec3{-1, 0, -1}));
    maker.add(maker.mesh(std::move(mesh)), maker.material(testing::matt({1, 1, 1})));
    const Vec3 to_light = normalize(Vec3{1, 0, -0.2});
    maker.light(DirectionalLight{.to_light = to_light, .color = {1, 1, 1}});
    const Scene scene = maker.compile();
    const double way = 2.0 + 1.9 / to_light.x;
    const double expected = dot(normalize(Vec3{1, 0, 1}), to_light) * std::exp(-kAbsorption * way);
    for (const std::string& renderer : kByNormals) {
        const RenderJob job{
            .scene = scene, .camera = scene.cameras[0].camera, .description = &maker.description()};
        Film film(1, 1, {0, 0, 1, 1});
        EXPECT_TRUE(make_renderer(renderer)->render(job, film).complete());
        EXPECT_NEAR(film.at(0, 0).r, expected, 1e-6) << renderer;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
