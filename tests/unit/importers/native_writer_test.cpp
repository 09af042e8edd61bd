#include "alhazen/importers/native/native_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <random>

#include "alhazen/base/error.h"
#include "alhazen/imaging/image.h"
#include "alhazen/importers/native/native_importer.h"
#include "alhazen/importers/native/native_text.h"
#include "alhazen/importers/unique_labels.h"
#include "support/random.h"
#include "support/same_description.h"
#include "support/scratch_folder.h"
#include "text_scene.h"

namespace alhazen {
namespace {

using testing::Random;
using testing::ScratchFolder;

/// Writes the description into a folder and reads it back.
struct RoundTrip {
    ScratchFolder folder;
    std::string text;
    std::map<std::string, std::size_t> files;  ///< sizes of those beside the scene
    testing::Imported read;

    explicit RoundTrip(const SceneDescription& description) {
        text = native_scene_text(description, "scene_files", [&](const auto& name, auto bytes) {
            EXPECT_FALSE(files.contains(name)) << "written twice: " << name;
            files[name] = bytes.size();
            folder.write(name, bytes);
            return name;
        });
        read = testing::import_text<NativeImporter>(text, folder.path() / "scene.alhazen");
        EXPECT_EQ(read.messages(), "") << text.substr(0, 4000);
    }
};

void expect_round_trip(const SceneDescription& description) {
    const RoundTrip trip(description);
    testing::expect_same(description, trip.read.scene);
    if (::testing::Test::HasFailure()) ADD_FAILURE() << trip.text.substr(0, 6000);
}

/// Numbers whose last bits a careless writer loses.
class Numbers {
  public:
    explicit Numbers(std::uint64_t seed) : random_(seed) {}
    double any() { return random_.sign() * random_.log_uniform(1e-12, 1e12); }
    double positive() { return random_.log_uniform(0.1, 10); }
    Vec2 uv() { return {any(), any()}; }
    Vec3 point() { return {any(), any(), any()}; }
    Rgb color() { return {positive(), positive(), positive()}; }
    Affine affine() {
        return Affine::rotate(random_.unit_vector(), positive()) * Affine::translate(point());
    }
    int below(int n) { return random_.below(n); }

  private:
    Random random_;
};

SceneDescription empty_scene(const std::string& root = "scene") {
    SceneDescription scene;
    scene.objects.push_back({root, {}, {}});
    scene.conventions.ambient_inside_times_kt = false;
    scene.conventions.clamp_attenuation = false;
    scene.conventions.air_index = 1.0;
    scene.conventions.linear_output = false;
    return scene;
}

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

TEST(NativeWriter, EveryConventionAndPictureSettingComesBack) {
    using C = ShadingConventions;
    for (int i = 0; i < 4; ++i) {
        SceneDescription scene = empty_scene("room");
        C& c = scene.conventions;
        const bool even = i % 2 == 0;
        c.highlight = even ? C::Highlight::Phong : C::Highlight::BlinnPhong;
        c.shadow_tint = C::ShadowTint(i);
        c.refraction_tint = even ? C::RefractionTint::PerDistance : C::RefractionTint::PerEvent;
        c.ambient_factor = even ? C::AmbientFactor::Diffuse : C::AmbientFactor::Ambient;
        c.pixel_sample = C::PixelSample(i % 3);
        c.ambient_inside_times_kt = even;
        c.clamp_attenuation = even;
        c.truncate_material_colors = even;
        c.transmitting_surfaces_reflect = even;
        c.correct_interpolated_normals = !even;
        c.trace_reflections = !even;
        c.trace_refractions = !even;
        c.headlight = !even;
        c.linear_output = even;
        c.air_index = 1.0003;
        c.max_depth = i;
        c.min_contribution = 0.1 * i;
        scene.picture = {.width = 17, .height = 3, .background = Rgb{0.1, -0.0, 0.3}};
        scene.up_axis = even ? UpAxis::Z : UpAxis::Y;
        expect_round_trip(scene);
    }
}

TEST(NativeWriter, CamerasAndLightsComeBackBitForBit) {
    Numbers n(11);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 20; ++i) {
        const PerspectiveCamera p{n.point(), n.point(), n.point(), n.point()};
        const OrthographicCamera o{n.point(), n.point(), n.point(), n.point()};
        scene.cameras.push_back({i == 0 ? "" : "eye", p, n.positive(), {}});
        scene.cameras.push_back(
            {"a \"quoted\" \\ name\n\twith\x01 rubbish\xff", o, n.positive(), {}});
        const Attenuation a{n.positive(), n.positive(), n.positive()};
        const double inner = 0.1 * n.positive();
        scene.lights.push_back({"", AmbientLight{n.color()}, {}});
        scene.lights.push_back({"sun", DirectionalLight{n.point(), n.color(), n.color()}, {}});
        scene.lights.push_back(
            {"sun", PointLight{n.point(), n.color(), a, n.color(), n.positive()}, {}});
        scene.lights.push_back({"lamp",
                                SpotLight{n.point(), n.point(), inner, inner + 0.1 * n.positive(),
                                          n.color(), a, n.color(), n.positive()},
                                {}});
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
            Texture texture;
            texture.image = picture(channels, kind);
            texture.wrap_u = Wrap(kind);
            texture.wrap_v = Wrap((kind + 1) % 3);
            texture.filter = TextureFilter(kind);
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
    EXPECT_EQ(trip.read.scene.textures[0].texture.image, trip.read.scene.textures[1].texture.image);
}

TEST(NativeWriter, MaterialsComeBackWithEveryInput) {
    Numbers n(12);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 2; ++i) {
        Texture texture;
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
            p.unlit = i % 5 == 3;
        }
        scene.materials.push_back({m, {}});
    }
    expect_round_trip(scene);
}

Part part_of(decltype(Part::what) what, const Affine& placement, MaterialId material,
             std::string name) {
    return {std::move(what), placement, material, std::move(name), {}};
}

TEST(NativeWriter, ShapesComeBackInOrderWithNamesAndPlacements) {
    Numbers n(13);
    SceneDescription scene = empty_scene();
    for (int i = 0; i < 3; ++i) scene.materials.push_back({Material{}, {}});
    auto& parts = scene.objects[0].parts;
    Polygon ring;
    for (int i = 0; i < 9; ++i) ring.vertices.push_back(n.point());
    ring.loop_ends = {4, 9};
    Polygon plain;
    plain.vertices = ring.vertices;
    const auto flat = [&] { return Vec2{n.any(), n.any()}; };
    Prism prism{.h0 = n.any(), .h1 = n.any(), .top_scale = 0.5};
    Lathe lathe;
    for (int loop = 0; loop < 2; ++loop) {
        const Vec2 a = flat(), b = flat(), c = flat();
        for (Profile* profile : {&prism.profile, &lathe.profile}) {
            profile->curves.push_back(line_curve(a, b));
            profile->curves.push_back(cubic_curve(b, flat(), flat(), c));
            profile->curves.push_back(line_curve(c, a));
            profile->loop_ends.push_back(static_cast<std::uint32_t>(profile->curves.size()));
        }
    }
    lathe.profile.curves.pop_back();  // open
    lathe.profile.loop_ends = {3, 5};
    Blob blob{.threshold = n.positive()};
    blob.components = {{.base = n.point(), .radius = n.positive(), .strength = n.any()},
                       {.base = n.point(), .top = n.point(), .strength = n.any(), .rod = true}};
    HeightField field{.columns = 3, .rows = 2};
    field.heights = std::make_shared<std::vector<float>>(
        std::vector<float>{0.1f, 1e-3f, 3.f, 7.25f, 1.f / 3, 2.f});
    field.hi = flat();
    field.base = n.any();
    Polyhedron planes;
    for (int i = 0; i < 5; ++i) planes.planes.push_back({n.point(), n.point()});
    Quadric quadric{n.point(), n.point(), n.point(), n.positive()};
    const Quadric unclipped = quadric;
    quadric.clip_box = {n.point(), n.point()};
    quadric.clip_planes = {{n.point(), n.positive()}, {n.point(), n.positive()}};
    quadric.capped = false;
    for (const AnyShape& shape : std::initializer_list<AnyShape>{
             Sphere{n.point(), n.positive()},
             plain,
             ring,
             Plane{n.point(), n.point()},
             Disc{n.point(), n.point(), n.positive(), 0.01},
             Rectangle{n.point(), n.point(), n.point()},
             BoxShape{n.point(), n.point()},
             Cylinder{n.point(), n.point(), n.positive(), false},
             Cone{n.point(), n.point(), n.positive(), n.positive(), false},
             Sphere{},
             Plane{},
             Disc{},
             Rectangle{},
             BoxShape{},
             Cylinder{},
             Cone{},
             HalfSpace{n.point(), n.point()},
             planes,
             hexahedron({n.point(), n.point(), n.point(), n.point(), n.point(), n.point(),
                         n.point(), n.point()}),
             Ellipsoid{n.point(), n.point(), n.point(), n.point()},
             EllipticCylinder{n.point(), n.point(), n.point(), n.point(), false},
             EllipticCone{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             Tgc{n.point(), n.point(), n.point(), n.point(), n.point(), n.point(), false},
             Torus{n.point(), n.point(), n.positive(), n.positive()},
             Paraboloid{n.point(), n.point(), n.point(), n.point(), false},
             Hyperboloid{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             TwoSheetHyperboloid{n.point(), n.point(), n.point(), n.point(), n.positive(), false},
             quadric,
             unclipped,
             Algebraic{"x^2*y - 1", {n.point(), n.point()}, false},
             Ellipsoid{},
             EllipticCylinder{},
             EllipticCone{},
             Tgc{},
             Torus{},
             Paraboloid{},
             Hyperboloid{},
             TwoSheetHyperboloid{},
             Quadric{},
             Algebraic{},
             Superellipsoid{},
             Superellipsoid{n.point(), n.point(), n.point(), n.point(), n.positive(),
                            n.positive()}}) {
        parts.push_back(part_of(shape, n.affine(), MaterialId(n.below(3)), "a part"));
        parts.push_back(part_of(shape, {}, MaterialId(n.below(3)), ""));
    }
    Affine signed_zeros = Affine::scale({-1, 1, 1});
    signed_zeros.translation = {-0.0, 0.0, -0.0};
    parts.push_back(part_of(AnyShape{Sphere{}}, signed_zeros, MaterialId{0}, "\""));
    expect_round_trip(scene);
}

TEST(NativeWriter, ObjectsKeepTheirNumbersWhateverTheirOrder) {
    Numbers n(14);
    SceneDescription scene = empty_scene("root");
    scene.materials.push_back({Material{}, {}});
    scene.objects = {
        {"leaf", {}, {}}, {"tree", {}, {}}, {"leaf", {}, {}}, {"", {}, {}}, {"tree", {}, {}}};
    scene.root = ObjectIndex{1};
    const auto place = [&](std::size_t owner, decltype(Part::what) what, const char* name) {
        scene.objects[owner].parts.push_back(part_of(std::move(what), n.affine(), {}, name));
    };
    place(0, AnyShape{Sphere{}}, "");
    place(1, ObjectIndex{3}, "branch");
    place(1, ObjectIndex{0}, "");
    place(1, AnyShape{Plane{}}, "ground");
    place(2, AnyShape{Sphere{}}, "bud");
    place(3, ObjectIndex{4}, "twig");
    place(3, ObjectIndex{4}, "twig");
    place(4, ObjectIndex{2}, "");
    expect_round_trip(scene);
    // Without forward references and renamed roots no list is needed.
    scene = empty_scene();
    scene.materials.push_back({Material{}, {}});
    scene.objects.push_back({"leaf", {}, {}});
    scene.objects.back().accelerator = "octree:leaf_size=3,mailbox=off";
    place(1, AnyShape{Sphere{}}, "");
    place(0, ObjectIndex{1}, "");
    EXPECT_EQ(RoundTrip(scene).text.find("objects"), std::string::npos);
    expect_round_trip(scene);
}

TriangleMesh random_mesh(Numbers& n, int triangles) {
    TriangleMesh mesh;
    for (int i = 0; i < triangles + 2; ++i) mesh.positions.push_back(n.point());
    for (int i = 0; i < triangles; ++i) {
        const auto v = static_cast<std::uint32_t>(i);
        mesh.triangles.push_back({v, v + 2, v + 1});
    }
    return mesh;
}

TEST(NativeWriter, MeshesComeBackWithEveryArrayAndStayShared) {
    Numbers n(15);
    SceneDescription scene = empty_scene();
    for (const char* name : {"a", "b", "a"}) {
        scene.materials.push_back({Material{.name = name}, {}});
    }
    for (int i = 0; i < 64; ++i) {
        TriangleMesh mesh = random_mesh(n, i % 2 == 0 ? 4 : 40);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const auto f = [&] { return static_cast<float>(n.positive()); };
            if (i & 2) mesh.uvs.push_back(n.uv());
            if (i & 4) mesh.vertex_materials.push_back(std::uint32_t(2 - n.below(2)));
            if (i & 8) mesh.normals.push_back(normalize(n.point()));
            if (i & 8) mesh.uvs2.push_back(n.uv());
            if (i & 16) mesh.colors.push_back({f(), f(), f(), f()});
            if (i & 32) mesh.tangents.push_back({f(), f(), f(), n.below(2) ? 1.0F : -1.0F});
        }
        scene.meshes.push_back(
            {i % 3 == 0 ? "mesh" : "", std::make_shared<TriangleMesh>(mesh), {}});
        for (int uses = 0; uses < i % 3; ++uses) {
            scene.objects[0].parts.push_back(
                part_of(MeshIndex(i), n.affine(), MaterialId{1}, uses == 0 ? "" : "part"));
        }
    }
    scene.meshes.push_back({"nothing", std::make_shared<TriangleMesh>(), {}});
    expect_round_trip(scene);
}

TEST(NativeWriter, OnlySmallMeshesStandInTheText) {
    Numbers n(16);
    SceneDescription scene = empty_scene();
    scene.meshes.push_back({"", std::make_shared<TriangleMesh>(random_mesh(n, 16)), {}});
    scene.meshes.push_back({"", std::make_shared<TriangleMesh>(random_mesh(n, 17)), {}});
    const RoundTrip trip(scene);
    ASSERT_EQ(trip.files.size(), 1U);
    EXPECT_TRUE(trip.files.contains("scene_files/mesh_1.ply"));
}

}  // namespace
}  // namespace alhazen
