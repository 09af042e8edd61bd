// Normal maps in renderers whose paths come from lights.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "alhazen/math/unit_vector.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "support/image_texture.h"
#include "support/light_pictures.h"
#include "support/random.h"
#include "unit/renderers/light/both_directions.h"
#include "unit/renderers/light/scatter_at.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_both_directions_agree;
using testing::matt;
using testing::SceneMaker;
using testing::set_scatter_point;

/// A square of side 2 in the plane z = 0 whose map tilts the normal to +x.
SceneMaker tilted_square(Material material, double tilt) {
    SceneMaker maker;
    Image image(1, 1, 3);
    const Vec3 n{std::sin(tilt), 0, std::cos(tilt)};
    for (int k = 0; k < 3; ++k) image.pixel(0, 0)[k] = static_cast<float>(0.5 * (n[k] + 1));
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    texture.filter = TextureFilter::Nearest;
    maker.description().textures.push_back({"tilt", texture});
    material.normal_map.texture = TextureId{0};
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    maker.add(maker.mesh(std::move(mesh)), maker.material(std::move(material)));
    return maker;
}

Material rough_metal() {
    Material m;
    m.metallic_roughness.emplace();
    m.metallic_roughness->metallic.value = 1;
    m.metallic_roughness->roughness.value = 0.6;
    return m;
}
Material thin_rough_glass() {
    Material m = rough_metal();
    m.metallic_roughness->metallic.value = 0;
    m.metallic_roughness->transmission.value = 1;
    m.index.value = 1.5;
    return m;
}

/// Light is scattered alike in whichever direction a path goes, and each density is known from both
/// sides.
TEST(MappedNormals, PathsOfBothDirectionsAgree) {
    const Material materials[] = {matt({0.8, 0.7, 0.6}), rough_metal(), thin_rough_glass()};
    for (std::size_t m = 0; m < 3; ++m) {
        for (const double tilt : {0.3, 1.0}) {
            SceneMaker maker = tilted_square(materials[m], tilt);
            const Scene scene = maker.compile();
            const Vec3 map{std::sin(tilt), 0, std::cos(tilt)};
            testing::Random random(7);
            int lit = 0, turned = 0;
            for (int i = 0; i < 3000; ++i) {
                const Vec3 to_eye = random.unit_vector(), to_light = random.unit_vector();
                ScatterPoint eye, light;
                set_scatter_point(scene, to_eye, eye);
                set_scatter_point(scene, to_light, light);
                const std::string what = std::to_string(m) + ", " + std::to_string(i);
                const double seen =
                    expect_both_directions_agree(eye, to_eye, light, to_light, what);
                lit += seen > 0;
                turned += seen > 0 && std::copysign(1, to_eye.z) * dot(map, to_eye) < 0;
            }
            EXPECT_GT(lit, 300) << m;
            EXPECT_GT(turned, tilt > 0.5 ? 30 : 3) << m;
        }
    }
}

/// A point light whose side the map is turned away from the eye's: the eye sees the normal turned.
TEST(MappedNormals, RenderersAgreeWhereTheMapFacesAwayFromTheEye) {
    for (const double eye_x : {-4.0, 4.0}) {
        SceneMaker maker = tilted_square(matt({0.8, 0.8, 0.8}), 0.6);
        const Vec3 eye{eye_x, 0.001, 1};
        maker.description().cameras[0].camera =
            look_along(eye, normalize(-eye), {0, 1, 0.1}, 0.08, 1.0);
        PointLight lamp;
        lamp.position = {2, 0, 1.5};
        lamp.color = {3, 3, 3};
        lamp.attenuation = {0, 0, 1};
        maker.light(lamp);
        const Scene scene = maker.compile();
        const double truth = testing::mean_of(testing::picture_of(scene, "path_tracing", 4, 256)).g;
        EXPECT_GT(truth, 0.1);
        for (const char* renderer : {"bidirectional", "vcm:photons=4000"}) {
            const Rgb mean = testing::mean_of(testing::picture_of(scene, renderer, 4, 256));
            EXPECT_NEAR(mean.g, truth, 0.02 * truth) << renderer;
        }
        const Rgb splat = testing::mean_of(testing::picture_of(scene, "light_tracing", 4, 60000));
        EXPECT_NEAR(splat.g, truth, 0.05 * truth) << "light_tracing";
    }
}

/// Light by way of a mirror, which only paths from the light and merging find.
TEST(MappedNormals, LightByWayOfAMirrorIsNotLost) {
    SceneMaker maker = tilted_square(matt({0.8, 0.8, 0.8}), 0.5);
    const Vec3 eye{-4, 0.001, 1};
    maker.description().cameras[0].camera = look_along(eye, normalize(-eye), {0, 1, 0.1}, 0.1, 1.0);
    Material mirror;
    mirror.reflective.color = {1, 1, 1};
    maker.add(testing::rectangle({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}), maker.material(mirror));
    maker.add(testing::rectangle({0.95, -2, 0}, {0, 4, 0}, {0, 0, 1}), maker.material(matt({})));
    maker.add(testing::ball({2, 0, 0.5}, 0.3), maker.material(testing::shining({30, 30, 30})));
    const Scene scene = maker.compile();
    testing::expect_same_light(scene, "mirror", {"path_tracing", "bidirectional", "light_tracing"},
                               800, 4.5);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
