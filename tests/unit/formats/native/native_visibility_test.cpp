// `visible_to` of the native format.

#include <gtest/gtest.h>

#include "alhazen/formats/native/read/native_visibility.h"
#include "alhazen/formats/native/write/native_writer.h"
#include "native_scene.h"
#include "support/same_description.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_native;
using testing::Imported;

constexpr RayMask kEye = mask_of(RayKind::Eye), kShadow = mask_of(RayKind::Shadow),
                  kReflection = mask_of(RayKind::Reflection),
                  kRefraction = mask_of(RayKind::Refraction);

TEST(NativeVisibility, OfEveryKindOfPartIsRead) {
    const Imported i = import_native(R"(
        sphere { }
        sphere { visible_to = all }
        sphere { visible_to = none }
        plane { visible_to = shadow }
        sphere { visible_to = (eye, shadow, reflection, refraction) }
        mesh { points = [(0,0,0), (1,0,0), (0,1,0)]; faces = [(0,1,2)]; visible_to = [eye] }
        object "ball" { sphere { visible_to = (reflection, refraction) } }
        instance "ball" { visible_to = (shadow, eye) }
        instance "ball")");
    ASSERT_EQ(i.messages(), "");
    const RayMask expected[] = {kAllRays, kAllRays,       0,       kShadow, kRaysOfAllKinds,
                                kEye,     kEye | kShadow, kAllRays};
    ASSERT_EQ(i.parts().size(), std::size(expected));
    for (std::size_t n = 0; n < std::size(expected); ++n) {
        EXPECT_EQ(i.parts()[n].visible_to, expected[n]) << "part " << n;
    }
    EXPECT_EQ(i.scene.objects[1].parts[0].visible_to, kReflection | kRefraction);
}

TEST(NativeVisibility, OfGroupsHoldsForAllTheirPartsToo) {
    const Imported i = import_native(R"(
        object "ball" { sphere { } }
        group { visible_to = (eye, shadow)
            sphere { }
            sphere { visible_to = (shadow, reflection) }
            group { visible_to = shadow
                instance "ball"
                instance "ball" { visible_to = eye }
                object "other" { sphere { } }
            }
        }
        sphere { })");
    ASSERT_EQ(i.messages(), "");
    const RayMask expected[] = {kEye | kShadow, kShadow, kShadow, 0, kAllRays};
    ASSERT_EQ(i.parts().size(), std::size(expected));
    for (std::size_t n = 0; n < std::size(expected); ++n) {
        EXPECT_EQ(i.parts()[n].visible_to, expected[n]) << "part " << n;
    }
    EXPECT_EQ(i.scene.objects[2].parts[0].visible_to, kAllRays) << "a definition is not a part";
}

TEST(NativeVisibility, OfNoKindOfRayIsAnErrorWithItsPlace) {
    EXPECT_EQ(import_native("sphere { visible_to = camera }").messages(),
              "scene.alhazen:2:23: error: visible_to: expected all, none or a list of eye, shadow, "
              "reflection, refraction, found 'camera'\n");
    EXPECT_EQ(import_native("sphere { visible_to = (eye, 3) }").messages(),
              "scene.alhazen:2:29: error: visible_to: expected one of eye, shadow, reflection, "
              "refraction, found a number\n");
    EXPECT_NE(import_native("sphere { visible_to = \"eye\" }").messages(), "");
    EXPECT_NE(import_native("sphere { visible_to = (all) }").messages(), "");
    EXPECT_NE(import_native("material \"m\" { visible_to = all }").messages(), "");
    EXPECT_NE(import_native("geometry \"g\" { visible_to = all }").messages(), "");
}

TEST(NativeVisibility, IsWrittenSoThatItReadsBack) {
    SceneDescription scene = import_native(R"(
        object "ball" { sphere { visible_to = reflection } }
        instance "ball" { visible_to = (shadow, eye) }
        instance "ball")")
                                 .scene;
    for (RayMask mask = 0; mask <= kRaysOfAllKinds; ++mask) {
        Part part = scene.objects[1].parts[0];
        part.visible_to = mask;
        scene.objects[0].parts.push_back(part);
    }
    const std::string text =
        native_scene_text(scene, "files", [](const auto& name, auto) { return name; });
    const Imported read = testing::import_text<NativeImporter>(text, "scene.alhazen");
    ASSERT_EQ(read.messages(), "");
    testing::expect_same(scene, read.scene);
    EXPECT_NE(text.find("visible_to = [eye, shadow]"), std::string::npos) << text;
    EXPECT_EQ(text.find("visible_to = all"), std::string::npos) << text;
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
