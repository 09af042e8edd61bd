#include "alhazen/renderers/core/aov.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::tetrahedron;

/// All layers of a picture of `size` pixels squared.
struct Layers {
    FilmLayers layers;
    RayCounters counters;
    Film film;

    Layers(const Scene& scene, int size, int samples = 1, PixelBox crop = {})
        : film(size, size, crop.area() > 0 ? crop : PixelBox{0, 0, size, size}) {
        AovFilm aovs(parse_aovs("all"), film.crop());
        RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
        job.samples_per_pixel = samples;
        job.count_tests = true;
        job.aovs = &aovs;
        Whitted{}.render_tile(job, film.crop(), film, counters);
        layers = aovs.layers();
    }
    [[nodiscard]] double at(const char* channel, int x, int y) const {
        const LayerChannel* found = layers.find(channel);
        if (found == nullptr) throw std::runtime_error(channel);
        const PixelBox& c = film.crop();
        const std::size_t i = static_cast<std::size_t>((y - c.y0) * c.width() + x - c.x0);
        return found->type == SampleType::Uint ? found->whole[i] : double{found->values[i]};
    }
    [[nodiscard]] Vec3 vector(const std::string& name, int x, int y) const {
        return {at((name + ".X").c_str(), x, y), at((name + ".Y").c_str(), x, y),
                at((name + ".Z").c_str(), x, y)};
    }
};

/// A unit square in the plane z = `z`.
TriangleMesh square(double z) {
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return mesh;
}

Material grey(double kd) {
    Material m;
    m.diffuse.color = {kd, 0.5 * kd, 0};
    return m;
}

TEST(Aov, APlaneThatIsParallelToThePictureHasOneDepth) {
    SceneMaker maker;
    maker.add(maker.mesh(square(1)));
    const Layers seen(maker.compile(), 9);  // from (0, 0, 5) along -z, +-20 degrees
    for (int y = 2; y < 7; ++y) {
        for (int x = 2; x < 7; ++x) EXPECT_NEAR(seen.at("depth.Z", x, y), 4.0, 1e-6);
    }
}

TEST(Aov, TheMiddleOfASphereIsAsByHand) {
    SceneMaker maker;
    maker.add(Sphere{}, maker.material(grey(0.8)), Affine::translate({0, 0, 1}));
    const Layers seen(maker.compile(), 3);
    EXPECT_NEAR(seen.at("depth.Z", 1, 1), 3.0, 1e-6);
    EXPECT_NEAR(length(seen.vector("P", 1, 1) - Vec3{0, 0, 2}), 0.0, 1e-6);
    EXPECT_NEAR(length(seen.vector("N", 1, 1) - Vec3{0, 0, 1}), 0.0, 1e-6);
    EXPECT_NEAR(length(seen.vector("Ng", 1, 1) - Vec3{0, 0, 1}), 0.0, 1e-6);
    EXPECT_NEAR(seen.at("albedo.R", 1, 1), 0.8, 1e-3);
    EXPECT_NEAR(seen.at("albedo.G", 1, 1), 0.4, 1e-3);
    EXPECT_EQ(seen.at("A", 1, 1), 1.0);
}

TEST(Aov, TextureCoordinatesRunAcrossTheSquare) {
    SceneMaker maker;
    maker.add(maker.mesh(square(0)));
    maker.description().cameras[0].camera =
        look_along_parallel({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 2.0, 1.0);
    const Layers seen(maker.compile(), 4);
    EXPECT_NEAR(seen.at("uv.U", 0, 0), 0.125, 1e-6);
    EXPECT_NEAR(seen.at("uv.V", 0, 0), 0.875, 1e-6);
    EXPECT_NEAR(seen.at("uv.U", 3, 3), 0.875, 1e-6);
    EXPECT_NEAR(seen.at("depth.Z", 3, 3), 5.0, 1e-6);
}

TEST(Aov, WhereNothingIsDepthIsInfiniteAndAllElseZero) {
    SceneMaker maker;
    maker.add(Sphere{}, MaterialId{0}, Affine::translate({100, 0, 0}));
    const Layers seen(maker.compile(), 1);
    for (const LayerChannel& channel : seen.layers.channels()) {
        if (channel.name.starts_with("count") || channel.name.starts_with("time")) continue;
        const double expected =
            channel.name == "depth.Z" ? std::numeric_limits<double>::infinity() : 0.0;
        EXPECT_EQ(seen.at(channel.name.c_str(), 0, 0), expected) << channel.name;
    }
}

TEST(Aov, IdsTellPartsMaterialsAndInstances) {
    // Object 0 holds parts 0..2; the shared object holds parts 3 and 4.
    SceneMaker maker;
    maker.material({});
    const MaterialId second = maker.material({});
    const ObjectIndex pair = maker.object("pair");
    maker.add(Sphere{}, MaterialId{0}, Affine::translate({-4, 0, 0}));
    maker.add(pair, MaterialId{0}, Affine::translate({0, 1, 0}));
    maker.add(pair, MaterialId{0}, Affine::translate({0, -1, 0}));
    maker.add(Sphere{.radius = 0.4}, MaterialId{0}, {}, pair);
    maker.add(Sphere{.radius = 0.4}, second, Affine::translate({1, 0, 0}), pair);
    maker.description().cameras[0].camera =
        look_along_parallel({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 4.0, 1.0);
    const Scene scene = maker.compile("wide_bvh");
    const Layers seen(scene, 4);  // pixel centres at -1.5, -0.5, 0.5, 1.5
    const auto ids = [&](double wx, double wy) {
        AovFilm aovs(parse_aovs("id"), {0, 0, 1, 1});
        RenderJob job{.scene = scene,
                      .camera = look_along_parallel({wx, wy, 5}, {0, 0, -1}, {0, 1, 0}, 0.1, 1.0)};
        job.aovs = &aovs;
        Film film(1, 1, {0, 0, 1, 1});
        RayCounters counters;
        Whitted{}.render_tile(job, {0, 0, 1, 1}, film, counters);
        const auto id = [&](const char* name) { return aovs.layers().find(name)->whole[0]; };
        return std::array<std::uint32_t, 3>{id("id.object"), id("id.material"), id("id.instance")};
    };
    using Ids = std::array<std::uint32_t, 3>;
    EXPECT_EQ(ids(-4, 0), (Ids{1, 1, 1}));
    EXPECT_EQ(ids(0, 1), (Ids{4, 1, 2}));
    EXPECT_EQ(ids(1, 1), (Ids{5, 2, 2}));
    EXPECT_EQ(ids(0, -1), (Ids{4, 1, 3}));
    EXPECT_EQ(ids(1, -1), (Ids{5, 2, 3}));
    EXPECT_EQ(ids(3, 3), (Ids{0, 0, 0}));
}

TEST(Aov, AMeshSharedByPartsKeepsTheNumberOfEachPart) {
    // More triangles than are copied: the compiler makes instances by itself.
    TriangleMesh many;
    for (int i = 0; i < 40; ++i) {
        const TriangleMesh one = square(-0.01 * i);
        const auto first = static_cast<std::uint32_t>(many.positions.size());
        many.positions.insert(many.positions.end(), one.positions.begin(), one.positions.end());
        for (const auto& t : one.triangles) {
            many.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        }
    }
    SceneMaker maker;
    const MeshIndex mesh = maker.mesh(many);
    maker.add(mesh, MaterialId{0}, Affine::translate({-1, 0, 0}));
    maker.add(mesh, MaterialId{0}, Affine::translate({1, 0, 0}));
    maker.description().cameras[0].camera =
        look_along_parallel({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 2.0, 1.0);
    const Layers seen(maker.compile(), 2);
    EXPECT_EQ(seen.at("id.object", 0, 0), 1);
    EXPECT_EQ(seen.at("id.object", 1, 0), 2);
    EXPECT_EQ(seen.at("id.instance", 0, 0), 1);
    EXPECT_EQ(seen.at("id.instance", 1, 0), 2);
}

TEST(Aov, CountsOfThePixelsAddUpToThoseOfThePicture) {
    SceneMaker maker;
    Material mirror;
    mirror.reflective.color = {0.9, 0.9, 0.9};
    maker.add(Sphere{}, maker.material(mirror));
    maker.add(maker.mesh(tetrahedron()), MaterialId{0}, Affine::translate({1, 1, 0}));
    maker.light(PointLight{.position = {3, 3, 5}});
    const Layers seen(maker.compile("wide_bvh"), 16, 4);
    const auto sum = [&](const char* name) {
        double total = 0;
        for (const float v : seen.layers.find(name)->values) total += v;
        return static_cast<std::uint64_t>(total);
    };
    EXPECT_GT(seen.counters.total_cast(), 16u * 16u * 4u);
    EXPECT_EQ(sum("count.rays"), seen.counters.total_cast());
    EXPECT_EQ(sum("count.node_visits"), seen.counters.tests.node_visits);
    EXPECT_EQ(sum("count.box_tests"), seen.counters.tests.box_tests);
    EXPECT_GT(sum("count.box_tests"), 0u);
    EXPECT_EQ(sum("count.primitive_tests"), seen.counters.tests.primitive_tests);
    EXPECT_EQ(seen.counters.aov_rays, 16u * 16u * 4u);
    for (const float t : seen.layers.find("time.seconds")->values) EXPECT_GT(t, 0.0f);
}

TEST(Aov, LayersChangeNeitherThePictureNorItsCounts) {
    SceneMaker maker;
    maker.add(Sphere{}, maker.material(grey(0.5)));
    maker.light(PointLight{.position = {3, 3, 5}});
    const Scene scene = maker.compile("wide_bvh");
    const Layers with(scene, 12, 3);
    Film film(12, 12, {0, 0, 12, 12});
    RayCounters counters;
    RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    job.samples_per_pixel = 3;
    job.count_tests = true;
    Whitted{}.render_tile(job, {0, 0, 12, 12}, film, counters);
    EXPECT_EQ(film.to_image().samples, with.film.to_image().samples);
    EXPECT_EQ(counters.total_cast(), with.counters.total_cast());
    EXPECT_EQ(counters.tests.node_visits, with.counters.tests.node_visits);
}

TEST(Aov, ACropHasTheNumbersOfTheWhole) {
    SceneMaker maker;
    maker.add(Sphere{}, maker.material(grey(0.5)));
    const Scene scene = maker.compile("wide_bvh");
    const Layers whole(scene, 16, 5);
    const Layers part(scene, 16, 5, {3, 5, 11, 9});
    for (const LayerChannel& channel : part.layers.channels()) {
        if (channel.name == "time.seconds") continue;
        for (int y = 5; y < 9; ++y) {
            for (int x = 3; x < 11; ++x) {
                EXPECT_EQ(part.at(channel.name.c_str(), x, y), whole.at(channel.name.c_str(), x, y))
                    << channel.name;
            }
        }
    }
}

TEST(Aov, SeveralSamplesGiveTheMeanOverThoseThatHit) {
    // Half of the pixel sees the square, whatever the number of samples: its depth is not mixed
    // with the background.
    SceneMaker maker;
    maker.add(maker.mesh(square(0)), MaterialId{0}, Affine::translate({1, 0, 0}));
    maker.description().cameras[0].camera =
        look_along_parallel({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 1.0, 1.0);
    const Layers seen(maker.compile(), 1, 64);
    EXPECT_NEAR(seen.at("A", 0, 0), 0.5, 0.1);
    EXPECT_NEAR(seen.at("depth.Z", 0, 0), 5.0, 1e-6);
    EXPECT_NEAR(length(seen.vector("N", 0, 0)), 1.0, 1e-6);
}

TEST(Aov, UnknownNamesAreAnsweredWithTheKnownOnes) {
    EXPECT_TRUE(parse_aovs("depth,N").has(AovKind::Normal));
    EXPECT_FALSE(parse_aovs("depth,N").has(AovKind::GeometricNormal));
    EXPECT_TRUE(parse_aovs("count").has(AovKind::NodeVisits));
    EXPECT_FALSE(parse_aovs("count,time").has_geometry());
    EXPECT_TRUE(parse_aovs("id.instance").has_geometry());
    for (const char* list : {"", "depht", "depth,", ",N", "c", "id."}) {
        try {
            (void)parse_aovs(list);
            ADD_FAILURE() << list;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            EXPECT_NE(std::string(error.what()).find("id.material"), std::string::npos);
        }
    }
}

TEST(Aov, TheTableIsInTheOrderOfItsKinds) {
    for (std::size_t i = 0; i < aov_table().size(); ++i) {
        EXPECT_EQ(static_cast<std::size_t>(aov_table()[i].kind), i);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
