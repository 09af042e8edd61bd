/// Every .ray file of the collections renders, or is refused with a message that names what it
/// needs.

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "scene_files.h"

namespace alhazen {
namespace {

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
            const bool says_why = message.find("extension") != std::string::npos ||
                                  message.find("not supported") != std::string::npos ||
                                  message.find("cannot") != std::string::npos ||
                                  message.find("expected") != std::string::npos;
            EXPECT_TRUE(says_why) << message;
        }
    }
    RecordProperty("rendered", std::to_string(rendered));
    EXPECT_GE(rendered, 70u) << "of " << files.size();
}

}  // namespace
}  // namespace alhazen
