// Rejected glTF files: compares with the verdicts of Khronos' validator on its own test files.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <set>

#include "alhazen/base/file.h"
#include "alhazen/formats/importer_list.h"
#include "golden/scene_files.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

constexpr const char* kFolder = "hostile/gltf-validator/test";

/// Files with a different verdict; docs/reference/formats/gltf_validator.md gives the reasons.
const std::set<std::string> kKnownDifferences = {
    "ext/KHR_materials_anisotropy/data/material/no_tangent_space.gltf",
    "ext/KHR_materials_clearcoat/data/material/no_tangent_space.gltf",
};

/// Returns whether the validator reported an error: a message of severity 0.
bool is_invalid(const std::filesystem::path& report) {
    const nlohmann::json tree = nlohmann::json::parse(read_file(report));
    const nlohmann::json& messages = tree.at("issues").at("messages");
    return std::any_of(messages.begin(), messages.end(), [](const nlohmann::json& message) {
        return message.at("severity").get<int>() == 0;
    });
}

/// Returns the reason why the import fails; empty if it succeeds.
std::string refusal(const std::filesystem::path& file) {
    try {
        Diagnostics diagnostics;
        (void)import_scene(file, {}, diagnostics);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(GltfValidator, EveryVerdictIsTheSameButTheKnownOnes) {
    ALHAZEN_NEEDS_DATA(kFolder);
    const std::filesystem::path root = test_data() / kFolder;
    std::set<std::string> differences;
    int cases = 0;
    for (const std::filesystem::path& report : files_below(kFolder, ".json")) {
        std::filesystem::path file = report;
        file.replace_extension();  // x.gltf.report.json -> x.gltf
        file.replace_extension();
        if (!std::filesystem::is_regular_file(file)) continue;
        ++cases;
        const std::string why = refusal(file);
        const bool invalid = is_invalid(report);
        const std::string name = std::filesystem::relative(file, root).string();
        if (why.empty() == !invalid) continue;
        differences.insert(name);
        EXPECT_EQ(kKnownDifferences.count(name), 1u)
            << name << (invalid ? " is invalid, but was read" : " is valid, but: " + why);
    }
    EXPECT_EQ(cases, 112);
    // A difference that no longer exists must be removed from the list and the table.
    EXPECT_EQ(differences, kKnownDifferences);
}

TEST(GltfValidator, ModelsOfTheSampleCollectionAreNotRefused) {
    ALHAZEN_NEEDS_DATA("gltf");
    int models = 0;
    for (const char* suffix : {".gltf", ".glb"}) {
        for (const std::filesystem::path& file : files_below("gltf", suffix)) {
            const bool draco = file.string().find("glTF-Draco") != std::string::npos;
            const std::string why = refusal(file);
            EXPECT_EQ(why.empty(), !draco) << file << why;
            const bool named = why.find("KHR_draco_mesh_compression") != std::string::npos;
            EXPECT_EQ(named, draco) << file << why;
            ++models;
        }
    }
    EXPECT_GE(models, 70);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
