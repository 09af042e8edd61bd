#include "alhazen/session/shutter.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/session/load.h"
#include "support/scratch_folder.h"
#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

/// Two triangles; the second, "leaf", has the scale 1 at 0 s and `scale` along x at 1 s.
std::string scaled_leaf(double scale) {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    const int times = t.floats("SCALAR", {0, 1});
    const int scales = t.floats("VEC3", {1, 1, 1, scale, 1, 1});
    const auto n = [](int i) { return std::to_string(i); };
    return t.file(R"("scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "stem", "mesh": 0}, {"name": "leaf", "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": )" +
                  n(p) + R"(}}]}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "scale"}}],
                        "samplers": [{"input": )" +
                  n(times) + R"(, "output": )" + n(scales) + R"(}]}])");
}

LoadedScene load_open(const ScratchFolder& folder, double scale) {
    LoadOptions options;
    options.shutter = Shutter{0, 1};
    return load(folder.write("leaf.gltf", scaled_leaf(scale)), options);
}

TEST(OpenShutter, NodesThatGrowMove) {
    const ScratchFolder folder;
    const LoadedScene loaded = load_open(folder, 3);
    int moving = 0;
    for (const ObjectDescription& object : loaded.description.objects) {
        for (const Part& part : object.parts) moving += part.motion != nullptr;
    }
    EXPECT_EQ(moving, 1);
}

TEST(OpenShutter, ANodeThatVanishesIsNamed) {
    const ScratchFolder folder;
    try {
        (void)load_open(folder, 0);
        FAIL() << "a scale of 0 was accepted";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Scene);
        EXPECT_NE(std::string(error.what()).find("'leaf"), std::string::npos) << error.what();
    }
}

TEST(OpenShutter, ANodeThatIsMirroredIsRefused) {
    const ScratchFolder folder;
    EXPECT_THROW((void)load_open(folder, -1), Error);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
