// Crossings of patches: against shapes that are the same surface, closed meshes crossed evenly,
// halves of a patch, degenerate patches, models.

#include <gtest/gtest.h>

#include <chrono>

#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/patches/bezier_patch.h"
#include "alhazen/shapes/patches/patch_mesh.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "closed_patches.h"
#include "patch_models.h"
#include "support/any_ray.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::cases;
using testing::Random;

std::vector<ShapeHit> all_hits(const auto& shape, const Ray& ray) {
    ShapeHits hits;
    append_hits(shape, ray, hits);
    return {hits.begin(), hits.end()};
}

/// The same crossings, except for lines that are nearly tangent.
template <class Exact>
void expect_same_crossings(const Exact& exact, const PatchMesh& patches, Random& random) {
    int compared = 0;
    for (int i = 0; i < cases(4000, 20000); ++i) {
        Ray ray = testing::any_ray(exact.box(), random);
        const double scale = length(ray.direction);
        // Both lists without limits: a crossing at a limit may be on either side.
        ray.t_min = -kInfinity;
        ray.t_max = kInfinity;
        const auto expected = all_hits(exact, ray), found = all_hits(patches, ray);
        EXPECT_EQ(found.size() % 2, 0u) << i;
        bool tangent = false;
        const auto look = [&](const auto& shape, const std::vector<ShapeHit>& hits) {
            for (const ShapeHit& hit : hits) {
                const Vec3 normal = shape.surface(ray, hit).normal;
                tangent = tangent || std::abs(dot(normal, ray.direction)) < 1e-3 * scale;
            }
        };
        look(exact, expected);
        look(patches, found);
        if (tangent) continue;
        ASSERT_EQ(found.size(), expected.size()) << i;
        const double far = length(ray.origin) + 1.0;
        for (std::size_t k = 0; k < found.size(); ++k) {
            EXPECT_NEAR(found[k].t * scale, expected[k].t * scale, 1e-12 * far) << i;
            const Vec3 a = patches.surface(ray, found[k]).point;
            const Vec3 b = exact.surface(ray, expected[k]).point;
            EXPECT_LT(length(a - b), 1e-12 * far) << i;
            const Vec3 n = patches.surface(ray, found[k]).normal;
            EXPECT_GT(dot(n, exact.surface(ray, expected[k]).normal), 1.0 - 1e-9) << i;
        }
        compared += static_cast<int>(found.size());
    }
    EXPECT_GT(compared, cases(400, 2000));
}

TEST(PatchCrossings, OfAnExactTorusAreThoseOfTheTorus) {
    Torus torus;
    torus.major_radius = 1.0;
    torus.minor_radius = 0.4;
    torus.prepare();
    const PatchMesh patches = testing::torus_of_patches(1.0, 0.4);
    EXPECT_TRUE(patches.closed());
    Random random(1);
    expect_same_crossings(torus, patches, random);
}

TEST(PatchCrossings, OfAnExactSphereAreThoseOfTheSphere) {
    const PatchMesh patches = testing::sphere_of_patches();
    EXPECT_TRUE(patches.closed());
    Random random(2);
    expect_same_crossings(Sphere{}, patches, random);
}

void expect_even(const PatchMesh& mesh, Random& random, int lines) {
    ASSERT_TRUE(mesh.closed());
    for (int i = 0; i < lines; ++i) {
        const Ray ray = testing::hard_line(mesh, random);
        const auto hits = all_hits(mesh, ray);
        EXPECT_EQ(hits.size() % 2, 0u) << i;
        for (std::size_t k = 1; k < hits.size(); ++k) EXPECT_LE(hits[k - 1].t, hits[k].t);
        // Rays from either end see the same.
        ShapeHit first;
        EXPECT_EQ(find_first_hit(mesh, ray, first), !hits.empty());
        if (!hits.empty()) {
            EXPECT_TRUE(testing::same_bits(first, hits.front()));
        }
    }
}

TEST(PatchCrossings, ClosedMeshesAreCrossedEvenly) {
    Random random(3);
    expect_even(testing::torus_of_patches(1.0, 0.4), random, cases(1000, 4000));
    expect_even(testing::sphere_of_patches(), random, cases(1000, 4000));
    for (const double change : {0.0, 0.1, 0.4}) {
        expect_even(testing::random_closed_patches(random, change), random, cases(500, 2000));
    }
}

// A circle of latitude, an inner border of its patch, seen edge-on: it turns where the line is.
TEST(PatchCrossings, OfALineTangentToAnInnerBorderAreCountedInTime) {
    const PatchMesh torus = testing::torus_of_patches(1.0, 0.4);
    const Ray ray{{-0x1.355280edb201bp-1, -0x1.412bd056e3849p+2, 0x1.d683c630d5122p-5},
                  {-0.0, 0x1.a7562c0e80722p+1, -0.0},
                  -kInfinity,
                  kInfinity};
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(all_hits(torus, ray).size(), 4u);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(PatchCrossings, NormalsOfClosedMeshesPointOutward) {
    PatchMesh mesh = testing::sphere_of_patches();
    // Patches turned at random: their points in the other order of u.
    Random random(7);
    for (std::size_t patch = 0; patch < mesh.patch_count(); ++patch) {
        if (random.coin()) continue;
        std::uint32_t* points = &mesh.patches[9 * patch];
        for (int j = 0; j < 3; ++j) std::swap(points[j], points[6 + j]);
    }
    mesh.prepare();
    ASSERT_TRUE(mesh.closed());
    for (int i = 0; i < 1000; ++i) {
        const Ray ray{2.0 * random.unit_vector(), random.unit_vector(), -kInfinity, kInfinity};
        for (const ShapeHit& hit : all_hits(mesh, ray)) {
            const ShapeSurface surface = mesh.surface(ray, hit);
            EXPECT_GT(dot(surface.normal, surface.point), 0.999);
        }
    }
}

TEST(PatchCrossings, OfHalvesAreThoseOfTheWhole) {
    Random random(4);
    for (int round = 0; round < cases(6, 20); ++round) {
        std::vector<Vec3> points;
        const int n = 1 + random.below(7), m = 1 + random.below(7);
        std::vector<double> weights;
        for (int k = 0; k < (n + 1) * (m + 1); ++k) {
            const double i = static_cast<double>(k / (m + 1)) / n, j = 1.0 * (k % (m + 1)) / m;
            points.push_back(Vec3{i, j, 0.0} + 0.5 * random.in_cube(1.0));
            weights.push_back(round % 2 == 0 ? 1.0 : random.log_uniform(0.3, 3));
        }
        const BezierNet net = bezier_net(n, m, points, weights);
        const PatchTree whole({{.net = net}});
        const auto [low, high] = round % 3 == 0 ? halved_v(net) : halved_u(net);
        const PatchTree halves({{.net = low, .part = 0}, {.net = high, .part = 1}});
        for (int i = 0; i < 1000; ++i) {
            const Vec3 target = point_at(net, random.uniform(), random.uniform());
            const Vec3 direction = random.unit_vector();
            const Ray ray{target - 3.0 * direction, direction, -kInfinity, kInfinity};
            ShapeHits a, b;
            whole.intersect(ray, a);
            halves.intersect(ray, b);
            bool tangent = false;
            for (const ShapeHit& hit : a) {
                const Vec3 normal = whole.surface(ray, hit).normal;
                tangent = tangent || std::abs(dot(normal, direction)) < 1e-3;
            }
            if (tangent) continue;
            ASSERT_EQ(a.size(), b.size()) << round << " " << i;
            for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k].t, b[k].t, 1e-12);
        }
    }
}

TEST(PatchCrossings, OfPatchesWithoutAreaEnd) {
    // Points, lines and planes seen edge-on, with lines along them.
    const std::vector<std::vector<Vec3>> patches{
        std::vector<Vec3>(16, Vec3{1, 2, 3}),
        [] {
            std::vector<Vec3> line;
            for (int k = 0; k < 16; ++k) line.push_back({0.1 * k, 0, 0});
            return line;
        }(),
        [] {
            std::vector<Vec3> plane;
            for (int k = 0; k < 16; ++k) plane.push_back({1.0 * (k / 4), 1.0 * (k % 4), 0});
            return plane;
        }()};
    Random random(5);
    for (const std::vector<Vec3>& points : patches) {
        BezierPatch patch;
        patch.points = points;
        patch.prepare();
        for (int i = 0; i < 200; ++i) {
            const Vec3 from = random.on_lattice(3, 0.5);
            all_hits(patch, {from, random.lattice_direction(), -kInfinity, kInfinity});
            all_hits(patch, {from, points[5] - from + 1e-9 * random.in_cube(1), 0, 2});
        }
    }
}

TEST(PatchCrossings, ModelsHaveTheirMeasuresAndFitIntoFourKilobytesAPatch) {
    ALHAZEN_NEEDS_DATA("patches/teapot.bpt");
    const struct {
        const char* name;
        double volume, area;
    } models[] = {{"teapot.bpt", -25.9298127534, 52.88330309},
                  {"teacup_sjbaker.bpt", 0.22532172992, 9.981697616}};
    for (const auto& [name, volume, area] : models) {
        const auto nets = testing::patch_model(name);
        PatchMeasures sum;
        for (const BezierNet& net : nets) {
            const PatchMeasures part = measures_of(net);
            sum.area += part.area;
            sum.flux_volume += part.flux_volume;
        }
        EXPECT_NEAR(sum.flux_volume, volume, 1e-9);
        EXPECT_NEAR(sum.area, area, 1e-8);  // as many digits as are known
        EXPECT_LE(testing::patch_tree(nets).bytes(), 4096 * nets.size());
    }
}

/// The rounding of a leaf's middle grows with the shape: no division of a patch below it helps.
TEST(PatchCrossings, PatchesTinyBesideTheirShapeAreOneLeafEach) {
    const BezierNet curved = testing::cusp_patch();
    std::vector<Vec3> flat;
    for (int k = 0; k < 16; ++k) flat.push_back({k / 4 / 3.0, k % 4 * 1.0, 0.0});
    const BezierNet plane = bezier_net(3, 3, flat);
    for (Vec3& p : flat) p = 1e9 * p + Vec3{1e9, 0, 0};
    const BezierNet far = bezier_net(3, 3, flat);
    const auto bytes = [](const std::vector<BezierNet>& nets) {
        return testing::patch_tree(nets).bytes();
    };
    EXPECT_GT(bytes({curved, curved}), bytes({plane, plane}));
    EXPECT_EQ(bytes({curved, far}), bytes({plane, far}));
    const PatchTree tree = testing::patch_tree(std::vector{curved, far});
    Random random(7);
    for (int i = 0; i < 100; ++i) {
        const double z = random.uniform(0.1, 0.6);
        ShapeHit hit;
        ASSERT_TRUE(tree.first_hit({{-5, random.uniform(0.5, 2.5), z}, {1, 0, 0}}, hit)) << i;
        // The rounding of a projection in this shape: see `PatchLine::tiny`.
        EXPECT_NEAR(hit.t, 5.0 + testing::cusp_x(z), 0x1p-45 * 4e9) << i;
    }
}

/// Area and flux volume by lines that are spread evenly over a sphere around the model.
TEST(PatchCrossings, AreaOfTheTeapotByLinesIsItsArea) {
    ALHAZEN_NEEDS_DATA("patches/teapot.bpt");
    const PatchTree tree = testing::patch_tree(testing::patch_model("teapot.bpt"));
    const Vec3 center = tree.box().center();
    const double radius = 0.51 * length(tree.box().size());
    Random random(6);
    const int lines = cases(15000, 60000);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < lines; ++i) {
        const Vec3 direction = random.unit_vector(), x = perpendicular(direction);
        const Vec3 y = cross(direction, x);
        const double r = radius * std::sqrt(random.uniform()), a = random.uniform(0, 2 * kPi);
        const Vec3 origin = center + (r * std::cos(a)) * x + (r * std::sin(a)) * y;
        ShapeHits hits;
        tree.intersect({origin, direction, -kInfinity, kInfinity}, hits);
        // Cauchy: the mean number of crossings is half of the area over that of the disc.
        const double area = 2.0 * kPi * radius * radius * static_cast<double>(hits.size());
        sum += area;
        squares += area * area;
    }
    const double mean = sum / lines;
    const double error = std::sqrt((squares / lines - mean * mean) / lines);
    EXPECT_NEAR(mean, 52.88330309, 4.0 * error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
