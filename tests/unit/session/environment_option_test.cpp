#include "alhazen/session/environment_option.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/session/framing/framing.h"
#include "alhazen/shading/lights/environment.h"
#include "support/scene_maker.h"
#include "support/scratch_folder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

LoadedScene loaded_ball() {
    SceneMaker maker;
    maker.add(Sphere{});
    LoadedScene loaded;
    loaded.scene = maker.compile();
    loaded.description = maker.description();
    loaded.description.conventions.importing.headlight = true;
    return loaded;
}

TEST(EnvironmentOption, ASceneWithoutLightGetsTheStudioWhereLightIsFollowed) {
    LoadedScene loaded = loaded_ball();
    EXPECT_TRUE(set_environment(loaded, "", "whitted", {}).empty());
    EXPECT_EQ(loaded.scene.environment, nullptr);
    EXPECT_EQ(set_environment(loaded, "", "path_tracing", {}).size(), 1u);
    ASSERT_NE(loaded.scene.environment, nullptr);
    EXPECT_EQ(loaded.description.environment->settings.kind, EnvironmentKind::Studio);
    EXPECT_TRUE(complete_view(loaded.description, loaded.scene, {.follows_light = true}).empty());
    EXPECT_TRUE(loaded.scene.lights.empty());
    // The others still get a headlight.
    EXPECT_EQ(complete_view(loaded.description, loaded.scene, {}).size(), 1u);
}

/// A point light at the eye would be visible through water for renderers that trace light from it,
/// and for no others.
TEST(EnvironmentOption, ABackgroundIsTheLightOfASceneWithoutWhereLightIsFollowed) {
    for (const char* renderer : {"path_tracing", "bidirectional", "vcm", "sppm"}) {
        LoadedScene loaded = loaded_ball();
        loaded.description.picture.background = loaded.scene.background = Rgb{0.1, 0.2, 0.3};
        EXPECT_TRUE(set_environment(loaded, "", renderer, {}).empty());
        const FramingOptions options{.follows_light = follows_light(renderer)};
        const auto notes = complete_view(loaded.description, loaded.scene, options);
        ASSERT_EQ(notes.size(), 1u);
        EXPECT_NE(notes[0].find("background"), std::string::npos) << notes[0];
        EXPECT_TRUE(loaded.scene.lights.empty());
        EXPECT_EQ(loaded.scene.background, (Rgb{0.1, 0.2, 0.3}));
        // The others get their headlight.
        EXPECT_EQ(complete_view(loaded.description, loaded.scene, {}).size(), 1u);
        EXPECT_EQ(loaded.scene.lights.size(), 1u);
    }
}

TEST(EnvironmentOption, ASceneThatGlowsGetsNothingWhereLightIsFollowed) {
    SceneMaker maker;
    Material lamp;
    lamp.emission.color = {3, 2, 1};
    maker.add(Sphere{}, maker.material(lamp));
    LoadedScene loaded;
    loaded.scene = maker.compile();
    loaded.description = maker.description();
    loaded.description.conventions.importing.headlight = true;
    EXPECT_TRUE(set_environment(loaded, "", "path_tracing", {}).empty());
    EXPECT_TRUE(complete_view(loaded.description, loaded.scene, {.follows_light = true}).empty());
    EXPECT_TRUE(loaded.scene.lights.empty());
    EXPECT_TRUE(loaded.scene.background.is_black());
}

/// Labels and displays of glTF files are white at most; lamps have a strength.
TEST(EnvironmentOption, AGlowUpToWhiteIsNoLightInAFormatWithoutSurroundings) {
    for (const bool surroundings : {false, true}) {
        for (const double radiance : {1.0, 1.5}) {
            SceneMaker maker;
            Material label;
            label.emission.color = {radiance, 0.5, 0};
            maker.add(Sphere{}, maker.material(label));
            LoadedScene loaded;
            loaded.scene = maker.compile();
            loaded.description = maker.description();
            loaded.description.conventions.importing.headlight = true;
            loaded.description.conventions.importing.surroundings = surroundings;
            const bool gets_studio = surroundings && radiance <= 1;
            EXPECT_EQ(set_environment(loaded, "", "path_tracing", {}).size(),
                      gets_studio ? 1u : 0u);
            EXPECT_EQ(loaded.scene.environment != nullptr, gets_studio);
        }
    }
}

TEST(EnvironmentOption, NoneAddsNothing) {
    LoadedScene loaded = loaded_ball();
    EXPECT_TRUE(set_environment(loaded, "none", "path_tracing", {}).empty());
    const FramingOptions none{.follows_light = true, .nothing_around = true};
    EXPECT_TRUE(complete_view(loaded.description, loaded.scene, none).empty());
    EXPECT_TRUE(loaded.scene.lights.empty());
}

TEST(EnvironmentOption, ASceneWithALightKeepsItsOwn) {
    SceneMaker maker;
    maker.add(Sphere{});
    maker.light(PointLight{});
    LoadedScene loaded;
    loaded.scene = maker.compile();
    loaded.description = maker.description();
    EXPECT_TRUE(set_environment(loaded, "", "path_tracing", {}).empty());
    EXPECT_EQ(loaded.scene.environment, nullptr);
    (void)set_environment(loaded, "sky", "path_tracing", {});
    EXPECT_TRUE(loaded.scene.environment->sun().has_value());
    (void)set_environment(loaded, "none", "path_tracing", {});
    EXPECT_EQ(loaded.scene.environment, nullptr);
    EXPECT_FALSE(loaded.description.environment.has_value());
}

TEST(EnvironmentOption, APictureIsReadAndBadTexelsAreTold) {
    ScratchFolder folder;
    Image image(4, 2, 3);
    std::fill(image.samples.begin(), image.samples.end(), 0.5f);
    image.pixel(1, 0)[0] = std::numeric_limits<float>::infinity();
    const auto path = folder.path() / "sky.pfm";
    write_image(path, image);
    LoadedScene loaded = loaded_ball();
    const auto notes = set_environment(loaded, path.string(), "path_tracing", {});
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("1 texels"), std::string::npos);
    EXPECT_NE(notes[0].find("above 1e+15"), std::string::npos);
    EXPECT_NEAR(loaded.scene.environment->radiance({0, -1, 0}).r, 0.5, 1e-6);
}

TEST(EnvironmentOption, WhatCannotBeIsSaid) {
    const auto message = [](const std::string& text, const std::string& renderer) {
        try {
            check_environment(text, renderer);
            return std::string();
        } catch (const Error& error) {
            return std::string(error.what());
        }
    };
    EXPECT_NE(message("sky", "whitted").find("path_tracing"), std::string::npos);
    EXPECT_NE(message("cloudy", "path_tracing").find("studio"), std::string::npos);
    EXPECT_EQ(message("sky", "path_tracing"), "");
    EXPECT_EQ(message("", "whitted"), "");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
