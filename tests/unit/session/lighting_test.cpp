#include "alhazen/session/lighting.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/load.h"
#include "alhazen/session/render.h"
#include "alhazen/session/seen_lights.h"
#include "alhazen/shading/lights/environment.h"
#include "support/scene_maker.h"
#include "support/scratch_folder.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

Light disc_light(bool seen, Rgb radiance) {
    AreaLight light;
    light.extent = DiscExtent{{0, 3, 0}, {0, -1, 0}, 1.0, 0.0};
    light.radiance = radiance;
    light.seen = seen;
    return light;
}

/// Lights that are seen and hidden, of the same name, and materials that emit.
struct Lit {
    SceneDescription description;
    Scene scene;

    Lit() {
        SceneMaker maker;
        Material ember;
        ember.emission.color = {1, 0, 0};
        ember.name = "lamp";
        maker.add(Sphere{}, maker.material(ember));
        maker.light(PointLight{});
        maker.light(disc_light(true, {2, 2, 2}));
        maker.light(disc_light(false, {3, 3, 3}));
        maker.light(disc_light(true, {4, 4, 4}));
        Material unnamed;
        unnamed.emission.color = {0, 0, 1};
        maker.add(Sphere{}, maker.material(unnamed));
        Material unlit;
        unlit.emission.color = {0, 1, 0};
        unlit.metallic_roughness = MetallicRoughness{};
        unlit.metallic_roughness->unlit = true;
        maker.add(Sphere{}, maker.material(unlit));
        for (std::size_t i : {1, 3}) maker.description().lights[i].name = "lamp";
        add_seen_lights(maker.description());
        scene = maker.compile();
        description = maker.description();
    }

    [[nodiscard]] Scene without(std::vector<std::string> off) const {
        Lighting lighting;
        lighting.off = std::move(off);
        return with_lighting(scene, description, lighting);
    }
};

TEST(Lighting, LightsHaveNamesOfTheirOwn) {
    std::vector<std::string> names, kinds;
    for (const NamedLight& choice : light_choices(Lit().description)) {
        names.push_back(choice.name);
        kinds.push_back(choice.kind);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"point light 1", "lamp", "area light 3", "lamp (2)",
                                               "lamp (3)", "material 2"}));
    EXPECT_EQ(kinds,
              (std::vector<std::string>{"point light", "area light", "area light", "area light",
                                        "material that emits", "material that emits"}));
}

// Names were tried one after another from 2 on: minutes for as many.
TEST(Lighting, LightsOfOneNameAreNumberedAtOnce) {
    constexpr std::size_t kCount = 50000;
    SceneMaker maker;
    for (std::size_t i = 0; i < kCount; ++i) maker.light(PointLight{});
    for (LightDescription& light : maker.description().lights) light.name = "lamp";
    // Numbers that would repeat an existing name are skipped.
    maker.description().lights[0].name = "lamp (3)";
    maker.description().lights[3].name = "lamp (2)";
    const std::vector<NamedLight> choices = light_choices(maker.description());
    std::vector<std::string> first;
    for (std::size_t i = 0; i < 6; ++i) first.push_back(choices[i].name);
    EXPECT_EQ(first, (std::vector<std::string>{"lamp (3)", "lamp", "lamp (2)", "lamp (2) (2)",
                                               "lamp (4)", "lamp (5)"}));
    EXPECT_EQ(choices.back().name, "lamp (49999)");
}

TEST(Lighting, LightsAreMovedTurnedAndColoured) {
    SceneMaker maker;
    maker.light(PointLight{.position = {1, 2, 3}});
    maker.light(SpotLight{.position = {1, 1, 1}, .direction = {0, 0, -1}});
    maker.light(DirectionalLight{.to_light = {0, 0, 1}});
    maker.light(AmbientLight{{1, 1, 1}});
    maker.add(Sphere{});
    const Scene scene = maker.compile();
    const SceneDescription& description = maker.description();
    const std::vector<NamedLight> choices = light_choices(description);
    EXPECT_EQ(*choices[0].position, (Vec3{1, 2, 3}));
    EXPECT_FALSE(choices[0].direction);
    EXPECT_EQ(*choices[1].direction, (Vec3{0, 0, -1}));
    EXPECT_EQ(*choices[2].direction, (Vec3{0, 0, -1}));
    EXPECT_FALSE(choices[2].position || choices[3].position || choices[3].direction);
    Lighting lighting;
    lighting.changes = {{"point light 1", Vec3{4, 5, 6}, {}, Rgb{2, 0, 1}},
                        {"spot light 2", Vec3{7, 8, 9}, Vec3{0, 3, 4}, {}},
                        {"directional light 3", {}, Vec3{0, -2, 0}, Rgb{3, 3, 3}},
                        {"ambient light 4", {}, {}, Rgb{0.5, 0.5, 0.5}}};
    EXPECT_FALSE(lighting.is_that_of_the_scene());
    const Scene lit = with_lighting(scene, description, lighting);
    const auto& point = std::get<PointLight>(lit.lights[0]);
    EXPECT_EQ(point.position, (Vec3{4, 5, 6}));
    EXPECT_EQ(point.color, (Rgb{2, 0, 1}));
    const auto& spot = std::get<SpotLight>(lit.lights[1]);
    EXPECT_EQ(spot.position, (Vec3{7, 8, 9}));
    EXPECT_EQ(spot.direction, (Vec3{0, 0.6, 0.8}));
    EXPECT_EQ(spot.color, (Rgb{1, 1, 1}));
    const auto& sun = std::get<DirectionalLight>(lit.lights[2]);
    EXPECT_EQ(sun.to_light, (Vec3{0, 1, 0}));
    EXPECT_EQ(sun.color, (Rgb{3, 3, 3}));
    EXPECT_EQ(ambient_of(lit.lights[3]), (Rgb{0.5, 0.5, 0.5}));
    EXPECT_EQ(lit.aggregate, scene.aggregate);
    const std::string blocks = changed_light_blocks(description, lighting.changes);
    for (const char* part : {"point_light", "position = (4, 5, 6)", "direction = (0, 3, 4)",
                             "to_light = (0, 2, 0)", "color = (0.5, 0.5, 0.5)"}) {
        EXPECT_NE(blocks.find(part), std::string::npos) << part << blocks;
    }
    lighting.off = {"point light 1"};
    EXPECT_FALSE(illuminates(with_lighting(scene, description, lighting).lights[0]));
}

TEST(Lighting, AnAreaLightIsColouredWithItsPart) {
    const Lit lit;
    Lighting lighting;
    lighting.changes = {{"lamp", {}, {}, Rgb{7, 8, 9}}, {"material 2", {}, {}, Rgb{1, 2, 3}}};
    const Scene other = with_lighting(lit.scene, lit.description, lighting);
    EXPECT_EQ(std::get<AreaLight>(other.lights[1]).radiance, (Rgb{7, 8, 9}));
    EXPECT_EQ(other.materials[3].emission.color, (Rgb{7, 8, 9}));
    EXPECT_EQ(other.materials[1].emission.color, (Rgb{1, 2, 3}));
    const std::string blocks = changed_light_blocks(lit.description, lighting.changes);
    EXPECT_NE(blocks.find("disc_light \"lamp\""), std::string::npos) << blocks;
    EXPECT_NE(blocks.find("radiance = (7, 8, 9)"), std::string::npos);
    EXPECT_EQ(blocks.find("seen"), std::string::npos);
    EXPECT_NE(blocks.find("// material \"material 2\": emission = (1, 2, 3)"), std::string::npos);
}

constexpr const char* kLamps = R"(alhazen 1
perspective_camera { eye = (0, 3, 9); look_at = (0, 1, 0); fov_deg = 60; aspect = 1 }
material "floor" { diffuse = 0.6; reflective = 0.2 }
plane { normal = (0, 1, 0); material = "floor" }
rectangle_light "rectangle" { corner = (-3, 2, 0); edge_u = (1, 0, 0); edge_v = (0, 0, 1); radiance = (2, 1, 1) }
disc_light "disc" { center = (-1, 2, 0); normal = (0, -1, 1); radius = 0.5; inner_radius = 0.2; radiance = 2 }
sphere_light "sphere" { center = (1, 2, 0); radius = 0.4; radiance = (1, 1, 2) }
tube_light "tube" { base = (2, 1, 0); top = (3, 2, 0); radius = 0.1; radiance = (1, 2, 1) }
polygon_light "polygon" { vertices = ((-2, 0.5, 1), (-1, 0.5, 1), (-1.5, 1.5, 1)); radiance = 1; two_sided = true }
mesh_light "mesh" { points = ((1, 0.2, 1), (2, 0.2, 1), (1.5, 1, 0.5), (1.5, 0.4, 2)); faces = ((0, 1, 2), (0, 3, 1)); radiance = 3 }
)";

std::vector<float> picture(const Scene& scene, const SceneDescription& description,
                           const char* renderer) {
    RenderOptions options;
    options.width = options.height = 24;
    options.renderer = renderer;
    options.samples_per_pixel = 2;
    return render_with_description(scene, description, options).film.to_image().samples;
}

/// The scene of a text, loaded.
LoadedScene loaded(const std::string& text) {
    const auto path = std::filesystem::path(::testing::TempDir()) / "lighting_lamps.alhazen";
    write_file_atomically(path, text);
    return load(path);
}

TEST(Lighting, SurfacesOfLightsAreMovedAsTheirBlocksSay) {
    const LoadedScene file = loaded(kLamps);
    const std::vector<LightChange> changes = {
        {"rectangle", Vec3{-2, 2.5, 1}, Vec3{1, -1, 0}, Rgb{3, 3, 1}, {1.5, 0.5}},
        {"disc", Vec3{-1, 1.5, 1}, Vec3{1, 0, 2}, {}, {0.75, 0.125}},
        {"sphere", Vec3{0.5, 1, 2}, {}, {}, {0.625}},
        {"tube", {}, Vec3{1, 0, 1}, {}, {2, 0.0625}},
        {"polygon", Vec3{-2, 1, 2}, Vec3{0.5, 0, 1}, {}, {1.25}},
        {"mesh", Vec3{1.5, 1.5, 1}, {}, {}, {0.5}}};
    const Scene& before = file.scene;
    for (std::size_t i = 0; i <= changes.size(); ++i) {
        // One after the other, and all of them.
        const std::vector<LightChange> some =
            i < changes.size() ? std::vector{changes[i]} : changes;
        ASSERT_EQ(surface_changes(file.description, some).size(), some.size());
        const LoadedScene moved = with_moved_surfaces(file, some, {});
        Lighting lighting;
        lighting.changes = some;
        const Scene lit = with_lighting(moved.scene, file.description, lighting);
        // The file, with the blocks instead of the lines of these lights.
        std::string text = kLamps;
        for (const LightChange& change : some) {
            const std::size_t name = text.find("\"" + change.name + "\"");
            const std::size_t begin = text.rfind('\n', name) + 1, end = text.find('\n', begin) + 1;
            text.replace(begin, end - begin, changed_light_blocks(file.description, {change}));
        }
        const LoadedScene written = loaded(text);
        for (const char* renderer : {"whitted", "distributed", "path_tracing"}) {
            EXPECT_EQ(picture(lit, moved.description, renderer),
                      picture(written.scene, written.description, renderer))
                << i << renderer << text;
            EXPECT_NE(picture(lit, moved.description, renderer),
                      picture(before, file.description, renderer))
                << i << renderer;
        }
    }
}

TEST(Lighting, ALampIsHitWhereItIsDrawnAndNoLongerWhereItWas) {
    const LoadedScene file = loaded(kLamps);
    const LoadedScene moved = with_moved_surfaces(file, {{"sphere", Vec3{0, 1, 4}, {}, {}, {0.5}}},
                                                  {.accelerator = "kd_tree"});
    const auto t = [](const Scene& scene, const Vec3& through) {
        Hit hit;
        const Vec3 eye{0, 1, 9};
        const Ray ray{eye, normalize(through - eye), 0.0, kInfinity};
        const bool found = scene.aggregate->closest(ray, hit, {nullptr, mask_of(RayKind::Eye)});
        return found ? hit.t : kInfinity;
    };
    EXPECT_DOUBLE_EQ(t(moved.scene, {0, 1, 4}), 4.5);
    EXPECT_EQ(t(file.scene, {0, 1, 4}), kInfinity);
    EXPECT_LT(t(file.scene, {1, 2, 0}), 9.0);
    EXPECT_EQ(t(moved.scene, {1, 2, 0}), kInfinity);
}

TEST(Lighting, ALampCastsNoShadowButIsInTheWayOfPaths) {
    const LoadedScene file = loaded(kLamps);
    const Vec3 eye{0, 1, 9};
    const Ray ray{eye, normalize(Vec3{1, 2, 0} - eye), 0.0, kInfinity};
    EXPECT_FALSE(file.scene.aggregate->occluded(ray, {nullptr, mask_of(RayKind::Shadow)}));
    EXPECT_TRUE(file.scene.aggregate->occluded(ray, {nullptr, mask_of(RayKind::Reflection)}));
    EXPECT_TRUE(file.scene.aggregate->occluded(ray, {nullptr, kConnectingRays}));
}

TEST(Lighting, OnlySurfacesThatMoveAreBuiltAnew) {
    const LoadedScene file = loaded(kLamps);
    const std::vector<NamedLight> choices = light_choices(file.description);
    // A colour, and the values of the file, do not change the geometry.
    for (const NamedLight& choice : choices) {
        LightChange same{choice.name, choice.position, choice.direction, Rgb{5, 5, 5}};
        for (const ExtentSize& size : choice.sizes) same.sizes.push_back(size.value);
        EXPECT_TRUE(surface_changes(file.description, {same}).empty()) << choice.name;
    }
    // One that is not seen has no surface in the scene, and moves all the same.
    const LoadedScene hidden = loaded(std::string(kLamps) +
                                      "sphere_light \"hidden\" { center = (0, 4, 0); radius = 1; "
                                      "radiance = 1; seen = false }\n");
    const std::vector<LightChange> moves = {{"hidden", Vec3{2, 4, 0}, {}, {}, {2}}};
    EXPECT_TRUE(surface_changes(hidden.description, moves).empty());
    Lighting lighting;
    lighting.changes = moves;
    const Scene lit = with_lighting(hidden.scene, hidden.description, lighting);
    const auto& area = std::get<AreaLight>(lit.lights.back());
    EXPECT_EQ(std::get<SphereExtent>(area.extent), (SphereExtent{{2, 4, 0}, 2}));
    EXPECT_EQ(area.surface->center(), (Vec3{2, 4, 0}));
    EXPECT_EQ(lit.aggregate, hidden.scene.aggregate);
}

TEST(Lighting, ALightIsChangedOnceInARequest) {
    const LoadedScene file = loaded(kLamps);
    // Each change is relative to the file: the surface and the light would be at different places.
    const std::vector<LightChange> twice{{"sphere", Vec3{0, 1, 4}, {}, {}, {}},
                                         {"disc", {}, {}, Rgb{5, 5, 5}, {}},
                                         {"sphere", {}, {}, {}, {0.5}}};
    Lighting lighting;
    lighting.changes = twice;
    EXPECT_THROW((void)surface_changes(file.description, twice), Error);
    EXPECT_THROW((void)with_moved_surfaces(file, twice, {}), Error);
    EXPECT_THROW((void)with_lighting(file.scene, file.description, lighting), Error);
    EXPECT_THROW((void)changed_light_blocks(file.description, twice), Error);
}

TEST(Lighting, WhatALightCannotBeIsRefused) {
    const Lit lit;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const LightChange wrong[] = {{"nobody", {}, {}, {}},
                                 {"lamp", {}, {}, {}, {1}},
                                 {"lamp", {}, {}, {}, {0, 0}},
                                 {"lamp", {}, {}, {}, {1, 1}},
                                 {"lamp", {}, {}, {}, {kNan, 0}},
                                 {"lamp", {}, Vec3{0, 0, 0}, {}},
                                 {"point light 1", {}, {}, {}, {1}},
                                 {"material 2", Vec3{1, 2, 3}, {}, {}},
                                 {"point light 1", {}, Vec3{1, 0, 0}, {}},
                                 {"point light 1", Vec3{kNan, 0, 0}, {}, {}},
                                 {"point light 1", Vec3{1e71, 0, 0}, {}, {}},
                                 {"point light 1", {}, {}, Rgb{-1, 0, 0}},
                                 {"point light 1", {}, {}, Rgb{0, kNan, 0}},
                                 {"point light 1", {}, {}, Rgb{0, 1e16, 0}}};
    for (const LightChange& change : wrong) {
        Lighting lighting;
        lighting.changes = {change};
        EXPECT_THROW((void)with_lighting(lit.scene, lit.description, lighting), Error);
        EXPECT_THROW((void)changed_light_blocks(lit.description, lighting.changes), Error);
    }
}

TEST(Lighting, ALightThatIsOffIsDarkWithItsPartAndItsNumberStays) {
    const Lit lit;
    const Scene dark = lit.without({"lamp (2)"});
    ASSERT_EQ(dark.lights.size(), 4u);
    EXPECT_TRUE(std::holds_alternative<AmbientLight>(dark.lights[3]));
    EXPECT_FALSE(illuminates(dark.lights[3]));
    EXPECT_TRUE(std::holds_alternative<AreaLight>(dark.lights[1]));
    ASSERT_EQ(dark.materials.size(), 5u);
    EXPECT_TRUE(dark.materials[4].emission.color.is_black());
    for (std::size_t i : {0, 1, 2, 3}) EXPECT_FALSE(dark.materials[i].emission.color.is_black());
    EXPECT_EQ(dark.aggregate, lit.scene.aggregate);
    // A hidden one has no part, a material no light.
    EXPECT_EQ(material_of_light(lit.description, 2), std::nullopt);
    EXPECT_EQ(material_of_light(lit.description, 1), MaterialId{3});
    const Scene cold = lit.without({"lamp (3)", "area light 3"});
    EXPECT_TRUE(cold.materials[0].emission.color.is_black());
    EXPECT_FALSE(illuminates(cold.lights[2]));
    EXPECT_TRUE(illuminates(cold.lights[0]));
}

TEST(Lighting, AnUnknownLightIsRefusedWithThoseThatThereAre) {
    try {
        (void)Lit().without({"moon"});
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("point light 1, lamp, area light 3"),
                  std::string::npos)
            << error.what();
    }
}

TEST(Lighting, SurroundingsTakeThePlaceOfThoseOfTheScene) {
    Lit lit;
    lit.scene.background = {1, 2, 3};
    Lighting lighting{.environment = "sky", .surroundings = make_environment("sky", UpAxis::Y)};
    const Scene sky = with_lighting(lit.scene, lit.description, lighting);
    ASSERT_NE(sky.environment, nullptr);
    EXPECT_TRUE(sky.environment->sun());
    EXPECT_EQ(sky.background.r, 1);
    lighting = {.environment = "none", .surroundings = make_environment("none", UpAxis::Y)};
    const Scene none = with_lighting(sky, lit.description, lighting);
    EXPECT_EQ(none.environment, nullptr);
    EXPECT_TRUE(none.background.is_black());
    EXPECT_TRUE(Lighting{}.is_that_of_the_scene());
}

/// The note is for the renderers whose transmitted rays are exact.
TEST(Simplified, NamesRenderersThatLeaveRoughTransmissionSharp) {
    const auto notes = [](double roughness, const char* renderer) {
        SceneMaker maker;
        Material frosted;
        frosted.metallic_roughness.emplace();
        frosted.metallic_roughness->transmission.value = 0.7;
        frosted.metallic_roughness->roughness.value = roughness;
        maker.add(Sphere{}, maker.material(frosted));
        const Scene scene = maker.compile();
        RenderOptions options;
        options.renderer = renderer;
        return simplified(scene, options, *make_renderer(renderer));
    };
    const auto said = notes(0.3, "whitted");
    ASSERT_EQ(said.size(), 1u);
    EXPECT_NE(said[0].find("does not blur transmission through rough surfaces (1 material)"),
              std::string::npos)
        << said[0];
    EXPECT_TRUE(notes(0.0, "whitted").empty());
    for (const char* blurs : {"path_tracing", "vcm", "distributed", "cone_tracing"}) {
        EXPECT_TRUE(notes(0.3, blurs).empty()) << blurs;
    }
}

TEST(Simplified, CountsRoughDielectricsAndCoefficients) {
    const auto notes = [](const Material& material) {
        SceneMaker maker;
        maker.add(Sphere{}, maker.material(material));
        const Scene scene = maker.compile();
        return simplified(scene, {}, *make_renderer("whitted"));
    };
    Material glass;
    glass.index.value = 1.5;
    glass.dielectric.emplace();
    EXPECT_TRUE(notes(glass).empty());
    glass.roughness.value = 0.4;
    ASSERT_EQ(notes(glass).size(), 1u);
    EXPECT_NE(notes(glass)[0].find("transmission through rough"), std::string::npos);
    Material coefficients;
    coefficients.roughness.value = 0.5;
    EXPECT_TRUE(notes(coefficients).empty());
    coefficients.transmissive.color = {0.9, 0.9, 0.9};
    ASSERT_EQ(notes(coefficients).size(), 1u);
    EXPECT_NE(notes(coefficients)[0].find("transmission through rough"), std::string::npos);
    coefficients.reflective.color = {0.1, 0.1, 0.1};
    ASSERT_EQ(notes(coefficients).size(), 2u);
    EXPECT_NE(notes(coefficients)[1].find("reflection at rough"), std::string::npos);
    coefficients.roughness.value = 0.0;
    EXPECT_TRUE(notes(coefficients).empty());
}

TEST(Simplified, CountsOnlyMaterialsThatPartsHaveAndRenderersThatShowThem) {
    SceneMaker maker;
    Material rough;
    rough.reflective.color = {0.5, 0.5, 0.5};
    rough.roughness.value = 0.2;
    const MaterialId seen = maker.material(rough);
    (void)maker.material(rough);
    Material foggy;
    foggy.scattering.coefficient = {1, 1, 1};
    (void)maker.material(foggy);
    maker.add(Sphere{}, seen);
    const Scene scene = maker.compile();
    EXPECT_EQ(scene.used_materials[static_cast<std::size_t>(seen)], 1);
    const auto notes = [&](const char* renderer, RenderOptions options = {}) {
        options.renderer = renderer;
        return simplified(scene, options, *make_renderer(renderer));
    };
    ASSERT_EQ(notes("whitted").size(), 1u);
    EXPECT_NE(notes("whitted")[0].find("rough surfaces (1 material)"), std::string::npos);
    for (const char* name : {"ray_casting", "lane_carpenter", "clark"}) {
        EXPECT_TRUE(notes(name).empty()) << name;
    }
    RenderOptions flat;
    flat.max_depth = 0;
    EXPECT_TRUE(notes("whitted", flat).empty());
}

TEST(Simplified, MotionIsLeftOutWithoutAnAggregateToo) {
    const testing::ScratchFolder folder;
    const auto path = folder.write("moving.alhazen", std::string(R"(alhazen 1
perspective_camera "c" { eye = (0, 0, 5); look_at = (0, 0, 0); up = (0, 1, 0); fov_deg = 40 }
rectangle {
    corner = (-1, -1, 0); edge_u = (2, 0, 0); edge_v = (0, 2, 0)
    motion = [(0, translate(0, 0, 0)), (1, translate(1, 0, 0))]
}
)"));
    for (const char* name : {"lane_carpenter", "clark", "beam_tracing", "cone_tracing"}) {
        LoadOptions load_options;
        load_options.with_aggregate = false;
        const LoadedScene loaded = load(path, load_options);
        RenderOptions options;
        options.renderer = name;
        const auto notes = simplified(loaded.scene, options, *make_renderer(name));
        ASSERT_EQ(notes.size(), 1u) << name;
        EXPECT_NE(notes[0].find("the moment at which the shutter opens"), std::string::npos);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
