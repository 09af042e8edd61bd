/// The .ray scenes of three universities.

#include <gtest/gtest.h>

#include "ray_scene.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_ray_file;
using testing::Imported;
using testing::material_of;

/// Scenes that need an extension, and the name that the message must contain.
const std::pair<const char*, const char*> kRefused[] = {
    {"csg.ray", "constructive solid geometry"},
    {"hyperbolic.ray", "hyperbolic"},
    {"metaball.ray", "metaballs"},
    {"meteorite.ray", "particle"},
    {"paraboloid.ray", "paraboloids"},
    {"shapeLight.ray", "lights cut to a shape"},
};

TEST(RayImporter, ReadsTheScenesOfThreeUniversities) {
    ALHAZEN_NEEDS_DATA("ray/ut_austin");
    ALHAZEN_NEEDS_DATA("ray/hkust");
    int read = 0, refused = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(testing::test_data() / "ray")) {
        if (entry.path().extension() != ".ray") continue;
        const Imported i = import_ray_file(entry.path());
        const std::string name = entry.path().filename().string();
        const auto* expected = std::find_if(std::begin(kRefused), std::end(kRefused),
                                            [&](const auto& r) { return r.first == name; });
        if (expected != std::end(kRefused)) {
            ++refused;
            EXPECT_GE(i.errors(), 1u) << entry.path();
            EXPECT_TRUE(i.says(expected->second)) << i.messages();
            continue;
        }
        ++read;
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        EXPECT_EQ(i.scene.cameras.size(), 1u) << entry.path();
        EXPECT_TRUE(!i.parts().empty() || name == "blank.ray") << entry.path();
    }
    EXPECT_EQ(read, 82);
    EXPECT_EQ(refused, 6);
}

TEST(RayImporter, CountsWhatIsInKnownScenes) {
    ALHAZEN_NEEDS_DATA("ray/ut_austin/assets/scenes/polymesh/dragon.ray");
    const auto scenes = testing::test_data() / "ray/ut_austin/assets/scenes";
    const Imported dragon = import_ray_file(scenes / "polymesh/dragon.ray");
    EXPECT_EQ(dragon.scene.meshes.at(0).mesh->triangles.size(), 10'000u);
    const Imported map = import_ray_file(scenes / "simple/texture_map_png.ray");
    ASSERT_EQ(map.scene.textures.size(), 1u);
    EXPECT_EQ(material_of(map, 0).diffuse.texture, TextureId{0});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
