#include <gtest/gtest.h>

#include "alhazen/formats/native/write/native_writer.h"
#include "native_scene.h"
#include "support/same_description.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_native;
using testing::Imported;

const ObjectDescription& object_of(const Imported& i, const Part& part) {
    return i.scene.objects.at(static_cast<std::size_t>(std::get<ObjectIndex>(part.what)));
}

constexpr const char* kBracket = R"(
material "steel" { diffuse = 0.5 }
material "brass" { diffuse = (0.6, 0.5, 0.2) }
difference "bracket" {
    transform = translate(1, 2, 3)
    material = "steel"
    cut_material = minuend
    union { box { } sphere { center = (0.5, 0, 0); radius = 0.3 } }
    group { transform = translate(0, 0, 1); cylinder { radius = 0.1; material = "brass" } }
    intersection { sphere { } box { } }
}
)";

TEST(NativeSolids, OperatorsNestAndPassTheirMaterialOn) {
    const Imported i = import_native(kBracket);
    EXPECT_EQ(i.messages(), "");
    ASSERT_EQ(i.parts().size(), 1u);
    const Part& part = i.parts()[0];
    EXPECT_EQ(part.name, "bracket");
    EXPECT_EQ(part.object_from_part.translation, (Vec3{1, 2, 3}));
    const ObjectDescription& bracket = object_of(i, part);
    EXPECT_EQ(bracket.combine, Combine::Difference);
    EXPECT_EQ(bracket.cut_material, CutMaterial::Minuend);
    ASSERT_EQ(bracket.parts.size(), 3u);
    EXPECT_EQ(object_of(i, bracket.parts[0]).combine, Combine::Union);
    EXPECT_EQ(object_of(i, bracket.parts[0]).parts.at(1).material, MaterialId{0});
    EXPECT_EQ(bracket.parts[1].material, MaterialId{1});
    EXPECT_EQ(bracket.parts[1].object_from_part.translation, (Vec3{0, 0, 1}));
    EXPECT_EQ(object_of(i, bracket.parts[2]).combine, Combine::Intersection);
}

TEST(NativeSolids, AnObjectMayCombineItsPartsWhereverItIsPlaced) {
    const Imported i = import_native(R"(
object "lens" { combine = intersection; sphere { center = (0, 0, 0.7) } sphere { center = (0, 0, -0.7) } }
instance "lens";
instance "lens" { transform = translate(2, 0, 0) }
)");
    EXPECT_EQ(i.messages(), "");
    EXPECT_EQ(object_of(i, i.parts().at(1)).combine, Combine::Intersection);
}

TEST(NativeSolids, WhatCannotBeOneIsAnErrorWithItsPlace) {
    const auto messages = [](const char* text) {
        const Imported i = import_native(text);
        Diagnostics diagnostics;
        validate(i.scene, diagnostics);
        std::string all = i.messages();
        for (const Diagnostic& d : diagnostics.all()) all += to_string(d) + "\n";
        return all;
    };
    EXPECT_NE(messages("union { plane { } }").find("2:9: error: plane bounds no volume"),
              std::string::npos)
        << messages("union { plane { } }");
    EXPECT_NE(messages("difference { }").find("has no parts"), std::string::npos);
    EXPECT_NE(messages("union { cut_material = own; box { } }").find("cut_material"),
              std::string::npos);
    EXPECT_NE(messages("difference { box { } cut_material = other }").find("own, minuend"),
              std::string::npos);
    EXPECT_NE(messages("object \"o\" { combine = sum; box { } }").find("group, union"),
              std::string::npos);
    EXPECT_NE(messages("union;").find("expected a block"), std::string::npos);
    EXPECT_EQ(messages("union { }"), "");
}

TEST(NativeSolids, ComeBackFromTheWriterAsTheyWere) {
    Imported i = import_native(std::string(kBracket) + R"(
object "lens" { combine = intersection; sphere { } box { } }
instance "lens"; instance "lens" { transform = translate(2, 0, 0) }
)");
    const auto round_trip = [](const SceneDescription& scene) {
        const std::string text =
            native_scene_text(scene, "files", [](const auto& name, auto) { return name; });
        const Imported back =
            testing::import_text<NativeImporter>(text, "scene.alhazen", ImportOptions{});
        EXPECT_EQ(back.messages(), "") << text;
        testing::expect_same(scene, back.scene);
    };
    round_trip(i.scene);
    // The scene itself may be a solid.
    i.scene.objects[0].combine = Combine::Difference;
    i.scene.objects[0].cut_material = CutMaterial::Minuend;
    round_trip(i.scene);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
