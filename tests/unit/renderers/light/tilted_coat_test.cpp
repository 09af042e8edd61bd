// Clear coats whose normal is not that of the layers below.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "support/image_texture.h"
#include "support/light_pictures.h"
#include "support/random.h"
#include "unit/renderers/light/both_directions.h"
#include "unit/renderers/light/scatter_at.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_both_directions_agree;
using testing::SceneMaker;
using testing::set_scatter_point;

/// Tilts of the normals towards +x, 0: no map.
struct Maps {
    double base = 0, coat = 0;
};

TextureId tilt_map(SceneMaker& maker, double tilt) {
    if (tilt == 0.0) return kNoTexture;
    Image image(1, 1, 3);
    const Vec3 n{std::sin(tilt), 0, std::cos(tilt)};
    for (int k = 0; k < 3; ++k) image.pixel(0, 0)[k] = static_cast<float>(0.5 * (n[k] + 1));
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    texture.filter = TextureFilter::Nearest;
    auto& textures = maker.description().textures;
    textures.push_back({"tilt", texture});
    return TextureId{static_cast<std::uint32_t>(textures.size() - 1)};
}

/// A square of side 2 in the plane z = 0.
SceneMaker coated_square(Material material, const Maps& maps) {
    SceneMaker maker;
    material.normal_map.texture = tilt_map(maker, maps.base);
    material.metallic_roughness->coat.normal_map.texture =
        maps.coat == maps.base ? material.normal_map.texture : tilt_map(maker, maps.coat);
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    maker.add(maker.mesh(std::move(mesh)), maker.material(std::move(material)));
    return maker;
}

enum class Base { Black, Metal, Plastic, ThinGlass };

Material coated(Base base, double roughness, double strength = 0.8) {
    Material m;
    MetallicRoughness& p = m.metallic_roughness.emplace();
    p.metallic.value = base == Base::Metal ? 1 : 0;
    p.roughness.value = 0.5;
    p.transmission.value = base == Base::ThinGlass ? 0.7 : 0;
    if (base == Base::Black) {
        p.base_color.color = {0, 0, 0};
        p.specular.value = 0;
    }
    p.coat.strength.value = strength;
    p.coat.roughness.value = roughness;
    m.index.value = 1.5;
    return m;
}

const Maps kMaps[] = {{0.4, 0}, {0, 0.4}, {0.9, -0.5}};

TEST(TiltedCoat, IsNotBentByTheMapOfTheLayersBelow) {
    const Scene flat = coated_square(coated(Base::Black, 0.3), {}).compile();
    const Scene bent = coated_square(coated(Base::Black, 0.3), {0.6, 0}).compile();
    const Scene shared = coated_square(coated(Base::Black, 0.3), {0.6, 0.6}).compile();
    const Scene own = coated_square(coated(Base::Black, 0.3), {0, 0.6}).compile();
    testing::Random random(11);
    int lit = 0, different = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 view = random.unit_vector(), light = random.unit_vector();
        double value[4];
        int n = 0;
        for (const Scene* scene : {&flat, &bent, &shared, &own}) {
            ScatterPoint scatter;
            set_scatter_point(*scene, view, scatter);
            value[n++] = scatter.value(light, Transport::Radiance).a;
        }
        const std::string what = std::to_string(i);
        EXPECT_NEAR(value[1], value[0], 1e-9 * value[0]) << what;
        EXPECT_NEAR(value[3], value[2], 1e-9 * value[2]) << what;
        lit += value[0] > 1e-3;
        different += std::abs(value[2] - value[0]) > 0.1 * value[0];
    }
    EXPECT_GT(lit, 50);
    EXPECT_GT(different, 100);
}

TEST(TiltedCoat, PathsOfBothDirectionsAgree) {
    for (const Base base : {Base::Metal, Base::Plastic, Base::ThinGlass}) {
        for (const Maps& maps : kMaps) {
            const Scene scene = coated_square(coated(base, 0.4), maps).compile();
            testing::Random random(7);
            int lit = 0;
            for (int i = 0; i < 1000; ++i) {
                const Vec3 to_eye = random.unit_vector(), to_light = random.unit_vector();
                ScatterPoint eye, light;
                set_scatter_point(scene, to_eye, eye);
                set_scatter_point(scene, to_light, light);
                const std::string what = std::to_string(static_cast<int>(base)) + ", map " +
                                         std::to_string(maps.base) + ", " + std::to_string(i);
                const double seen =
                    expect_both_directions_agree(eye, to_eye, light, to_light, what);
                lit += seen > 0;
            }
            EXPECT_GT(lit, 300);
        }
    }
}

/// Samples are distributed by the density, their weights give the integral of the value, and no
/// more light is scattered than comes.
TEST(TiltedCoat, SamplesFollowTheDensityAndKeepTheEnergy) {
    for (const Base base : {Base::Metal, Base::Plastic, Base::ThinGlass}) {
        for (const Maps& maps : kMaps) {
            for (const double roughness : {0.0, 0.4}) {
                const Scene scene = coated_square(coated(base, roughness), maps).compile();
                for (const Vec3& direction : {Vec3{0.3, 0.2, 0.9}, Vec3{-0.8, 0.1, -0.4}}) {
                    ScatterPoint scatter;
                    set_scatter_point(scene, normalize(direction), scatter);
                    const std::string what = std::to_string(static_cast<int>(base)) + ", map " +
                                             std::to_string(maps.base) + ", roughness " +
                                             std::to_string(roughness);
                    RandomStream random(5);
                    constexpr int kCount = 40000;
                    double sampled = 0, wide = 0, integral = 0, density = 0, hits = 0;
                    for (int i = 0; i < kCount; ++i) {
                        const double choice = random.uniform();
                        const Vec2 u{random.uniform(), random.uniform()};
                        const auto s = scatter.sample(choice, u, Transport::Radiance);
                        if (s) {
                            sampled += s->weight.a / kCount;
                            if (!s->singular) wide += s->weight.a / kCount, hits += 1.0 / kCount;
                        }
                        const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * kPi);
                        const double r = std::sqrt(1 - z * z);
                        const Vec3 any{r * std::cos(turn), r * std::sin(turn), z};
                        integral += 4 * kPi / kCount * scatter.value(any, Transport::Radiance).a;
                        density += 4 * kPi / kCount * scatter.density(any);
                    }
                    EXPECT_LT(sampled, 1.02) << what;
                    EXPECT_GT(sampled, 0.1) << what;  // the rest leaves below the surface
                    EXPECT_NEAR(wide, integral, 0.04) << what;
                    EXPECT_NEAR(hits, density, 0.04) << what;
                }
            }
        }
    }
}

TEST(TiltedCoat, RenderersAgree) {
    for (const double roughness : {0.0, 0.4}) {
        for (const Maps& maps : kMaps) {
            Material material = coated(Base::Plastic, roughness, 1);
            material.metallic_roughness->base_color.color = {0.5, 0.5, 0.5};
            SceneMaker maker = coated_square(std::move(material), maps);
            const Vec3 eye{-3, 0.001, 2};
            maker.description().cameras[0].camera =
                look_along(eye, normalize(-eye), {0, 1, 0.1}, 0.2, 1.0);
            maker.add(testing::ball({2.4, 0, 1.6}, 0.5),
                      maker.material(testing::shining({8, 8, 8})));
            maker.add(testing::ball({0, 2.4, 0.4}, 0.4),
                      maker.material(testing::shining({4, 4, 4})));
            const Scene scene = maker.compile();
            const double truth =
                testing::mean_of(testing::picture_of(scene, "path_tracing", 8, 256)).g;
            EXPECT_GT(truth, 0.05);
            for (const char* renderer : {"bidirectional", "vcm:photons=4000"}) {
                const Rgb mean = testing::mean_of(testing::picture_of(scene, renderer, 8, 256));
                EXPECT_NEAR(mean.g, truth, 0.02 * truth)
                    << renderer << ", roughness " << roughness << ", map " << maps.base;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
