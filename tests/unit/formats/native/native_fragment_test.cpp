#include "alhazen/formats/native/read/native_fragment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/formats/native/read/native_vocabulary.h"
#include "support/same_description.h"
#include "unit/formats/native/native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(NativeFragment, AFileInTwoPartsIsTheSameSceneAsTheWhole) {
    const std::string first =
        "picture { width = 64; height = 32 }\n"
        "material \"red\" { diffuse = (1, 0, 0) }\n"
        "geometry \"tent\" { points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]; faces = [(0, 1, 2)] }\n"
        "object \"post\" { sphere { radius = 2; material = \"red\" } }\n";
    const std::string second =
        "perspective_camera { eye = (0, 0, 5); look_at = (0, 0, 0) }\n"
        "instance \"post\" { transform = translate(1, 2, 3) }\n"
        "mesh \"sail\" { geometry = \"tent\"; material = \"red\" }\n"
        "union { box { }  sphere { material = \"red\" } }\n";
    const Imported whole = import_native(first + second);
    Imported parts = import_native(first);
    read_native_fragment(second, "more", {}, parts.scene, parts.diagnostics);
    EXPECT_EQ(whole.messages(), "");
    EXPECT_EQ(parts.messages(), "");
    expect_same(parts.scene, whole.scene);
}

TEST(NativeFragment, FindingsHaveTheirLine) {
    Imported scene = import_native("sphere { }\n");
    read_native_fragment("box { }\nsphere { radus = 1; material = \"gold\" }\n", "more", {},
                         scene.scene, scene.diagnostics);
    const std::string messages = scene.messages();
    EXPECT_NE(messages.find("more:2:10: error: sphere: unknown key 'radus'"), std::string::npos)
        << messages;
    EXPECT_NE(messages.find("material \"gold\" is not defined"), std::string::npos) << messages;
}

/// The key of a block, or null.
const NativeKey* find_key(const std::vector<NativeBlockType>& types, const std::string& block,
                          const std::string& key) {
    for (const NativeBlockType& type : types) {
        if (type.name != block) continue;
        const auto found = std::find_if(type.keys.begin(), type.keys.end(),
                                        [&](const NativeKey& k) { return k.name == key; });
        return found != type.keys.end() ? &*found : nullptr;
    }
    return nullptr;
}

TEST(NativeVocabulary, KeysKeywordsAndDefaultsAreThoseOfTheReader) {
    const std::vector<NativeBlockType> types = native_vocabulary();
    const NativeKey* radius = find_key(types, "torus", "minor_radius");
    ASSERT_NE(radius, nullptr);
    EXPECT_EQ(radius->unit, "length");
    EXPECT_EQ(radius->usual, "0.25");
    const NativeKey* kind = find_key(types, "environment", "kind");
    ASSERT_NE(kind, nullptr);
    EXPECT_TRUE(kind->required);
    EXPECT_EQ(kind->words, (std::vector<std::string>{"constant", "picture", "sky", "studio"}));
    const NativeKey* file = find_key(types, "environment", "file");
    ASSERT_NE(file, nullptr) << "only one kind has it";
    EXPECT_FALSE(file->required) << "only one kind needs it";
    EXPECT_NE(find_key(types, "instance", "transform"), nullptr);
    EXPECT_NE(find_key(types, "difference", "cut_material"), nullptr);
    EXPECT_EQ(find_key(types, "sphere", "radus"), nullptr);
}

TEST(NativeVocabulary, EveryBlockHasKeysThatItsReaderKnows) {
    for (const NativeBlockType& type : native_vocabulary()) {
        EXPECT_FALSE(type.keys.empty()) << type.name;
        for (const NativeKey& key : type.keys) {
            if (type.name == "environment" && key.name == "file") continue;  // only of one kind
            Imported read =
                import_native(type.name + " \"x\" { " + key.name + " = nothing_known }\n");
            EXPECT_EQ(read.messages().find("unknown key"), std::string::npos) << type.name << "\n"
                                                                              << read.messages();
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
