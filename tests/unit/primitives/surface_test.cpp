#include "alhazen/primitives/surface.h"

#include <gtest/gtest.h>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/scene/scene.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

TEST(PrimitiveTable, TheMemoryOfShapesIncludesWhatTheyKeepOutside) {
    const auto bytes_with = [](std::size_t corners) {
        Polygon gear;
        for (std::size_t k = 0; k < corners; ++k) {
            const double turn = 2 * kPi * double(k) / double(corners), r = k % 2 == 0 ? 1 : 0.9;
            gear.vertices.push_back({r * std::cos(turn), r * std::sin(turn), 0});
        }
        SceneMaker maker;
        maker.add(gear);
        return maker.compile().census.scene_bytes;
    };
    const std::uint64_t vertices = 9900 * sizeof(Vec3), cells = 256 * 256 / 4;
    EXPECT_GE(bytes_with(10'000) - bytes_with(100), vertices);
    EXPECT_LE(bytes_with(10'000) - bytes_with(100), 2 * vertices + cells);
}

Vec3 random_direction(RandomStream& random) {
    while (true) {
        const Vec3 d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double l = length_squared(d);
        if (l > 0.01 && l <= 1.0) return d / std::sqrt(l);
    }
}

/// A ray that leaves a convex surface outward must not intersect it again; one that enters must not
/// intersect it at once.
void expect_no_self_intersection(const AnyShape& shape, std::uint64_t seed) {
    RandomStream random(seed);
    for (int round = 0; round < 200; ++round) {
        // Sizes and positions over many magnitudes.
        const double scale = std::pow(10.0, random.uniform(-8, 8));
        const double distance = std::pow(10.0, random.uniform(-8, 8));
        const Affine placement = Affine::translate(distance * random_direction(random)) *
                                 Affine::rotate(random_direction(random), random.uniform(0, 6)) *
                                 Affine::scale({scale, scale * random.uniform(0.5, 2), scale});
        SceneMaker maker;
        std::visit([&](const auto& s) { maker.add(s, MaterialId{0}, placement); }, shape);
        const Scene scene = maker.compile();
        for (int i = 0; i < 50; ++i) {
            const Vec3 target = placement.point(
                {random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
            const Vec3 origin = target + 10 * scale * random_direction(random);
            const Ray ray{origin, normalize(target - origin)};
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            const Vec3 towards_ray =
                dot(ray.direction, surface.normal) < 0 ? surface.normal : -surface.normal;
            Vec3 away = random_direction(random);
            if (dot(away, towards_ray) < 0) away = -away;
            const Ray next = leaving_ray(surface, away);
            EXPECT_FALSE(scene.aggregate->occluded(next, nullptr))
                << "shape " << shape.index() << " round " << round << " ray " << i << " scale "
                << scale << " distance " << distance;
        }
    }
}

TEST(Surface, RaysThatLeaveAConvexShapeDoNotMeetItAgain) {
    expect_no_self_intersection(Sphere{}, 1);
    expect_no_self_intersection(BoxShape{}, 2);
    expect_no_self_intersection(Cylinder{}, 3);
    expect_no_self_intersection(Cone{}, 4);
    expect_no_self_intersection(Rectangle{}, 5);
    expect_no_self_intersection(Disc{}, 6);
    expect_no_self_intersection(Plane{}, 7);
}

TEST(Surface, RaysThatLeaveAFlatShapeNearTheOriginOfCoordinatesDoNotMeetItAgain) {
    RandomStream random(9);
    for (int round = 0; round < 2000; ++round) {
        // A tilted shape through the origin, hit where all coordinates of the point vanish.
        const Affine tilt = Affine::rotate(random_direction(random), random.uniform(0, 6));
        const double size = std::pow(10.0, random.uniform(0, 6));
        const Vec3 u = size * tilt.vector({1, 0, 0});
        const Vec3 v = size * tilt.vector({0, 1, 0});
        SceneMaker maker;
        if (round % 2 == 0) {
            maker.add(Rectangle{.corner = -0.3 * u - 0.6 * v, .edge_u = u, .edge_v = v});
        } else {
            TriangleMesh mesh;
            mesh.positions = {-0.3 * u - 0.3 * v, u - 0.2 * v, v - 0.3 * u};
            mesh.triangles = {{0, 1, 2}};
            maker.add(maker.mesh(mesh));
        }
        const Scene scene = maker.compile();
        const Vec3 target = 1e-14 * random_direction(random);
        const Vec3 from = 3.0 * random_direction(random);
        const Ray ray{target - from, normalize(from)};
        Hit hit;
        if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
        const Surface surface = surface_at(*scene.aggregate, ray, hit);
        for (int i = 0; i < 20; ++i) {
            const Ray next = leaving_ray(surface, random_direction(random));
            EXPECT_FALSE(scene.aggregate->occluded(next, nullptr))
                << "round " << round << " ray " << i;
        }
    }
}

TEST(Surface, RaysThatLeaveAConvexMeshDoNotMeetItAgain) {
    RandomStream random(8);
    for (int round = 0; round < 300; ++round) {
        const double scale = std::pow(10.0, random.uniform(-8, 8));
        const double distance = scale * std::pow(10.0, random.uniform(-3, 5));
        TriangleMesh mesh = testing::tetrahedron();
        mesh.transform(Affine::translate(distance * random_direction(random)) *
                       Affine::rotate(random_direction(random), random.uniform(0, 6)) *
                       Affine::scale({scale, scale, scale * 0.01}));
        Vec3 center;
        for (const Vec3& p : mesh.positions) center += 0.25 * p;
        SceneMaker maker;
        maker.add(maker.mesh(mesh));
        const Scene scene = maker.compile();
        for (int i = 0; i < 50; ++i) {
            const Vec3 d = random_direction(random);
            const Ray ray{center - 3 * scale * d, d};
            Hit hit;
            if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            // Skips hits from inside: in a shape as thin as its own rounding the offset point would
            // lie beyond the far side.
            Vec3 away = random_direction(random);
            if (dot(away, surface.normal) < 0) away = -away;
            if (dot(d, surface.normal) > 0) continue;
            const Ray next = leaving_ray(surface, away);
            EXPECT_FALSE(scene.aggregate->occluded(next, nullptr))
                << "round " << round << " ray " << i << " scale " << scale << " distance "
                << distance;
        }
    }
}

/// The distances of a ray that starts in the plane z = 0 and runs mostly along x round to slightly
/// more than 0, although the plane itself is exact.
TEST(Surface, RaysThatLeaveAFlatMeshThroughTheOriginDoNotMeetItAgain) {
    RandomStream random(47);
    for (const double height : {0.0, 1e-3, 1.0}) {
        TriangleMesh mesh;
        mesh.positions = {
            {-0.5, -0.5, height}, {0.5, -0.5, height}, {0.5, 0.5, height}, {-0.5, 0.5, height}};
        mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
        SceneMaker maker;
        maker.material({});
        maker.add(maker.mesh(mesh));
        const Scene scene = maker.compile();
        for (int i = 0; i < 20000; ++i) {
            Vec3 down = random_direction(random), away = random_direction(random);
            down.z = -std::abs(down.z);
            const Vec3 origin{random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), height + 0.5};
            Hit hit;
            const Ray ray{origin, down};
            if (!scene.aggregate->closest(ray, hit, nullptr)) continue;
            const Ray next = leaving_ray(surface_at(*scene.aggregate, ray, hit), away);
            ASSERT_FALSE(scene.aggregate->occluded(next, nullptr))
                << "height " << height << " ray " << i;
        }
    }
}

TEST(Surface, VertexMaterialsCarryTheBarycentricWeights) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.vertex_materials = {2, 1, 0};
    SceneMaker maker;
    for (int i = 0; i < 3; ++i) maker.material({});
    maker.add(maker.mesh(mesh));
    const Scene scene = maker.compile();
    const Ray ray{{0.25, 0.5, 1}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(scene.aggregate->closest(ray, hit, nullptr));
    const Surface s = surface_at(*scene.aggregate, ray, hit);
    EXPECT_EQ(s.material_count, 3);
    EXPECT_EQ(s.materials[0], MaterialId{2});
    EXPECT_NEAR(s.weights[0], 0.25, 1e-15);
    EXPECT_NEAR(s.weights[1], 0.25, 1e-15);
    EXPECT_NEAR(s.weights[2], 0.5, 1e-15);
}

Material textured() {
    Material m;
    m.diffuse.texture = TextureId{0};
    return m;
}
/// The surface as materials need it, and whole.
struct Surfaces {
    Surface needed, whole;
};
Surfaces surfaces(const Scene& scene, const Ray& ray) {
    Surfaces result;
    Hit hit;
    if (!scene.aggregate->closest(ray, hit, nullptr)) {
        ADD_FAILURE() << "the ray meets nothing";
        return result;
    }
    result.whole = surface_at(*scene.aggregate, ray, hit);
    set_surface(*scene.aggregate, ray, hit, CoordinateNeed::of(scene.reads_coordinates),
                result.needed);
    EXPECT_EQ(result.needed.point, result.whole.point);
    EXPECT_EQ(result.needed.normal, result.whole.normal);
    EXPECT_EQ(result.needed.error, result.whole.error);
    const HitParts parts = parts_of(*scene.aggregate, hit);
    EXPECT_EQ(parts.part, result.whole.part);
    EXPECT_EQ(parts.instance, result.whole.instance);
    return result;
}

TEST(Surface, TextureCoordinatesAreThoseOfMaterialsThatReadThem) {
    SceneMaker maker;
    maker.description().textures.push_back({"", SolidTexture{}, {}});
    const MaterialId plain = maker.material({}), read = maker.material(textured());
    const Affine turned = Affine::rotate({1, 2, 3}, 0.7);
    const ObjectIndex ball = maker.object("ball");
    maker.add(Sphere{{0, 0, 0}, 1}, read, turned, ball);
    maker.add(Sphere{{0, 0, 0}, 1}, plain, Affine::translate({-4, 0, 0}) * turned);
    maker.add(Sphere{{0, 0, 0}, 1}, read, turned);
    maker.add(ball, plain, Affine::translate({4, 0, 0}) * turned);
    const Scene scene = maker.compile();
    ASSERT_EQ(scene.reads_coordinates, (std::vector<std::uint8_t>{0, 1}));
    const auto down = [&](double x) { return surfaces(scene, {{x + 0.3, 0.2, 5}, {0, 0, -1}}); };
    const Surfaces of_plain = down(-4.0), of_read = down(0.0), placed = down(4.0);
    EXPECT_EQ(of_plain.needed.dpdu, Vec3{});
    for (const Surfaces& s : {of_read, placed}) {
        EXPECT_NE(s.whole.dpdu, Vec3{});
        EXPECT_EQ(s.needed.uv, s.whole.uv);
        EXPECT_EQ(s.needed.uv2, s.whole.uv2);
        EXPECT_EQ(s.needed.dpdu, s.whole.dpdu);
        EXPECT_EQ(s.needed.dpdv2, s.whole.dpdv2);
    }
}

TEST(Surface, ASolidThatShowsTheMaterialOfAnotherPartHasCoordinates) {
    // Glass first, a textured liquid in it: the wall is the glass's sphere, and may show the
    // liquid.
    SceneMaker maker;
    maker.description().textures.push_back({"", SolidTexture{}, {}});
    Material glass, liquid = textured();
    glass.transmissive.color = liquid.transmissive.color = {1, 1, 1};
    const MaterialId of_glass = maker.material(glass), of_liquid = maker.material(liquid);
    const ObjectIndex o = maker.object("filled");
    maker.description().objects[static_cast<std::size_t>(o)].combine = Combine::Union;
    maker.add(Sphere{{0, 0, 0}, 1}, of_glass, {}, o);
    maker.add(Sphere{{0, 0, 0}, 2}, of_liquid, {}, o);
    maker.add(o);
    const Scene scene = maker.compile();
    std::vector<Hit> hits;
    const Ray ray{{0.3, 0.2, 5}, {0, 0, -1}};
    scene.aggregate->all_hits(ray, hits, nullptr);
    ASSERT_EQ(hits.size(), 6u);
    for (const Hit& hit : hits) {
        Surface needed;
        set_surface(*scene.aggregate, ray, hit, CoordinateNeed::of(scene.reads_coordinates),
                    needed);
        const Surface whole = surface_at(*scene.aggregate, ray, hit);
        EXPECT_EQ(needed.uv, whole.uv);
        EXPECT_EQ(needed.dpdu, whole.dpdu);
        EXPECT_NE(needed.dpdu, Vec3{});
    }
}

TEST(Surface, GroovesOfPlacedMeshesTurnWithThem) {
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {{0, 0}, {1, 0}, {0.5, 1}};
    SceneMaker maker;
    Material brushed;
    brushed.metallic_roughness.emplace().anisotropy.strength = 0.8;
    const MaterialId m = maker.material(brushed);
    const MeshIndex shared = maker.mesh(mesh);
    const ObjectIndex plate = maker.object("plate");
    maker.add(shared, m, {}, plate);
    maker.add(plate, m, Affine::translate({-3, 0, 0}));
    maker.add(plate, m, Affine::translate({3, 0, 0}) * Affine::rotate({0, 0, 1}, kPi / 2));
    const Scene scene = maker.compile();
    ASSERT_EQ(scene.reads_coordinates, (std::vector<std::uint8_t>{1}));
    const Surfaces straight = surfaces(scene, {{-3, 0, 5}, {0, 0, -1}});
    const Surfaces turned = surfaces(scene, {{3, 0, 5}, {0, 0, -1}});
    EXPECT_NEAR(length(normalize(straight.needed.dpdu) - Vec3{1, 0, 0}), 0.0, 1e-12);
    EXPECT_NEAR(length(normalize(turned.needed.dpdu) - Vec3{0, 1, 0}), 0.0, 1e-12);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
