// Surfaces of triangles in lanes of coordinates have the bits of TriangleMesh::surface.

#include "alhazen/shapes/meshes/triangle_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "alhazen/shapes/meshes/triangle_lanes.h"
#include "alhazen/simd/targets.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same_bits(const Vec3& a, const Vec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}
bool same_bits(const ShapeSurface& a, const ShapeSurface& b) {
    return same_bits(a.point, b.point) && same_bits(a.normal, b.normal) &&
           same_bits(a.shading_normal, b.shading_normal) && same_bits(a.uv.x, b.uv.x) &&
           same_bits(a.uv.y, b.uv.y) && same_bits(a.dpdu, b.dpdu) && same_bits(a.dpdv, b.dpdv) &&
           same_bits(a.error, b.error);
}

/// Triangles of any form; some are degenerate, tiny, or axis-aligned.
TriangleMesh any_triangles(Random& random, bool with_normals, bool with_uvs) {
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 600; ++i) {
        Vec3 p = random.in_cube(3.0);
        if (random.below(9) == 0) p = random.on_lattice(2.0, 0.5);
        if (i > 0 && random.below(30) == 0) p = mesh.positions.back();
        if (random.below(30) == 0) p = 1e-130 * p;
        mesh.positions.push_back(p);
        if (with_normals) {
            const double size = random.below(9) == 0 ? 0.0 : random.uniform(0.1, 2.0);
            mesh.normals.push_back(size * random.unit_vector());
        }
        if (with_uvs) {
            const Vec2 uv{random.uniform(-2, 2), random.uniform(-2, 2)};
            mesh.uvs.push_back(i > 0 && random.below(9) == 0 ? mesh.uvs.back() : uv);
        }
        if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
    }
    return mesh;
}

TEST(TriangleSurface, InLanesHasTheBitsOfOneByOne) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(17);
        for (int form = 0; form < 4; ++form) {
            const TriangleMesh mesh = any_triangles(random, (form & 1) != 0, (form & 2) != 0);
            for (std::size_t i = 0; i < 20 * mesh.triangles.size(); ++i) {
                const std::size_t triangle = i % mesh.triangles.size();
                ShapeHit hit;
                hit.u = random.below(9) == 0 ? 0.0 : random.uniform();
                hit.v = (1.0 - hit.u) * random.uniform();
                const ShapeSurface expected = mesh.surface(triangle, hit);
                double farthest = 0.0;
                for (const std::uint32_t corner : mesh.triangles[triangle]) {
                    const Vec3 away = abs(mesh.positions[corner] - expected.point);
                    farthest = std::max(farthest, max_component(away));
                }
                ShapeSurface found;
                const double reach = set_triangle_surface(mesh, triangle, hit, found);
                ASSERT_TRUE(same_bits(found, expected)) << target << " " << form << " " << i;
                ASSERT_EQ(reach, farthest) << target << " " << form << " " << i;
            }
        }
    }
}

Vec3 vector_of(const TriangleLanes::Vectors& of, std::size_t lane) {
    return {of[0][lane], of[1][lane], of[2][lane]};
}

TEST(TriangleSurface, EightInLanesHaveTheBitsOfOneByOne) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(23);
        std::array<TriangleMesh, 4> meshes;
        for (int form = 0; form < 4; ++form) {
            meshes[static_cast<std::size_t>(form)] =
                any_triangles(random, (form & 1) != 0, (form & 2) != 0);
        }
        TriangleLanes lanes;
        for (int batch = 0; batch < 3000; ++batch) {
            std::array<ShapeSurface, TriangleLanes::kMost> expected;
            // Some lanes stay empty.
            lanes.clear();
            const auto count = static_cast<std::size_t>(1 + random.below(TriangleLanes::kMost));
            for (std::size_t lane = 0; lane < count; ++lane) {
                const TriangleMesh& mesh = meshes[static_cast<std::size_t>(random.below(4))];
                const auto triangle = static_cast<std::size_t>(random.below(200));
                ShapeHit hit;
                hit.u = random.below(9) == 0 ? 0.0 : random.uniform();
                hit.v = (1.0 - hit.u) * random.uniform();
                const bool mirrored = random.coin();
                lanes.set(lane, mesh, triangle, hit, mirrored);
                ShapeSurface& surface = expected[lane];
                const double reach = set_triangle_surface(mesh, triangle, hit, surface);
                const double rounding = kNextTestRounding * reach;
                surface.error += Vec3{rounding, rounding, rounding};
                if (!mirrored) continue;
                surface.normal = -surface.normal;
                if (mesh.normals.empty()) surface.shading_normal = surface.normal;
            }
            lanes.find_surfaces(count);
            for (std::size_t lane = 0; lane < count; ++lane) {
                const ShapeSurface& s = expected[lane];
                ASSERT_TRUE(same_bits(vector_of(lanes.point, lane), s.point)) << target;
                ASSERT_TRUE(same_bits(vector_of(lanes.error, lane), s.error)) << target;
                ASSERT_TRUE(same_bits(vector_of(lanes.normal, lane), s.normal)) << target;
                ASSERT_TRUE(same_bits(vector_of(lanes.shading_normal, lane), s.shading_normal))
                    << target;
                ASSERT_TRUE(same_bits(vector_of(lanes.dpdu, lane), s.dpdu)) << target;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
