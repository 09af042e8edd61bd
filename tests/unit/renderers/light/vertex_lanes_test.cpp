// Vertices of path tracing in lanes have the bits of those one by one.

#include "alhazen/renderers/path_tracing/vertex_lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/renderers/core/path_record.h"
#include "alhazen/renderers/path_tracing/plain_meshes.h"
#include "alhazen/renderers/path_tracing/rough_lanes.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/lights/environment.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shapes/meshes/triangle_surface.h"
#include "alhazen/simd/targets.h"
#include "support/light_pictures.h"
#include "support/random.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// A sphere-like mesh, with vertex normals and texture coordinates on request.
TriangleMesh round_mesh(bool smooth, bool mapped) {
    const SphereMesh sphere(2);
    TriangleMesh mesh;
    mesh.positions = sphere.positions;
    mesh.triangles = sphere.triangles;
    if (smooth) mesh.normals = sphere.positions;
    if (mapped) {
        for (const Vec3& p : mesh.positions) mesh.uvs.push_back({p.x + 0.3 * p.z, p.y});
    }
    return mesh;
}

Material metal(double roughness) {
    Material m;
    m.metallic_roughness.emplace();
    m.metallic_roughness->base_color.color = {0.9, 0.7, 0.4};
    m.metallic_roughness->roughness.value = roughness;
    return m;
}
Material plastic(double index) {
    Material m = metal(0.4);
    m.metallic_roughness->metallic.value = 0.0;
    m.index.value = index;
    return m;
}

/// A room of meshes: matt, rough, smooth, of glass; mapped, mirrored, placed twice; lamps of
/// rectangles, triangles and points.
enum class Surroundings { Black, Even, Picture };

Scene room(Surroundings surroundings) {
    SceneMaker maker;
    maker.description().cameras[0].camera = look_along({0, -1, 6.5}, {0, 0, -1}, {0, 1, 0}, 0.9, 1);
    const auto add = [&](TriangleMesh mesh, const Material& m, const Affine& placement = {}) {
        maker.add(maker.mesh(std::move(mesh)), maker.material(m), placement);
    };
    add(rectangle_mesh({-4, -4, -2}, {8, 0, 0}, {0, 8, 0}), matt({0.7, 0.6, 0.5}));
    add(rectangle_mesh({-4, -4, -2}, {0, 8, 0}, {0, 0, 8}), matt({0.6, 0.1, 0.1}));
    add(rectangle_mesh({4, -4, -2}, {0, 0, 8}, {0, 8, 0}), metal(0.35));
    Material shiny = matt({0.3, 0.4, 0.3});
    shiny.specular.color = {0.4, 0.4, 0.4};
    shiny.shininess.value = 20;
    add(rectangle_mesh({-4, 4, -2}, {8, 0, 0}, {0, 0, 8}), shiny);
    Material one_sided = matt({0.2, 0.7, 0.3});
    one_sided.double_sided = false;
    add(rectangle_mesh({-3, -3, 0}, {1, 0, 0}, {0, 0.5, 1}), one_sided);
    Material mirror;
    mirror.reflective.color = {0.8, 0.9, 0.8};
    add(rectangle_mesh({2.5, -2, -1.5}, {0.5, 1, 0}, {0, 0, 2}), mirror);
    // Seen from behind.
    add(rectangle_mesh({-1.5, 1.5, 0.5}, {0, 1.5, 0}, {1.5, 0, 0.5}), matt({0.3, 0.3, 0.9}));

    const auto at = [](const Vec3& place, double size, bool mirrored) {
        Affine a;
        a.linear.x_axis = {mirrored ? -size : size, 0, 0};
        a.linear.y_axis = {0, size, 0.3 * size};
        a.linear.z_axis = {0, 0, size};
        a.translation = place;
        return a;
    };
    add(round_mesh(true, false), matt({0.8, 0.8, 0.2}), at({-2, 1, -1}, 0.9, true));
    add(round_mesh(false, true), plastic(1.6), at({0, 1.5, -0.5}, 0.9, false));
    add(round_mesh(true, true), metal(0.25), at({2, 1, -1}, 0.9, true));
    add(round_mesh(true, false), smooth_glass(), at({0, -1.5, -0.5}, 0.8, false));
    TriangleMesh tinted = round_mesh(true, false);
    for (std::size_t i = 0; i < tinted.positions.size(); ++i) {
        tinted.colors.push_back({0.5f, 0.01f * static_cast<float>(i), 0.3f, 1});
    }
    add(tinted, matt({0.9, 0.9, 0.9}), at({-2, -2, -1}, 0.5, false));
    const ObjectIndex twice = maker.object("twice");
    maker.add(maker.mesh(round_mesh(false, false)), maker.material(matt({0.4, 0.5, 0.9})), {},
              twice);
    maker.add(twice, MaterialId{0}, at({1, -2, -1.2}, 0.4, false));
    maker.add(twice, MaterialId{0}, at({2, -2, -1.2}, 0.4, true));
    maker.add(ball({-1, -0.5, 0.5}, 0.4), maker.material(matt({0.5, 0.5, 0.5})));

    add(rectangle_mesh({-1, 1, 3}, {0, 1, 0}, {1, 0, 0}), shining({9, 8, 7}));
    add(rectangle_mesh({2, 1, 2.5}, {0.4, 1, 0}, {1, 0, 0.3}), shining({5, 7, 9}));
    maker.light(PointLight{.position = {-2, -2, 2}, .color = {3, 3, 3}, .attenuation = {0, 0, 1}});
    Scene scene = maker.compile("wide_bvh");
    if (surroundings == Surroundings::Even) scene.background = {0.3, 0.4, 0.6};
    if (surroundings == Surroundings::Picture) {
        EnvironmentSettings sky;
        sky.kind = EnvironmentKind::Sky;
        scene.environment = std::make_shared<const Environment>(sky, Vec3{0, 1, 0});
    }
    return scene;
}

/// With `one_by_one`, a path is recorded that is not in the picture.
Film picture(const Scene& scene, const std::string& renderer, bool one_by_one, int threads = 1) {
    constexpr int kSide = 24;
    const SamplingPlan plan;
    PathRecord record;
    record.sample = 0xFFFFFFFFu;
    Film film(kSide, kSide, {0, 0, kSide, kSide});
    const RenderJob job{.scene = scene,
                        .camera = scene.cameras[0].camera,
                        .samples_per_pixel = 16,
                        .seed = 3,
                        .sampling = &plan,
                        .path = one_by_one ? &record : nullptr,
                        .control = {.threads = threads, .tile_size = 5 + 4 * threads}};
    EXPECT_TRUE(make_renderer(renderer)->render(job, film).complete());
    return film;
}

TEST(VertexLanes, PicturesHaveTheBitsOfVerticesOneByOne) {
    using enum Surroundings;
    for (const Surroundings surroundings : {Black, Even, Picture}) {
        const Scene scene = room(surroundings);
        const int threads = surroundings == Black ? 1 : 2;
        for (const char* renderer :
             {"path_tracing", "path_tracing:depth=2", "path_tracing:clamp=0.5,roulette=1"}) {
            const Film expected = picture(scene, renderer, true);
            for (const std::string& target : simd_targets()) {
                const SimdTargetOverride forced(target);
                const Film found = picture(scene, renderer, false, threads);
                for (int i = 0; i < found.frame_width() * found.frame_height(); ++i) {
                    const int x = i % found.frame_width(), y = i / found.frame_width();
                    ASSERT_EQ(found.at(x, y), expected.at(x, y))
                        << renderer << " " << target << " " << x << " " << y;
                }
            }
        }
    }
}

/// Triangles in and near planes of coordinates, near and far from the origin.
TEST(VertexLanes, RaysStartWhereThoseOfOneSurfaceDo) {
    Random random(6);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        for (int round = 0; round < 300; ++round) {
            VertexLanes lanes;
            LightCallLanes lights;
            std::vector<ShapeSurface> surfaces;
            for (std::size_t lane = 0; lane < VertexLanes::kMost; ++lane) {
                TriangleMesh mesh;
                const int axis = random.below(4);
                const Vec3 place = random.in_cube(random.log_uniform(1e-3, 1e6));
                for (int i = 0; i < 3; ++i) {
                    Vec3 p = place + random.in_cube(1);
                    if (axis < 3) p[axis] = round % 2 == 0 ? 0.0 : 1e-6;
                    mesh.positions.push_back(p);
                }
                mesh.triangles = {{0, 1, 2}};
                ShapeHit hit;
                hit.u = random.uniform(0, 0.5);
                hit.v = random.uniform(0, 0.5);
                ShapeSurface surface;
                const double reach = set_triangle_surface(mesh, 0, hit, surface);
                const double rounding = kNextTestRounding * reach;
                surface.error += Vec3{rounding, rounding, rounding};
                surfaces.push_back(surface);
                lanes.triangles.set(lane, mesh, 0, hit, false);
                const Vec3 ray = random.unit_vector();
                for (int k = 0; k < 3; ++k) lanes.ray[k][lane] = ray[k];
            }
            lanes.find_frames(VertexLanes::kMost, lights);
            for (std::size_t lane = 0; lane < VertexLanes::kMost; ++lane) {
                const auto of = [&](const VertexLanes::Vectors& v) {
                    return Vec3{v[0][lane], v[1][lane], v[2][lane]};
                };
                ASSERT_EQ(of(lanes.origin), leaving_ray(surfaces[lane], of(lanes.geometric)).origin)
                    << target << " " << round << " " << lane;
            }
        }
    }
}

Vec3 random_above(RandomStream& random) {
    const double z = random.below(5) == 0 ? random.uniform(0, 1e-3) : random.uniform(1e-6, 1);
    const double angle = random.uniform(0, 2 * kPi), radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

Spectrum random_spectrum(RandomStream& random) {
    const double b = random.uniform(0, 1);
    return {random.below(4) == 0 ? 0.0 : random.uniform(0, 1), random.uniform(0, 1), b, b};
}

/// A rough reflection; some are black or brighter than numbers can be.
Bsdf random_rough(RandomStream& random) {
    const double alpha = random.below(4) == 0 ? 1.0 : random.uniform(1e-3, 1);
    const bool brushed = random.below(2) == 0;
    const double angle = random.uniform(0, 2 * kPi);
    const SchlickTerm term{random_spectrum(random),
                           Spectrum::all(random.below(3) == 0 ? random.uniform(0.1, 1) : 1.0)};
    const double weights[] = {1.0, random.uniform(0, 1), 1e308};
    Bsdf bsdf;
    bsdf.add(Spectrum::all(weights[random.below(3)]),
             RoughReflection({brushed ? random.uniform(1e-3, 1) : alpha, alpha}, term,
                             brushed ? Vec2{std::cos(angle), std::sin(angle)} : Vec2{1, 0}));
    return bsdf;
}

TEST(RoughLanes, HaveTheBitsOfBsdfsOneByOne) {
    RandomStream makes(3);
    std::vector<Bsdf> bsdfs;
    std::vector<std::unique_ptr<const RoughLobe>> lobes;
    while (bsdfs.size() < 40) {
        bsdfs.push_back(random_rough(makes));
        lobes.push_back(RoughLobe::of(bsdfs.back()));
        ASSERT_NE(lobes.back(), nullptr);
    }
    constexpr std::size_t kMost = RoughLanes::kMost;
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        RandomStream random(11);
        RoughLanes rough;
        auto v = std::make_unique<VertexLanes>();
        const auto put = [](const auto& of, std::size_t lane, auto& to) {
            for (int k = 0; k < static_cast<int>(std::size(to)); ++k) to[k][lane] = of[k];
        };
        int sampled = 0, absorbed = 0;
        for (int i = 0; i < 3000; ++i) {
            std::array<Vec3, kMost> views, lights, matt;
            std::array<std::size_t, kMost> used;
            std::array<Vec2, kMost> u;
            std::array<double, kMost> choices;
            const auto own = static_cast<std::uint32_t>(random.below(1u << kMost));
            v->lit = static_cast<std::uint32_t>(random.below(1u << kMost));
            v->sampled = (1u << kMost) - 1;
            for (std::size_t lane = 0; lane < kMost; ++lane) {
                views[lane] = random_above(random);
                lights[lane] = random_above(random);
                u[lane] = {random.uniform(0, 1),
                           random.below(20) == 0 ? 0.0 : random.uniform(0, 1)};
                matt[lane] = cosine_direction(u[lane]);
                choices[lane] = random.uniform(0, 1);
                used[lane] = random.below(bsdfs.size());
                put(views[lane], lane, v->view);
                put(lights[lane], lane, v->to_light);
                put(matt[lane], lane, v->next);
                v->u[0][lane] = u[lane].x;
                v->u[1][lane] = u[lane].y;
                v->density[lane] = v->next_density[lane] = 0.5;
                put(Spectrum::all(0.25), lane, v->value);
                put(Spectrum::all(0.75), lane, v->next_weight);
                if ((own >> lane & 1u) != 0) rough.set(lane, *lobes[used[lane]], choices[lane]);
            }
            rough.scatter(*v);
            for (std::size_t lane = 0; lane < kMost; ++lane) {
                const Bsdf& bsdf = bsdfs[used[lane]];
                const bool is_own = (own >> lane & 1u) != 0;
                Spectrum value = Spectrum::all(0.25), weight = Spectrum::all(0.75);
                double density = 0.5, next_density = 0.5;
                Vec3 next = matt[lane];
                const auto expect_same = [&](double found, double expected, const char* what) {
                    EXPECT_EQ(std::bit_cast<std::uint64_t>(found),
                              std::bit_cast<std::uint64_t>(expected))
                        << target << " " << i << " " << lane << " " << what;
                };
                if (is_own) {
                    const auto drawn =
                        bsdf.sample(views[lane], choices[lane], u[lane], Transport::Radiance);
                    ASSERT_EQ((v->sampled >> lane & 1u) != 0, drawn.has_value()) << target << i;
                    ++(drawn ? sampled : absorbed);
                    value =
                        lights[lane].z * bsdf.value(views[lane], lights[lane], Transport::Radiance);
                    density = bsdf.density(views[lane], lights[lane]);
                    if (drawn) {
                        next = drawn->direction;
                        weight = drawn->weight;
                        next_density = drawn->density;
                    }
                }
                for (int k = 0; k < 4 && (!is_own || (v->lit >> lane & 1u) != 0); ++k) {
                    expect_same(v->value[k][lane], value[k], "value");
                    expect_same(v->density[lane], density, "density");
                }
                if ((v->sampled >> lane & 1u) == 0) continue;
                for (int k = 0; k < 4; ++k)
                    expect_same(v->next_weight[k][lane], weight[k], "weight");
                for (int k = 0; k < 3; ++k) expect_same(v->next[k][lane], next[k], "next");
                expect_same(v->next_density[lane], next_density, "next density");
            }
            ASSERT_FALSE(::testing::Test::HasFailure());
        }
        EXPECT_GT(sampled, 5000);
        EXPECT_GT(absorbed, 1000);
    }
    Bsdf other;
    other.add(Spectrum::all(1), Lambert{Spectrum::all(0.5)});
    EXPECT_EQ(RoughLobe::of(other), nullptr);
    EXPECT_EQ(RoughLobe::of(Bsdf()), nullptr);
}

TEST(PlainMeshes, AreThoseWhosePointsScatterAlike) {
    const Scene scene = room(Surroundings::Black);
    PlainMeshes meshes(scene);
    const PrimitiveTable& table = scene.aggregate->primitives();
    std::vector<std::string> kinds;
    for (const PlacedMesh& mesh : table.meshes) {
        Hit hit;
        hit.primitive =
            PrimitiveId{table.first(kTriangleKind) + mesh.first_triangle + std::uint32_t{1}};
        const PlainMeshes::Place place = meshes.find(hit);
        EXPECT_TRUE(place.material == nullptr || place.mesh == &mesh);
        EXPECT_TRUE(place.material == nullptr || place.triangle == 1);
        kinds.push_back(place.material == nullptr ? "no"
                        : place.material->is_matt ? "matt"
                                                  : "yes");
    }
    // Floor, walls, single-sided card, mirror, card from behind, balls, lamps.
    const std::vector<std::string> expected{"matt", "matt", "yes", "yes", "no", "no", "matt",
                                            "matt", "yes",  "yes", "no",  "no", "no", "no"};
    EXPECT_EQ(kinds, expected);
    Hit sphere;
    sphere.primitive = PrimitiveId{0};
    EXPECT_EQ(meshes.find(sphere).material, nullptr);
    Hit inside;
    inside.primitive = PrimitiveId{table.first(kTriangleKind)};
    inside.path.push_back(PrimitiveId{0});
    EXPECT_EQ(meshes.find(inside).material, nullptr);
}

/// Few large meshes among many small ones, so that a block of triangles has one mesh or many.
TEST(PlainMeshes, HoldAllTrianglesOfMeshesOfUnevenSizes) {
    for (const int small : {0, 1, 7, 150}) {
        SceneMaker maker;
        const MaterialId material = maker.material(matt({0.5, 0.5, 0.5}));
        const auto add_small = [&](int count) {
            for (int i = 0; i < count; ++i) {
                maker.add(maker.mesh(rectangle_mesh({0.1 * i, 0, -3}, {0.1, 0, 0}, {0, 1, 0})),
                          material);
            }
        };
        add_small(small);
        for (int i = 0; i < 9; ++i) maker.add(maker.mesh(round_mesh(false, false)), material);
        add_small(small / 2);
        const Scene scene = maker.compile("wide_bvh");
        PlainMeshes meshes(scene);
        const PrimitiveTable& table = scene.aggregate->primitives();
        for (const PlacedMesh& mesh : table.meshes) {
            const auto size = static_cast<std::uint32_t>(mesh.mesh->triangles.size());
            for (std::uint32_t i = 0; i < size; ++i) {
                Hit hit;
                hit.primitive = PrimitiveId{table.first(kTriangleKind) + mesh.first_triangle + i};
                const PlainMeshes::Place place = meshes.find(hit);
                ASSERT_EQ(place.mesh, &mesh) << small << " " << i;
                ASSERT_EQ(place.triangle, i) << small;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
