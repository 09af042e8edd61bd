/// Texture coordinates and normals of the shapes of the course.

#include <gtest/gtest.h>

#include "alhazen/imaging/codecs/image_io.h"
#include "support/image_texture.h"
#include "unit/formats/import_text.h"
#include "unit/formats/uw_yaml/uw_yaml_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::course_scene;
using testing::expect_point;
using testing::import_text;
using testing::shape_of;
using testing::text_of;

TEST(UwYaml, ATexelLiesAtItsCornerInRowsFromTheTopAndTheCubeHasTheCoursesFaces) {
    const testing::TemporaryFolder folder;
    Image picture(2, 2, 3);
    const std::array<float, 12> samples{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1};
    picture.samples.assign(samples.begin(), samples.end());
    std::filesystem::create_directories(folder.path() / "assets");
    write_image(folder.path() / "assets/four.png", picture);
    std::string text = course_scene("        TriangleMesh: {Material: Red One, Mesh: Cube}\n");
    const std::string plain = "B: 5e-05, A: 1}, Color Map: \"\", Use Texture: false";
    text.replace(text.find(plain), plain.size(),
                 "B: 5e-05, A: 1}, Color Map: four, Use Texture: true");
    text = "Textures: {four: {Path: assets/four.png, Bilinear: true}}\n" + text;
    Diagnostics found;
    const SceneDescription scene = import_text(text, folder.write("assets/a.yaml", text), found);
    ASSERT_EQ(text_of(found), "");

    ASSERT_EQ(scene.textures.size(), 1u);
    const ImageTexture& texture = testing::image_texture(scene.textures[0]);
    const auto at = [&](double u, double v) {
        const Rgba c = evaluate(texture, texture.uv_transform.apply({u, v}));
        return Vec3{c.r, c.g, c.b};
    };
    expect_point(at(0, 0), {0, 0, 0});
    expect_point(at(0.5, 0), {1, 0, 0});
    expect_point(at(0, 0.5), {0, 1, 0});
    expect_point(at(1.5, -0.5), {1, 1, 1});
    expect_point(at(0.25, 0), {0.5, 0, 0});
    expect_point(at(0.75, 0), {0.5, 0, 0});  // repeated

    ASSERT_EQ(scene.meshes.size(), 1u);
    const TriangleMesh& cube = *scene.meshes[0].mesh;
    ASSERT_EQ(cube.triangles.size(), 12u);
    EXPECT_TRUE(cube.closed());
    for (const auto& [a, b, c] : cube.triangles) {
        const Vec3 normal = cross(cube.positions[b] - cube.positions[a],  // outward
                                  cube.positions[c] - cube.positions[a]);
        for (const std::uint32_t i : {a, b, c}) {
            const Vec3 p = cube.positions[i];
            EXPECT_NEAR(dot(normal, p), 0.5, 1e-15);
            Vec2 uv{0.5 + p.x, 0.5 + p.y};  // front
            if (normal.y > 0.5) uv.y = 0.5 - p.z;
            if (normal.y < -0.5) uv.y = 0.5 + p.z;
            if (normal.x > 0.5) uv.x = 0.5 - p.z;
            if (normal.x < -0.5) uv.x = 0.5 + p.z;
            if (normal.z < -0.5) uv.x = 0.5 - p.x;
            EXPECT_EQ(cube.uvs[i], uv);
        }
    }
}

TEST(UwYaml, ASphereHasTheCoordinatesOfTheCoursesExportedSpheres) {
    Diagnostics found;
    const SceneDescription scene =
        import_text(course_scene("        Sphere: {Material: Red One}\n"), "a.yaml", found);
    ASSERT_EQ(scene.objects[0].parts.size(), 1u) << text_of(found);
    const Affine& world_from_sphere = scene.objects[0].parts[0].object_from_part;
    const Affine sphere_from_world = inverse(world_from_sphere);
    const Sphere& sphere = shape_of<Sphere>(scene, 0);
    const auto uv_at = [&](const Vec3& p) {
        const Ray ray{sphere_from_world.point(2.0 * p), sphere_from_world.vector(-1.0 * p)};
        ShapeHit hits[Sphere::kMaxHits];
        EXPECT_EQ(sphere.intersect(ray, hits), 2);
        return sphere.surface(ray, hits[0]).uv;
    };
    // Vertices 13, 17 and 58 of poly-sphere.ply.
    const Vec2 a = uv_at({-0.0908178, 0.475528, -0.125});
    EXPECT_NEAR(a.x, 0.1, 1e-5);
    EXPECT_NEAR(a.y, 0.1, 1e-5);
    const Vec2 b = uv_at({0, 0.475528, 0.154508});
    EXPECT_NEAR(b.x, 0.5, 1e-5);
    EXPECT_NEAR(b.y, 0.1, 1e-5);
    const Vec2 c = uv_at({-0.279508, 0.154508, -0.38471});
    EXPECT_NEAR(c.x, 0.1, 1e-5);
    EXPECT_NEAR(c.y, 0.4, 1e-5);
}

TEST(UwYaml, AMeshWithoutNormalsIsSmoothByAreaAndPosition) {
    const testing::TemporaryFolder folder;
    // A roof: the ridge is shared by a large and a small slope. Once with shared vertices, once
    // with vertices repeated for every triangle.
    const std::string corners = "v 0 0 0\nv 0 0 1\nv 2 -2 0\nv -1 -1 0\n";
    folder.write("assets/shared.obj", corners + "f 1 2 3\nf 1 4 2\n");
    folder.write("assets/repeated.ply",
                 "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                 "end_header\n0 0 0\n0 0 1\n2 -2 0\n0 0 0\n-1 -1 0\n-0 0 1\n3 0 1 2\n3 3 4 5\n");
    folder.write("assets/own.obj", corners + "vn 0 0 1\nf 1//1 2//1 3//1\nf 1//1 4//1 2//1\n");
    const auto normals_of = [&](const std::string& file) {
        const std::string text =
            "Meshes: {one: {Path: assets/" + file + "}}\n" +
            course_scene("        TriangleMesh: {Material: Red One, Mesh: one}\n");
        Diagnostics found;
        const SceneDescription scene =
            import_text(text, folder.write("assets/a.yaml", text), found);
        EXPECT_EQ(text_of(found), "");
        return scene.meshes.at(0).mesh->normals;
    };
    const Vec3 ridge = normalize(Vec3{2, 2, 0} + Vec3{-1, 1, 0});
    const std::vector<Vec3> shared = normals_of("shared.obj");
    ASSERT_EQ(shared.size(), 4u);
    expect_point(shared[0], ridge);
    expect_point(shared[1], ridge);
    expect_point(shared[2], normalize(Vec3{1, 1, 0}));
    expect_point(shared[3], normalize(Vec3{-1, 1, 0}));
    const std::vector<Vec3> repeated = normals_of("repeated.ply");
    ASSERT_EQ(repeated.size(), 6u);
    for (const int i : {0, 1, 3, 5}) expect_point(repeated[std::size_t(i)], ridge);
    expect_point(repeated[2], shared[2]);
    expect_point(repeated[4], shared[3]);
    for (const Vec3& normal : normals_of("own.obj")) expect_point(normal, {0, 0, 1});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
