// Loading for rendering moves the meshes out of the description; the image must not change.

#include <gtest/gtest.h>

#include "alhazen/session/framing/framing.h"
#include "alhazen/session/render.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;
using testing::tetrahedron;

TEST(CompileTakingMeshes, OnlyMovesWhatIsPlacedOnceAndGivesTheSamePicture) {
    SceneMaker maker;
    maker.description().cameras.clear();
    const Affine turned = Affine::rotate({1, 2, 3}, 0.5);
    const MeshIndex once = maker.mesh(tetrahedron());
    const MeshIndex twice = maker.mesh(tetrahedron());
    const MeshIndex unmoved = maker.mesh(tetrahedron());
    const MeshIndex shared = maker.mesh(tetrahedron());
    maker.add(once, MaterialId{0}, turned);
    maker.add(twice, MaterialId{0}, Affine::translate({3, 0, 0}));
    maker.add(twice, MaterialId{0}, Affine::translate({0, 3, 0}));
    maker.add(unmoved);
    maker.add(shared, MaterialId{0}, Affine::translate({0, 0, 3}));
    const Scene kept = maker.compile("wide_bvh");

    SceneDescription& d = maker.description();
    const std::shared_ptr<TriangleMesh> held = d.meshes[3].mesh;
    Scene taken = compile_without_geometry(d);
    build_aggregate_taking_meshes(d, {}, taken);
    EXPECT_EQ(d.meshes[0].mesh, nullptr);
    EXPECT_NE(d.meshes[1].mesh, nullptr);
    EXPECT_NE(d.meshes[2].mesh, nullptr);
    EXPECT_EQ(d.meshes[3].mesh, held) << "somebody else holds it";
    EXPECT_EQ(held->positions, tetrahedron().positions);

    const auto picture = [&](Scene scene) {
        SceneDescription view;
        (void)complete_view(view, scene, {});
        RenderOptions options;
        options.width = 40;
        options.height = 30;
        return render(scene, {}, options).film.to_image().samples;
    };
    EXPECT_EQ(picture(kept), picture(taken));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
