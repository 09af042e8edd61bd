/// Every .ray file of the collections renders, or is rejected with a message that names what it
/// needs.

#include <gtest/gtest.h>

#include <map>

#include "alhazen/base/error.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Files that need an extension of the format, with its keyword.
const std::map<std::string, std::string> kExtensions{{"csg", "csg"},
                                                     {"hyperbolic", "hyperbolic"},
                                                     {"metaball", "metaball"},
                                                     {"meteorite", "meteorite"},
                                                     {"paraboloid", "paraboloid"},
                                                     {"shapeLight", "shape_light"}};

TEST(RayScenes, RenderOrNameTheExtensionTheyNeed) {
    ALHAZEN_NEEDS_DATA("ray");
    const auto files = testing::files_below("ray", ".ray");
    ASSERT_GT(files.size(), 80u);
    std::size_t rendered = 0;
    for (const auto& file : files) {
        try {
            const LoadedScene loaded = load(file, {});
            RenderOptions options;
            options.height = 24;
            const RenderResult result = render(loaded.scene, loaded.description.picture, options);
            EXPECT_EQ(result.counters.non_finite, 0u) << file;
            ++rendered;
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_EQ(error.kind(), ErrorKind::Scene) << file << ": " << message;
            EXPECT_EQ(message.rfind(file.string() + ":", 0), 0u) << message;
            const auto extension = kExtensions.find(file.stem().string());
            ASSERT_NE(extension, kExtensions.end()) << message;
            EXPECT_NE(message.find("'" + extension->second + "' belongs to an extension"),
                      std::string::npos)
                << message;
        }
    }
    RecordProperty("rendered", std::to_string(rendered));
    EXPECT_EQ(rendered, files.size() - kExtensions.size());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
