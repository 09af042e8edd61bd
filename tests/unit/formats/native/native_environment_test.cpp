#include <gtest/gtest.h>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/imaging/image/image.h"
#include "alhazen/shading/lights/ies_profile.h"
#include "support/scratch_folder.h"
#include "unit/formats/native/native_round_trip.h"
#include "unit/formats/native/native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(NativeEnvironment, IsReadWithItsDefaults) {
    const Imported sky = import_native(
        "environment { kind = sky; turbidity = 5; to_sun = (1, 2, 3); rotation_deg = 90 }\n"
        "sphere { center = (0, 0, 0); radius = 1 }\n");
    EXPECT_EQ(sky.messages(), "");
    ASSERT_TRUE(sky.scene.environment.has_value());
    const EnvironmentSettings& e = sky.scene.environment->settings;
    EXPECT_EQ(e.kind, EnvironmentKind::Sky);
    EXPECT_EQ(e.turbidity, 5.0);
    EXPECT_EQ(*e.to_sun, (Vec3{1, 2, 3}));
    EXPECT_NEAR(e.rotation, 1.5707963267948966, 1e-15);
    EXPECT_FALSE(e.up.has_value());
    EXPECT_EQ(e.scale, 1.0);
}

TEST(NativeEnvironment, WhatIsWrongIsSaid) {
    const auto messages = [](const std::string& block) {
        Imported read = import_native(block + "\nsphere { center = (0, 0, 0); radius = 1 }\n");
        validate(read.scene, read.diagnostics);
        return read.messages();
    };
    const auto says = [&](const std::string& block, const std::string& word) {
        const std::string text = messages(block);
        EXPECT_NE(text.find(word), std::string::npos) << block << "\n" << text;
    };
    says("environment { turbidity = 3 }", "kind");
    says("environment { kind = sunny }", "studio");
    says("environment { kind = picture }", "file");
    says("environment { kind = picture; file = \"none.hdr\" }", "none.hdr");
    says("environment { kind = sky; turbidity = 30 }", "turbidity");
    says("environment { kind = sky; to_sun = (0, 0, 0) }", "to_sun");
    says("environment { kind = constant; color = (-1, 0, 0) }", "color");
    says("environment { kind = constant; scale = -1 }", "scale");
    says("environment { kind = sky; ground = 2 }", "ground");
    says("environment { kind = studio }\nenvironment { kind = sky }", "one environment");
    says("environment { kind = studio; sun = 3 }", "sun");
    says("environment { kind = sky; rotation_deg = 1; rotation_rad = 1 }", "exclude each other");
}

TEST(NativeEnvironment, KeysOfOtherKindsAreUnknown) {
    const auto messages = [](const std::string& keys) {
        return import_native("environment { " + keys + " }\nsphere { radius = 1 }\n").messages();
    };
    const char* const turns[] = {"rotation_deg = 1", "rotation_rad = 1", "up = (0, 0, 1)"};
    const char* const of_sky[] = {"turbidity = 3", "to_sun = (1, 0, 0)", "ground = 0.5"};
    for (const std::string kind : {"constant", "picture", "sky", "studio"}) {
        const std::string head = "kind = " + kind + "; color = 2; scale = 3; ";
        const auto is_unknown = [&](const std::string& key) {
            const std::string name = key.substr(0, key.find(' '));
            return messages(head + key).find("unknown key '" + name + "'") != std::string::npos;
        };
        for (const char* key : turns) EXPECT_EQ(is_unknown(key), kind == "constant") << kind << key;
        for (const char* key : of_sky) EXPECT_EQ(is_unknown(key), kind != "sky") << kind << key;
        EXPECT_EQ(is_unknown("file = \"a.hdr\""), kind != "picture") << kind;
    }
    // Without a kind no key is unknown.
    EXPECT_EQ(messages("turbidity = 3; file = \"a.hdr\"").find("unknown"), std::string::npos);
}

TEST(NativeEnvironment, RoundTripKeepsEveryBit) {
    Numbers n(5);
    for (const EnvironmentKind kind : {EnvironmentKind::Constant, EnvironmentKind::Picture,
                                       EnvironmentKind::Sky, EnvironmentKind::Studio}) {
        SceneDescription scene = empty_scene();
        EnvironmentSettings settings;
        settings.kind = kind;
        settings.color = n.color();
        settings.scale = n.positive();
        if (kind != EnvironmentKind::Constant) {
            settings.rotation = n.any();
            settings.up = n.point();
        }
        if (kind == EnvironmentKind::Sky) {
            settings.to_sun = n.point();
            settings.turbidity = 1.0 + 0.5 * n.positive();
            settings.ground = 0.05 * n.color();
        }
        if (kind == EnvironmentKind::Picture) {
            Image image(3, 2, 3);
            for (float& sample : image.samples) sample = static_cast<float>(n.positive());
            settings.picture = std::make_shared<const Image>(image);
        }
        scene.environment = EnvironmentDescription{settings, {}};
        expect_round_trip(scene);
    }
}

/// Straight alpha does not darken the colours, which an environment takes as they are; the coding
/// that the block has no key for is undone.
TEST(NativeEnvironment, PicturesOfOtherThanCodesAreWrittenLinear) {
    for (const bool linear : {false, true}) {
        SceneDescription scene = empty_scene();
        EnvironmentSettings settings;
        settings.kind = EnvironmentKind::Picture;
        Image image(2, 1, 4);
        image.linear = linear;
        image.samples = {0.3f, 0.6f, 0.9f, 0.25f, 0.1f, 0.2f, 1.0f, 0.5f};
        settings.picture = std::make_shared<const Image>(image);
        scene.environment = EnvironmentDescription{settings, {}};
        const Image read = *RoundTrip(scene).read.scene.environment->settings.picture;
        EXPECT_TRUE(read.linear);
        for (const std::size_t i : {0, 1, 2, 4, 5, 6}) {
            const double value = image.samples[i];
            EXPECT_NEAR(read.samples[i], linear ? value : linear_from_srgb(value), 1e-7) << i;
        }
    }
}

const char* const kProfile =
    "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n100 50 0\n";

TEST(NativeEnvironment, ProfilesOfLightsKeepEveryBit) {
    Numbers n(6);
    SceneDescription scene = empty_scene();
    PointLight point{.position = n.point(), .color = n.color()};
    point.profile = {"lamp.ies", std::make_shared<const IesProfile>(kProfile, "lamp.ies"),
                     n.point(), n.point()};
    scene.lights.push_back({"", point, {}});
    SpotLight spot{.position = n.point(), .direction = n.point()};
    spot.profile = {"lamp.ies", point.profile.profile, spot.direction, n.point()};
    scene.lights.push_back({"", spot, {}});
    expect_round_trip(scene);
}

TEST(NativeEnvironment, WhatAProfileDoesNotGiveIsSaid) {
    const ScratchFolder folder;
    const auto messages = [&](const std::string& tilt, const std::string& candela,
                              const std::string& keys) {
        folder.write("lamp.ies", "IESNA:LM-63-1995\nTILT=" + tilt +
                                     "\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n0 45 90\n0\n" + candela);
        Imported read = import_native_file(
            folder.write("scene.alhazen",
                         "alhazen 1\npoint_light { position = (0, 0, 0); profile = \"lamp.ies\"; " +
                             keys + " }\nsphere { radius = 1 }\n"));
        validate(read.scene, read.diagnostics);
        return read.messages();
    };
    EXPECT_EQ(messages("NONE", "100 50 0", "lumens = 100"), "");
    EXPECT_NE(messages("lamp.tlt", "100 50 0", "").find("\"lamp.ies\": TILT=lamp.tlt"),
              std::string::npos);
    EXPECT_EQ(messages("NONE", "0 0 0", ""), "");
    for (const char* power : {"lumens = 100", "power_watts = 1"}) {
        const std::string text = messages("NONE", "0 0 0", power);
        EXPECT_NE(text.find("\"lamp.ies\" emits nothing"), std::string::npos) << text;
        EXPECT_EQ(text.find("finite"), std::string::npos) << text;
    }
}

TEST(NativeEnvironment, PowersOfLightsAreRadiances) {
    const Imported read = import_native(
        "rectangle_light { corner = (0, 0, 0); edge_u = (2, 0, 0); edge_v = (0, 3, 0);"
        " power_watts = 12 }\n"
        "point_light { position = (0, 0, 0); lumens = 683; color = (1, 0.5, 0) }\n"
        "sphere { center = (0, 0, 0); radius = 1 }\n");
    EXPECT_EQ(read.messages(), "");
    constexpr double pi = 3.14159265358979323846;
    const auto& area = std::get<AreaLight>(read.scene.lights[0].light);
    EXPECT_NEAR(area.radiance.r, 12 / (pi * 6), 1e-12);
    const auto& point = std::get<PointLight>(read.scene.lights[1].light);
    EXPECT_NEAR(point.color.r * pi * 4 * pi, 1.0, 1e-12);
    EXPECT_EQ(point.attenuation.quadratic, 1.0);
    EXPECT_EQ(point.attenuation.constant, 0.0);
    for (const char* light : {"point_light { position = (0, 0, 0);",
                              "sphere_light { center = (0, 0, 9); radius = 1;"}) {
        const std::string text =
            import_native(light +
                          std::string(" lumens = 1; power_watts = 1 }\nsphere { radius = 1 }\n"))
                .messages();
        EXPECT_NE(text.find("exclude each other"), std::string::npos) << text;
        EXPECT_EQ(text.find("unknown key"), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
