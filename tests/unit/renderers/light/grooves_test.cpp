// Grooves at an angle to the tangent, in mirrored coordinates and seen from behind.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "support/light_pictures.h"
#include "support/random.h"
#include "unit/renderers/light/both_directions.h"
#include "unit/renderers/light/scatter_at.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_both_directions_agree;
using testing::expect_close;
using testing::SceneMaker;
using testing::set_scatter_point;

enum class Frame { Tangents, MirroredTangents, Coordinates, MirroredCoordinates };

bool is_mirrored(Frame frame) {
    return frame == Frame::MirroredTangents || frame == Frame::MirroredCoordinates;
}

/// A square of side 2 in the plane z = 0 with the tangent +x and, unless mirrored, the bitangent
/// +y.
TriangleMesh square(Frame frame) {
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (frame == Frame::Coordinates || frame == Frame::MirroredCoordinates) {
        mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        if (is_mirrored(frame)) mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    } else {
        mesh.tangents.assign(4, {1, 0, 0, is_mirrored(frame) ? -1.0f : 1.0f});
    }
    return mesh;
}

Material grooved(double angle, bool is_metal) {
    Material m;
    MetallicRoughness& p = m.metallic_roughness.emplace();
    p.metallic.value = is_metal ? 1 : 0;
    p.transmission.value = is_metal ? 0 : 1;
    p.roughness.value = is_metal ? 0.25 : 0.4;
    p.anisotropy.strength = 0.6;
    p.anisotropy.rotation = angle;
    m.index.value = 1.5;
    return m;
}

Scene scene_of(Frame frame, const Material& material) {
    SceneMaker maker;
    maker.add(maker.mesh(square(frame)), maker.material(material));
    return maker.compile();
}

double value(const Scene& scene, const Vec3& view, const Vec3& light, BsdfCache* known = nullptr) {
    ScatterPoint scatter;
    set_scatter_point(scene, view, scatter, known);
    return scatter.value(light, Transport::Radiance).a;
}

const Frame kFrames[] = {Frame::Tangents, Frame::MirroredTangents, Frame::Coordinates,
                         Frame::MirroredCoordinates};

/// The angle counts from the tangent to the bitangent: mirrored, it is that of the other sense.
TEST(Grooves, TurnFromTheTangentToTheBitangent) {
    const Vec3 view = normalize(Vec3{0.3, 0.5, 0.8}), light = normalize(Vec3{-0.1, -0.45, 0.8});
    const Scene plain = scene_of(Frame::Tangents, grooved(0.5, true));
    const Scene other = scene_of(Frame::Tangents, grooved(-0.5, true));
    const double along = value(plain, view, light), against = value(other, view, light);
    ASSERT_GT(std::abs(along - against), 0.2 * along);
    for (const Frame frame : kFrames) {
        const Scene scene = scene_of(frame, grooved(0.5, true));
        BsdfCache known(scene);
        const std::string what = std::to_string(static_cast<int>(frame));
        expect_close(value(scene, view, light), is_mirrored(frame) ? against : along, what);
        expect_close(value(scene, view, light, &known), is_mirrored(frame) ? against : along, what);
    }
}

/// The grooves are lines of the surface: seen from behind, they are the same lines.
TEST(Grooves, LieAlongTheSameLinesFromBothSides) {
    const auto behind = [](const Vec3& v) { return Vec3{v.x, v.y, -v.z}; };
    for (const Frame frame : kFrames) {
        const Scene scene = scene_of(frame, grooved(0.7, true));
        BsdfCache known(scene);
        testing::Random random(3);
        for (int i = 0; i < 100; ++i) {
            const Vec3 view = random.unit_vector(), light = random.unit_vector();
            const std::string what = std::to_string(i);
            const double front = value(scene, view, light);
            expect_close(value(scene, behind(view), behind(light)), front, what);
            expect_close(value(scene, behind(view), behind(light), &known), front, what);
            expect_close(value(scene, view, light, &known), front, what);
        }
    }
}

TEST(Grooves, OfThinSheetsScatterAlikeInBothDirections) {
    for (const Frame frame : kFrames) {
        const Scene scene = scene_of(frame, grooved(0.7, false));
        testing::Random random(5);
        int through = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec3 to_eye = random.unit_vector(), to_light = random.unit_vector();
            ScatterPoint eye, light;
            set_scatter_point(scene, to_eye, eye);
            set_scatter_point(scene, to_light, light);
            const std::string what = std::to_string(i);
            const double seen = expect_both_directions_agree(eye, to_eye, light, to_light, what);
            through += seen > 1e-3 && to_eye.z * to_light.z < 0;
        }
        EXPECT_GT(through, 50);
    }
}

/// A square whose first set of coordinates has u along +x, the second u along +y.
Scene with_two_sets(bool has_map, int map_set, const UvTransform& transform, int groove_set) {
    TriangleMesh mesh = square(Frame::Coordinates);
    mesh.uvs2 = {{0, 1}, {0, 0}, {1, 0}, {1, 1}};
    SceneMaker maker;
    const auto picture = [&](std::vector<float> texel, int set, const UvTransform& t) {
        ImageTexture texture;
        texture.image =
            std::make_shared<const StoredImage>(StoredImage{1, 1, 3, true, std::move(texel)});
        texture.decode_srgb = false;
        texture.uv_set = set;
        texture.uv_transform = t;
        maker.description().textures.push_back({"", texture, {}});
        return static_cast<TextureId>(maker.description().textures.size() - 1);
    };
    Material m = grooved(0.5, true);
    if (has_map) m.normal_map.texture = picture({0.5f, 0.5f, 1}, map_set, transform);
    if (groove_set >= 0) {
        m.metallic_roughness->anisotropy.texture = picture({1, 0.5f, 1}, groove_set, {});
    }
    maker.add(maker.mesh(mesh), maker.material(m));
    return maker.compile();
}

/// glTF takes missing tangents from the coordinates of the normal map.
TEST(Grooves, WithoutTangentsFollowTheCoordinatesOfTheNormalMap) {
    const Vec3 view = normalize(Vec3{0.3, 0.5, 0.8}), light = normalize(Vec3{-0.1, -0.45, 0.8});
    const auto turned = [](const Vec3& v) { return Vec3{v.y, -v.x, v.z}; };  // +y to +x
    const Scene plain = scene_of(Frame::Tangents, grooved(0.5, true));
    const double along_x = value(plain, view, light);
    const double along_y = value(plain, turned(view), turned(light));
    ASSERT_GT(std::abs(along_x - along_y), 0.2 * along_x);
    const UvTransform quarter{.uu = 0, .uv = 1, .vu = -1, .vv = 0};  // u' = v
    struct Case {
        const char* what;
        bool has_map;
        int map_set;
        UvTransform transform;
        int groove_set;
        double expected;
    };
    for (const Case& c : {Case{"no map", false, 0, {}, -1, along_x},
                          Case{"a map of the first set", true, 0, {}, -1, along_x},
                          Case{"a map of the second set", true, 1, {}, -1, along_y},
                          Case{"a map of the first set, turned", true, 0, quarter, -1, along_y},
                          Case{"grooves of the second set", false, 0, {}, 1, along_x},
                          Case{"grooves of the first set", true, 1, {}, 0, along_y}}) {
        const Scene scene = with_two_sets(c.has_map, c.map_set, c.transform, c.groove_set);
        expect_close(value(scene, view, light), c.expected, c.what);
    }
}

/// Meshes without tangents are candidates for lanes.
TEST(Grooves, AreSeenAlikeByPathsInLanes) {
    for (const bool mirrored : {false, true}) {
        for (const double side : {1.0, -1.0}) {
            double brightness[2];
            for (const bool lanes : {false, true}) {
                const Frame frame = lanes
                                        ? mirrored ? Frame::MirroredCoordinates : Frame::Coordinates
                                    : mirrored ? Frame::MirroredTangents
                                               : Frame::Tangents;
                SceneMaker maker;
                maker.add(maker.mesh(square(frame)), maker.material(grooved(0.5, true)));
                const Vec3 eye = 4 * normalize(Vec3{0.3, 0.5, side * 0.8});
                maker.description().cameras[0].camera =
                    look_along(eye, normalize(-eye), {0, 1, 0.1}, 0.02, 1.0);
                maker.light(DirectionalLight{.to_light = normalize(Vec3{-0.1, -0.45, side * 0.8}),
                                             .color = {1, 1, 1}});
                const Scene scene = maker.compile();
                brightness[lanes] =
                    testing::mean_of(testing::picture_of(scene, "path_tracing", 4, 4)).g;
            }
            EXPECT_GT(brightness[0], 0.01);
            EXPECT_NEAR(brightness[1], brightness[0], 1e-6 * brightness[0]) << mirrored << side;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
