// Diagonals that readers draw into polygons are no edges of other polygons.
#include <gtest/gtest.h>

#include "alhazen/shapes/meshes/mesh_edges.h"
#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

/// Both sides of a bent square, each begun at a corner of the same diagonal.
const char* const kPillows[][2] = {
    {"pillow.obj", "v 0 0 1\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\nf 3 2 1 4\n"},
    {"pillow.ply",
     "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
     "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
     "0 0 1\n1 0 0\n1 1 1\n0 1 0\n4 0 1 2 3\n4 2 1 0 3\n"},
    {"pillow.nff",
     "v\nfrom 0 0 -8\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0\nresolution 200 100\n"
     "f 1 1 1 1 0 20 0 0\np 4\n0 0 1\n1 0 0\n1 1 1\n0 1 0\np 4\n1 1 1\n1 0 0\n0 0 1\n0 1 0\n"},
};

TEST(FreeDiagonals, NoEdgeOfFourTrianglesIsMadeByAReader) {
    for (const auto& [path, text] : kPillows) {
        Diagnostics found;
        const SceneDescription scene = import_text(text, path, found);
        ASSERT_EQ(found.error_count(), 0u) << path << text_of(found);
        ASSERT_EQ(scene.meshes.size(), 1u) << path;
        const MeshEdges edges = mesh_edges(*scene.meshes[0].mesh);
        EXPECT_EQ(edges.crowded, 0u) << path;
        EXPECT_TRUE(edges.oriented()) << path << ": " << edges.description();
        EXPECT_EQ(edges.count, 6u) << path;
    }
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
