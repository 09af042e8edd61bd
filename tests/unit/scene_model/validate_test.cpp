#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "alhazen/scene_model/scene_description.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::SceneMaker;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::size_t errors_in(const SceneDescription& description) {
    Diagnostics diagnostics;
    validate(description, diagnostics);
    return diagnostics.error_count();
}

SceneMaker good_scene() {
    SceneMaker maker;
    maker.material({});
    maker.add(Sphere{});
    return maker;
}

TEST(Validate, AGoodSceneHasNoFinding) {
    EXPECT_EQ(errors_in(good_scene().description()), 0u);
}

TEST(Validate, EveryFindingIsReportedAtOnceWithItsPlace) {
    SceneMaker maker = good_scene();
    SceneDescription& d = maker.description();
    d.objects[0].parts[0].object_from_part = Affine::scale({1, 0, 1});
    d.objects[0].parts[0].location = {"scene", 7, 3};
    d.materials[0].material.shininess.value = -1;
    d.lights.push_back({"", PointLight{.position = {kNan, 0, 0}}, {}});
    d.picture.width = 0;
    Diagnostics diagnostics;
    validate(d, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 4u);
    bool found = false;
    for (const Diagnostic& finding : diagnostics.all()) {
        found |= to_string(finding).starts_with("scene:7:3: error: the transform is singular");
    }
    EXPECT_TRUE(found);
}

TEST(Validate, ADielectricHasAnIndex) {
    SceneMaker maker = good_scene();
    Material& material = maker.description().materials[0].material;
    material.index.value = 0;
    EXPECT_EQ(errors_in(maker.description()), 0u);
    material.dielectric.emplace();
    EXPECT_EQ(errors_in(maker.description()), 1u);
    material.index.value = 0.5;
    EXPECT_EQ(errors_in(maker.description()), 0u);
}

TEST(Validate, PicturesOnMeshesWithoutCoordinatesAreToldOfOnce) {
    const auto warnings = [](const Texture& texture, bool with_uvs, bool with_uvs2 = false) {
        SceneMaker maker;
        maker.description().textures.push_back({"t", texture, {}});
        Material m;
        m.diffuse = {{1, 1, 1}, TextureId{0}};
        (void)maker.material(m);
        TriangleMesh triangle;
        triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        triangle.triangles = {{0, 1, 2}};
        if (with_uvs) triangle.uvs.resize(3);
        if (with_uvs2) triangle.uvs2.resize(3);
        const MeshIndex mesh = maker.mesh(triangle);
        maker.add(mesh, MaterialId{0});
        maker.add(mesh, MaterialId{0}, Affine::translate({1, 0, 0}));
        Diagnostics diagnostics;
        validate(maker.description(), diagnostics);
        EXPECT_EQ(diagnostics.error_count(), 0u);
        return diagnostics.warning_count();
    };
    ImageTexture picture;
    picture.image =
        std::make_shared<StoredImage>(StoredImage{1, 1, 1, false, std::vector<std::uint8_t>{9}});
    EXPECT_EQ(warnings(picture, false), 1u);
    EXPECT_EQ(warnings(picture, true), 0u);
    EXPECT_EQ(warnings(SolidTexture{}, false), 0u);
    EXPECT_EQ(warnings(picture, false, true), 1u);
    picture.uv_set = 1;
    EXPECT_EQ(warnings(picture, false), 1u);
    EXPECT_EQ(warnings(picture, false, true), 0u);
}

TEST(Validate, IdsOutOfRangeAreErrors) {
    SceneMaker maker = good_scene();
    SceneDescription& d = maker.description();
    d.objects[0].parts[0].material = MaterialId{9};
    d.materials[0].material.diffuse.texture = TextureId{3};
    Part part;
    part.what = MeshIndex{5};
    d.objects[0].parts.push_back(part);
    part.what = ObjectIndex{5};
    d.objects[0].parts.push_back(part);
    EXPECT_EQ(errors_in(d), 4u);
}

TEST(Validate, AnObjectThatContainsItselfIsAnError) {
    SceneMaker maker = good_scene();
    const ObjectIndex a = maker.object("a");
    const ObjectIndex b = maker.object("b");
    maker.add(b, MaterialId{0}, {}, a);
    maker.add(a, MaterialId{0}, {}, b);
    maker.add(a);
    EXPECT_EQ(errors_in(maker.description()), 1u);
}

TEST(Validate, NestingIsLimitedWithoutRecursion) {
    SceneMaker maker = good_scene();
    ObjectIndex previous{0};
    for (int i = 0; i < 100000; ++i) {
        const ObjectIndex next = maker.object("deep");
        maker.add(next, MaterialId{0}, {}, previous);
        previous = next;
    }
    EXPECT_EQ(errors_in(maker.description()), 1u);
}

TEST(Validate, OperandsOfSolidsMustBoundVolumes) {
    SceneMaker maker = good_scene();
    const ObjectIndex solid = maker.object("solid");
    const ObjectIndex operand = maker.object("operand");
    SceneDescription& d = maker.description();
    d.objects[static_cast<std::size_t>(solid)].combine = Combine::Difference;
    EXPECT_EQ(errors_in(d), 1u) << "a difference of nothing";
    maker.add(Sphere{}, MaterialId{0}, {}, solid);
    maker.add(operand, MaterialId{0}, {}, solid);
    EXPECT_EQ(errors_in(d), 0u) << "an empty operand";
    const MeshIndex closed = maker.mesh(testing::tetrahedron());
    maker.add(closed, MaterialId{0}, {}, operand);
    EXPECT_EQ(errors_in(d), 0u);
    TriangleMesh open = testing::tetrahedron();
    open.triangles.pop_back();
    maker.add(maker.mesh(open), MaterialId{0}, {}, operand);
    maker.add(Disc{}, MaterialId{0}, {}, operand);
    maker.add(Cylinder{.capped = false}, MaterialId{0}, {}, solid);
    EXPECT_EQ(errors_in(d), 3u);
    d.objects[static_cast<std::size_t>(solid)].combine = Combine::Group;
    EXPECT_EQ(errors_in(d), 0u) << "side by side they may be open";
}

TEST(Validate, CamerasThatCannotMakeAPictureAreErrors) {
    SceneMaker maker = good_scene();
    auto& camera = std::get<PerspectiveCamera>(maker.description().cameras[0].camera);
    camera.up = camera.right;
    EXPECT_EQ(errors_in(maker.description()), 1u);
    camera.up = {0, 1, 0};
    camera.look = {0, 0, 0};
    EXPECT_EQ(errors_in(maker.description()), 1u);
}

TEST(Validate, EveryPartOfAMaterialAndATextureIsLookedAt) {
    const double inf = std::numeric_limits<double>::infinity();
    const TextureId missing{7};
    const auto errors_with = [](auto change) {
        SceneMaker maker = good_scene();
        Material& m = maker.description().materials[0].material;
        m.metallic_roughness = MetallicRoughness{};
        change(m, *m.metallic_roughness);
        return errors_in(maker.description());
    };
    EXPECT_EQ(errors_with([](auto&, auto&) {}), 0u);
    EXPECT_EQ(errors_with([&](auto& m, auto&) { m.alpha.texture = missing; }), 1u);
    EXPECT_EQ(errors_with([&](auto& m, auto&) { m.normal_map = {missing, kNan}; }), 2u);
    EXPECT_EQ(errors_with([&](auto& m, auto&) { m.alpha_cutoff = kNan; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.base_color.texture = missing; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.roughness.value = -1; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.coat.roughness.value = kNan; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.sheen.color.texture = missing; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.film.thickest_nm = -1; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.anisotropy.rotation = kNan; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.dispersion = -1; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.diffuse_transmission.share.value = -1; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.diffuse_transmission.color.texture = missing; }),
              1u);
    EXPECT_EQ(errors_with([&](auto& m, auto&) { m.conductor = Conductor{}; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.thickness = {inf, missing, {}}; }), 2u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.attenuation_distance = 0; }), 1u);
    EXPECT_EQ(errors_with([&](auto&, auto& p) { p.attenuation_distance = inf; }), 0u);

    SceneMaker maker = good_scene();
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(Image(1, 1, 1)));
    texture.uv_set = 2;
    texture.uv_transform.uu = kNan;
    maker.description().textures.push_back({"t", texture, {}});
    EXPECT_EQ(errors_in(maker.description()), 2u);
}

TEST(Validate, AClosedMeshOfGlassThatFacesInwardIsAWarningOutsideOfSolids) {
    const auto warnings = [](TriangleMesh mesh, const Material& material,
                             Combine combine = Combine::Group) {
        SceneMaker maker;
        maker.material(material);
        maker.add(maker.mesh(std::move(mesh)));
        maker.description().objects[0].combine = combine;
        Diagnostics diagnostics;
        validate(maker.description(), diagnostics);
        EXPECT_EQ(diagnostics.error_count(), 0u);
        return diagnostics.all().size();
    };
    const TriangleMesh outward = testing::tetrahedron();
    TriangleMesh inward = outward;
    for (auto& triangle : inward.triangles) std::swap(triangle[0], triangle[1]);
    TriangleMesh open = inward, crooked = inward;
    open.triangles.pop_back();
    std::swap(crooked.triangles[0][0], crooked.triangles[0][1]);

    Material glass, coefficients, sheet;
    glass.dielectric.emplace();
    coefficients.transmissive.color = {0.5, 0.5, 0.5};
    sheet.metallic_roughness.emplace().transmission.value = 1;
    Material body = sheet;
    body.metallic_roughness->thickness.value = 1;
    Material wax;
    wax.metallic_roughness.emplace().thickness.value = 1;
    wax.metallic_roughness->diffuse_transmission.share.value = 0.5;
    for (const Material& m : {glass, coefficients, body, wax}) {
        EXPECT_EQ(warnings(inward, m), 1u);
        EXPECT_EQ(warnings(outward, m), 0u);
        EXPECT_EQ(warnings(open, m), 0u);
        EXPECT_EQ(warnings(crooked, m), 0u);
        EXPECT_EQ(warnings(inward, m, Combine::Union), 0u);
    }
    EXPECT_EQ(warnings(inward, sheet), 0u);
    EXPECT_EQ(warnings(inward, {}), 0u);
    wax.metallic_roughness->thickness.value = 0;
    EXPECT_EQ(warnings(inward, wax), 0u);
}

TEST(Validate, AnInwardMeshIsAWarningWhereverTheSceneShowsItOutsideOfSolids) {
    for (const bool alone : {false, true}) {
        for (const bool in_union : {false, true}) {
            SceneMaker maker;
            Material glass;
            glass.dielectric.emplace();
            maker.material(glass);
            TriangleMesh inward = testing::tetrahedron();
            for (auto& triangle : inward.triangles) std::swap(triangle[0], triangle[1]);
            const ObjectIndex object = maker.object("o"), within = maker.object("group"),
                              solid = maker.object("solid");
            maker.add(maker.mesh(std::move(inward)), {}, {}, object);
            maker.add(object, {}, {}, within);
            maker.add(object, {}, {}, solid);
            maker.description().objects.back().combine = Combine::Union;
            maker.add(Sphere{{9, 0, 0}, 1});
            if (alone) maker.add(within);
            if (in_union) maker.add(solid);
            Diagnostics diagnostics;
            validate(maker.description(), diagnostics);
            EXPECT_EQ(diagnostics.all().size(), alone ? 1u : 0u) << in_union;
        }
    }
}

TEST(Validate, MasksNameKindsOfRaysAndHideNoPartOfASolid) {
    SceneMaker maker = good_scene();
    Part& part = maker.description().objects[0].parts[0];
    part.visible_to = mask_of(RayKind::Shadow);
    EXPECT_EQ(errors_in(maker.description()), 0u);
    for (const RayMask unknown :
         {RayMask{1} << 7, kConnectingRays, kRaysOfAllKinds | kConnectingRays}) {
        part.visible_to = unknown;
        EXPECT_EQ(errors_in(maker.description()), 1u) << unknown;
    }
    part.visible_to = kLightSurfaceMask;
    EXPECT_EQ(errors_in(maker.description()), 0u) << "as add_seen_lights sets it";
    part.visible_to = 0;
    Diagnostics diagnostics;
    validate(maker.description(), diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    ASSERT_EQ(diagnostics.all().size(), 1u) << "a warning";
    part.visible_to = mask_of(RayKind::Eye);
    maker.description().objects[0].combine = Combine::Union;
    EXPECT_EQ(errors_in(maker.description()), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
