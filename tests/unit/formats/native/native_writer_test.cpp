#include "alhazen/formats/native/write/native_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>
#include "alhazen/shading/optics/metals.h"

#include "alhazen/base/error.h"
#include "alhazen/formats/native/fields/native_text.h"
#include "alhazen/formats/text/unique_labels.h"
#include "alhazen/imaging/image/image.h"
#include "alhazen/shading/spectrum/illuminant_spectrum.h"
#include "native_round_trip.h"
#include "support/image_texture.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::empty_scene;
using testing::expect_round_trip;
using testing::Numbers;
using testing::RoundTrip;

TEST(NativeText, NumbersReadBackToTheSameBits) {
    std::mt19937_64 bits(7);
    for (int i = 0; i < 20000; ++i) {
        const double number = std::bit_cast<double>(bits());
        if (!std::isfinite(number)) continue;
        EXPECT_EQ(std::strtod(native_value(number).c_str(), nullptr), number);
    }
    EXPECT_EQ(native_value(-0.0), "-0");
    EXPECT_EQ(native_value(0.1), "0.1");
    EXPECT_EQ(native_value(5e-324), "5e-324");
    EXPECT_THROW((void)native_value(std::numeric_limits<double>::infinity()), Error);
    EXPECT_THROW((void)native_value(std::nan("")), Error);
}

TEST(NativeText, LabelsAreUniqueAndUniqueNamesStay) {
    EXPECT_EQ(unique_labels({"a", "b", "a", "", "", "a_2"}, "thing"),
              (std::vector<std::string>{"a", "b", "a_8", "thing_3", "thing_4", "a_2"}));
}

TEST(NativeWriter, AnEmptySceneIsItsHeader) {
    const RoundTrip trip(empty_scene());
    EXPECT_EQ(trip.text, "alhazen 1\n\n");
    expect_round_trip(empty_scene());
}

TEST(NativeWriter, MotionComesBack) {
    SceneDescription scene = empty_scene("room");
    scene.materials.push_back({Material{.name = "m"}, {}});
    const std::vector<TransformKey> keys{
        {-0.5, Affine::rotate({0.3, 1, 0.2}, 0.1)},
        {0.25, Affine::translate({1.0 / 3, -0.0, 2}) * Affine::scale({1, 2, 0.7})}};
    std::vector<Part>& parts = scene.objects[0].parts;
    for (const Affine& outer : {Affine{}, Affine::translate({0, 0, 0.1})}) {
        for (const Affine& inner : {Affine{}, Affine::scale({3, 1, 1})}) {
            Part part;
            part.what = AnyShape{Sphere{}};
            part.motion = std::make_shared<const PartMotion>(PartMotion{outer, keys, inner});
            parts.push_back(part);
        }
    }
    for (const std::uint32_t size : {3u, 40u}) {
        TriangleMesh mesh;
        MeshKey early{0, {}, {}}, late{1.5, {}, {}};
        for (std::uint32_t i = 0; i < size; ++i) {
            mesh.positions.push_back({double(i) / 3, double(i % 3), 0.1 * (i % 2)});
            if (size > 3) mesh.normals.push_back({0, 0, 1});
            early.positions.push_back(mesh.positions[i] + Vec3{0, 0, 0.1});
            late.positions.push_back(mesh.positions[i] + Vec3{0, 0.7, 0});
            if (size > 3) early.normals.push_back({0, 1, 0});
            if (size > 3) late.normals.push_back({1, 0, 0});
            if (i > 1) mesh.triangles.push_back({i - 2, i - 1, i});
        }
        scene.meshes.push_back(
            {"g" + std::to_string(size), std::make_shared<TriangleMesh>(mesh), {}, {early, late}});
        Part part;
        part.what = MeshIndex(scene.meshes.size() - 1);
        parts.push_back(part);
    }
    CameraDescription camera;
    camera.keys = keys;
    scene.cameras.push_back(camera);
    open_shutter(scene, {0.1, 0.4});
    expect_round_trip(scene);
    scene.objects[0].parts.clear();
    scene.shutter = {0, 1};
    const std::string text = RoundTrip(scene).text;
    EXPECT_EQ(text.find("shutter"), std::string::npos);  // the default
}

TEST(NativeWriter, EveryConventionAndPictureSettingComesBack) {
    using C = ShadingConventions;
    for (int i = 0; i < 4; ++i) {
        SceneDescription scene = empty_scene("room");
        Conventions& c = scene.conventions;
        const bool even = i % 2 == 0;
        c.shading.highlight = C::Highlight(i % 3);
        c.shading.shadow_tint = C::ShadowTint(i);
        c.shading.refraction_tint =
            even ? C::RefractionTint::PerDistance : C::RefractionTint::PerEvent;
        c.shading.ambient_factor = even ? C::AmbientFactor::Diffuse : C::AmbientFactor::Ambient;
        c.sampling.pixel_sample = SamplingConventions::PixelSample(i % 3);
        c.shading.ambient_inside_times_kt = even;
        c.shading.ambient_from_eye = even;
        c.shading.optics = {even, i > 1};
        if (even) c.shading.inside_color = Rgb{0.1, 0.2, 0.3};
        c.shading.clamp_attenuation = even;
        c.importing.truncate_material_colors = even;
        c.shading.transmitting_surfaces_reflect = even;
        c.shading.correct_interpolated_normals = !even;
        c.shading.trace_reflections = !even;
        c.shading.trace_refractions = !even;
        c.importing.headlight = !even;
        c.importing.surroundings = even;
        c.film.linear_output = even;
        c.film.round_output = i % 4 == 0;
        c.shading.air_index = 1.0003;
        c.shading.max_depth = i;
        c.shading.min_contribution = 0.1 * i;
        c.shading.min_distance = 0.25 * i;
        scene.picture = {.width = 17, .height = 3, .background = Rgb{0.1, -0.0, 0.3}};
        scene.up_axis = even ? UpAxis::Z : UpAxis::Y;
        expect_round_trip(scene);
    }
}

TEST(NativeWriter, CamerasAndLightsComeBackBitForBit) {
    // ADD A CAMERA OR A LIGHT HERE: one of it in the loop.
    static_assert(std::variant_size_v<Camera> == 3 && std::variant_size_v<Light> == 5);
    Numbers n(11);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 20; ++i) {
        const Lens lens{n.positive(), n.positive(), i % 2 == 0 ? 0 : 5, n.positive()};
        const PerspectiveCamera p{n.point(), n.point(), n.point(), n.point(), lens};
        const OrthographicCamera o{n.point(), n.point(), n.point(), n.point()};
        const WideCamera w{n.point(),    n.point(),   n.point(), n.point(), WideProjection(i % 3),
                           n.positive(), n.positive()};
        scene.cameras.push_back({i == 0 ? "" : "eye", p, n.positive(), {}});
        scene.cameras.push_back({"around", w, n.positive(), {}});
        scene.cameras.push_back(
            {"a \"quoted\" \\ name\n\twith\x01 rubbish\xff", o, n.positive(), {}});
        const Attenuation a{n.positive(), n.positive(), n.positive()};
        const double inner = 0.1 * n.positive();
        scene.lights.push_back({"", AmbientLight{n.color()}, {}});
        scene.lights.push_back(
            {"sun", DirectionalLight{n.point(), n.color(), n.color(), i == 0}, {}});
        scene.lights.push_back(
            {"sun", PointLight{n.point(), n.color(), a, n.color(), n.positive(), i == 0}, {}});
        scene.lights.push_back({"lamp",
                                SpotLight{n.point(), n.point(), inner, inner + 0.1 * n.positive(),
                                          n.color(), a, n.color(), n.positive()},
                                {}});
    }
    const LightExtent extents[] = {
        RectangleExtent{n.point(), n.point(), n.point()},
        DiscExtent{n.point(), n.point(), n.positive(), n.positive()},
        SphereExtent{n.point(), n.positive()},
        TubeExtent{n.point(), n.point(), n.positive()},
        PolygonExtent{{n.point(), n.point(), n.point(), n.point()}},
        MeshExtent{{n.point(), n.point(), n.point()}, {{{0, 1, 2}}, {{2, 1, 0}}}}};
    for (const LightExtent& extent : extents) {
        const bool odd = extent.index() % 2 == 1;
        scene.lights.push_back(
            {"area", AreaLight{extent, n.color(), odd, n.color(), !odd, {}}, {}});
    }
    scene.lights.push_back({"without", PointLight{.attenuation = {0, 0, 0}}, {}});
    scene.lights.push_back(
        {"widest", SpotLight{.inner_angle = 0, .outer_angle = 3.141592653589793}, {}});
    expect_round_trip(scene);
}

/// A picture of codes, or of floats that are none.
std::shared_ptr<const StoredImage> picture(int channels, int kind) {
    Image image(3, 2, channels);
    image.linear = kind == 2;
    image.associated = kind == 2 && channels % 2 == 0;
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        const float code = static_cast<float>(i * 7 % 255);
        image.samples[i] = kind == 0   ? code / 255.0F
                           : kind == 1 ? (code * 257 - 1 < 0 ? 0 : code * 257 - 1) / 65535.0F
                                       : code * 1.3e-5F - 1.0F;
    }
    auto kept = std::make_shared<StoredImage>(stored(image));
    EXPECT_EQ(kept->samples.index(), std::size_t(kind));
    return kept;
}

TEST(NativeWriter, PicturesKeepTheirSamplesAndAreWrittenOnce) {
    SceneDescription scene = empty_scene();
    for (int channels = 1; channels <= 4; ++channels) {
        for (int kind = 0; kind < 3; ++kind) {
            ImageTexture texture;
            texture.image = picture(channels, kind);
            texture.wrap_u = Wrap(kind);
            texture.wrap_v = Wrap((kind + 1) % 3);
            texture.filter = TextureFilter((kind + channels) % 4);
            texture.corner_texels = kind == 1;
            texture.decode_srgb = kind == 1;
            texture.uv_set = kind == 1 ? 1 : 0;
            if (kind > 0) texture.uv_transform = {0.1, 0.2, -0.3, 1.7, {0.3, -0.0}};
            scene.textures.push_back({"wood", texture, {}});
            texture.wrap_u = Wrap::Clamp;
            scene.textures.push_back({"", texture, {}});
        }
    }
    const RoundTrip trip(scene);
    EXPECT_EQ(trip.files.size(), 12U);
    EXPECT_TRUE(trip.files.contains("scene_files/texture_0.png"));
    EXPECT_TRUE(trip.files.contains("scene_files/texture_4.exr"));
    testing::expect_same(scene, trip.read.scene);
    EXPECT_EQ(testing::image_texture(trip.read.scene.textures[0]).image,
              testing::image_texture(trip.read.scene.textures[1]).image);
}

TEST(NativeWriter, MaterialsComeBackWithEveryInput) {
    Numbers n(12);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 2; ++i) {
        ImageTexture texture;
        texture.image = picture(4, 0);
        scene.textures.push_back({"wood", texture, {}});
    }
    const auto color = [&] {
        return ColorInput{n.color(), n.below(2) ? TextureId{1} : kNoTexture};
    };
    const auto scalar = [&](Channel usual) {
        const int kind = n.below(3);
        if (kind == 0) return ScalarInput{n.positive(), kNoTexture, usual};
        return ScalarInput{kind == 1 ? 1.0 : n.positive(), TextureId{0}, Channel(n.below(5))};
    };
    scene.materials.push_back({Material{}, {}});
    for (int i = 0; i < 60; ++i) {
        Material m;
        m.name = i % 3 == 0 ? "" : i % 3 == 1 ? "steel" : "steel " + std::to_string(i);
        m.emission = color();
        m.diffuse = color();
        m.ambient = i % 2 == 0 ? m.diffuse : color();
        m.specular = color();
        m.reflective = color();
        m.transmissive = color();
        m.shininess = scalar(Channel::Mean);
        m.index = scalar(Channel::Mean);
        m.roughness = scalar(Channel::Mean);
        m.alpha_mode = AlphaMode(i % 3);
        m.alpha = scalar(Channel::Alpha);
        m.alpha_cutoff = n.positive();
        m.double_sided = i % 2 == 0;
        if (i % 4 != 0) m.normal_map = {TextureId{1}, i % 4 == 1 ? 1.0 : n.any()};
        if (i % 5 != 0) {
            MetallicRoughness& p = m.metallic_roughness.emplace();
            if (i % 5 == 1) continue;
            p.base_color = color();
            p.metallic = scalar(Channel::Blue);
            p.roughness = scalar(Channel::Green);
            p.occlusion = scalar(Channel::Red);
            p.specular = scalar(Channel::Alpha);
            p.specular_color = color();
            p.transmission = scalar(Channel::Red);
            p.thickness = scalar(Channel::Green);
            if (i % 5 != 2) p.attenuation_distance = n.positive();
            p.attenuation_color = n.color();
            p.coat.strength = scalar(Channel::Red);
            p.coat.roughness = scalar(Channel::Green);
            p.sheen.color = color();
            p.sheen.roughness = scalar(Channel::Alpha);
            p.film.strength = scalar(Channel::Red);
            p.film.index = n.positive();
            p.film.thinnest_nm = n.positive();
            p.film.thickest_nm = n.positive();
            p.anisotropy.strength = n.positive();
            p.anisotropy.rotation = n.positive();
            p.diffuse_transmission = {scalar(Channel::Alpha), color()};
            p.dispersion = n.positive();
            p.unlit = i % 5 == 3;
        }
        scene.materials.push_back({m, {}});
    }
    Material gold, metal, water;
    const Metal& measured = *find_metal("gold");
    gold.conductor = Conductor{measured.index, measured.extinction, "gold"};
    metal.conductor = Conductor{n.color(), n.color(), ""};
    water.dielectric = Dielectric{n.color()};
    water.scattering = {n.color(), -0.3};
    water.index.value = 1.33;
    water.dispersion = Dispersion{.abbe = 55.8};
    Material bk7, formula, lamp, filament;
    const NamedGlass& named = *find_glass("BK7");
    bk7.dielectric = Dielectric{n.color()};
    bk7.dispersion = Dispersion{.sellmeier = named.sellmeier, .name = "BK7"};
    bk7.index.value = named.sellmeier.index(kLineD);
    formula.dispersion = Dispersion{.sellmeier = {{1.1, 0.2}, {0.01, 100}}};
    formula.index.value = formula.dispersion->sellmeier.index(kLineD);
    lamp.illuminant = Illuminant{IlluminantKind::BlackBody, 3200, n.positive()};
    filament.illuminant = Illuminant{IlluminantKind::A, 0, n.positive()};
    for (Material* m : {&lamp, &filament}) m->emission.color = color_of(*m->illuminant);
    Material black = bk7, clear = formula;
    black.dielectric.reset();
    clear.dielectric.emplace();
    for (const Material& m : {bk7, formula, black, clear, lamp, filament})
        scene.materials.push_back({m, {}});
    for (const Material& m : {gold, metal, water}) scene.materials.push_back({m, {}});
    expect_round_trip(scene);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
