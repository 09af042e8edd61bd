#include "alhazen/session/scene_info/mesh_figures.h"

#include <gtest/gtest.h>

#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::tetrahedron;

std::vector<MeshFigures> own_figures(const SceneDescription& description) {
    std::vector<MeshFigures> figures;
    for (const MeshDescription& mesh : description.meshes) {
        figures.push_back(figures_of(*mesh.mesh, true));
    }
    return figures;
}

TEST(MeshFigures, ATetrahedronIsClosedAndAsLargeAsByHand) {
    TriangleMesh mesh = tetrahedron();
    mesh.positions.push_back({9, 9, 9});
    const MeshFigures f = figures_of(mesh, true);
    EXPECT_EQ(f.triangles, 4u);
    EXPECT_EQ(f.vertices, 5u);
    EXPECT_EQ(f.unused_vertices, 1u);
    EXPECT_NEAR(f.area, 8 * std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(f.volume, 8.0 / 3.0, 1e-12);
    EXPECT_TRUE(f.edges->closed());
    EXPECT_FALSE(figures_of(mesh, false).edges.has_value());
    mesh.triangles.pop_back();
    EXPECT_FALSE(figures_of(mesh, true).edges->closed());
}

TEST(MeshFigures, PlacementsScaleThemThroughInstances) {
    SceneMaker maker;
    const MeshIndex mesh = maker.mesh(tetrahedron());
    const ObjectIndex inner = maker.object("inner");
    maker.add(mesh, MaterialId{0}, Affine::scale({2, 2, 2}), inner);
    maker.add(inner, MaterialId{0}, Affine::rotate({1, 2, 3}, 0.7) * Affine::scale({3, 3, 3}));
    maker.add(inner, MaterialId{0}, Affine::scale({-1, 1, 1}));
    const auto placed = placed_figures(maker.description(), own_figures(maker.description()));
    ASSERT_TRUE(placed.has_value());
    EXPECT_NEAR(placed->area, 8 * std::sqrt(3.0) * (36 + 4), 1e-9);
    EXPECT_NEAR(placed->volume, 8.0 / 3.0 * (216 + 8), 1e-9) << "mirrored, the outside stays out";
}

TEST(MeshFigures, UnevenScalingIsMeasuredTriangleByTriangle) {
    const Affine stretch = Affine::rotate({1, 1, 0}, 0.3) * Affine::scale({1, 2, 5});
    SceneMaker maker;
    const MeshIndex mesh = maker.mesh(tetrahedron());
    const ObjectIndex inner = maker.object("inner");
    maker.add(mesh, MaterialId{0}, Affine::rotate({0, 1, 0}, 1.0), inner);
    maker.add(inner, MaterialId{0}, stretch);
    const auto placed = placed_figures(maker.description(), own_figures(maker.description()));
    TriangleMesh copy = tetrahedron();
    copy.transform(stretch * Affine::rotate({0, 1, 0}, 1.0));
    ASSERT_TRUE(placed.has_value());
    EXPECT_NEAR(placed->area, area(copy), 1e-9);
    EXPECT_NEAR(placed->volume, signed_volume(copy), 1e-9);
}

TEST(MeshFigures, NestedUnevenScalingsEndInNoAnswerInsteadOfNever) {
    // Each level doubles the number of placements: 2^30 in total.
    SceneMaker maker;
    const MeshIndex mesh = maker.mesh(tetrahedron());
    ObjectIndex below = maker.object("leaf");
    maker.add(mesh, MaterialId{0}, {}, below);
    for (int level = 0; level < 29; ++level) {
        const ObjectIndex next = maker.object("level");
        maker.add(below, MaterialId{0}, Affine::scale({1, 1.01, 1}), next);
        maker.add(below, MaterialId{0}, Affine::scale({1, 1, 1.01}), next);
        below = next;
    }
    maker.add(below);
    EXPECT_FALSE(placed_figures(maker.description(), own_figures(maker.description())).has_value());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
