#include "alhazen/formats/uw_yaml/uw_yaml_assets.h"

#include <array>

#include "alhazen/base/file.h"
#include "alhazen/formats/mesh/mesh_normals.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "alhazen/formats/text/first_names.h"

namespace alhazen {

namespace {

/// The format's v runs from the top of the picture downwards, as in the spheres that the course's
/// program exports (v = 0 at the north pole).
constexpr UvTransform kRowsFromTheTop{1, 0, 0, -1, {0, 1}};

/// A face of the cube, by the directions of its texture coordinates; its normal is u x v.
struct CubeFace {
    Vec3 u, v;
};
/// Seen from outside, u runs to the right and v up on the four sides; the top and the bottom
/// continue the front.
constexpr std::array<CubeFace, 6> kCubeFaces{{
    {{1, 0, 0}, {0, 1, 0}},   // front, +z
    {{0, 0, -1}, {0, 1, 0}},  // right, +x
    {{-1, 0, 0}, {0, 1, 0}},  // back, -z
    {{0, 0, 1}, {0, 1, 0}},   // left, -x
    {{1, 0, 0}, {0, 0, -1}},  // top, +y
    {{1, 0, 0}, {0, 0, 1}},   // bottom, -y
}};

/// The uniforms of the course's shaders; those that are not read have no effect on a trace.
constexpr std::array<std::string_view, 14> kUniforms{
    "Diffuse",       "DiffuseMap",         "Specular",
    "Emissive",      "Shininess",          "Transmittence",
    "Transmittance", "IndexOfRefraction",  "AmbientColor",
    "Color",         "LinearAttenuation",  "QuadraticAttenuation",
    "ShadowBias",    "ConstantAttenuation"};

/// The keys, for messages.
template <class Map>
std::string names_of(const Map& map) {
    return map.empty() ? "none is defined" : "expected one of " + first_names(map);
}

}  // namespace

std::filesystem::path find_course_root(const std::filesystem::path& scene_folder) {
    std::error_code ignored;
    for (std::filesystem::path folder = scene_folder;; folder = folder.parent_path()) {
        if (std::filesystem::is_directory(folder / "assets", ignored)) return folder;
        if (folder == folder.parent_path()) return scene_folder;
    }
}

UwAssets::UwAssets(const YAML::Node& document, const ImportSource& source, SceneDescription& scene,
                   Diagnostics& diagnostics)
    : values_(source.path.string(), diagnostics),
      source_(source),
      scene_(scene),
      diagnostics_(diagnostics),
      root_(find_course_root(folder_of(source.path))),
      texture_files_(scene, diagnostics, scene_roots(source.options, root_),
                     source.options.image_limits),
      finder_(scene_roots(source.options, root_), root_),
      materials_(table_of(document, "Materials")),
      textures_(table_of(document, "Textures")),
      meshes_(table_of(document, "Meshes")),
      shaders_(table_of(document, "ShaderPrograms")) {}

UwAssets::Table UwAssets::table_of(const YAML::Node& document, const char* key) {
    const YAML::Node map = YamlValues::find(document, key);
    Table table;
    values_.check_keys(map, key);
    if (!map.IsDefined() || !map.IsMap()) return table;
    for (const auto& entry : map) {
        if (entry.first.IsScalar()) table.emplace(entry.first.Scalar(), entry.second);
    }
    return table;
}

std::string UwAssets::path_of(const YAML::Node& asset) {
    const std::string written = values_.text(asset, "Path");
    return finder_.find(written).value_or(written);
}

MaterialId UwAssets::material(const YAML::Node& component) {
    const std::string name = values_.text(component, "Material");
    if (const auto made = made_materials_.find(name); made != made_materials_.end()) {
        return made->second;
    }
    const auto found = materials_.find(name);
    MaterialId id{std::uint32_t(scene_.materials.size())};
    if (found != materials_.end()) {
        id = make_material(name, found->second);
    } else {
        if (name.empty()) {
            values_.warning(component, "no material is named; it is grey");
        } else {
            values_.error(component, "unknown material '" + name + "'; " + names_of(materials_));
        }
        Material grey;
        grey.name = "grey";
        grey.diffuse.color = grey.ambient.color = {0.5, 0.5, 0.5};
        scene_.materials.push_back({grey, values_.location(component)});
    }
    made_materials_.emplace(name, id);
    return id;
}

bool UwAssets::is_textured(MaterialId material) const {
    const Material& m = scene_.materials[std::size_t(material)].material;
    for (const ColorInput* input :
         {&m.emission, &m.diffuse, &m.specular, &m.reflective, &m.transmissive}) {
        if (input->texture != kNoTexture) return true;
    }
    return false;
}

MaterialId UwAssets::make_material(const std::string& name, const YAML::Node& node) {
    values_.check_keys(node, "material", {"Shader", "Uniforms"});
    const std::string shader = values_.text(node, "Shader");
    const auto program = shaders_.find(shader);
    if (program != shaders_.end()) {
        values_.check_keys(program->second, "shader program",
                           {"Vertex", "Fragment", "Geometry", "Trace Compatible"});
    }
    if (program != shaders_.end() && !values_.flag(program->second, "Trace Compatible", true)) {
        values_.warning(node, "the material '" + name + "' has the shader '" + shader +
                                  "', which is not made for tracing");
    }
    const YAML::Node uniforms = YamlValues::find(node, "Uniforms");
    values_.check_keys(uniforms, "Uniforms", kUniforms);
    Material m;
    m.name = name;
    m.emission = color_input(uniforms, "Emissive");
    m.diffuse = color_input(
        uniforms, YamlValues::find(uniforms, "Diffuse").IsDefined() ? "Diffuse" : "DiffuseMap");
    m.ambient = m.diffuse;
    m.specular = color_input(uniforms, "Specular");
    m.reflective = m.specular;
    // The first is the spelling of the format.
    m.transmissive = color_input(uniforms, YamlValues::find(uniforms, "Transmittence").IsDefined()
                                               ? "Transmittence"
                                               : "Transmittance");
    m.shininess.value = values_.number(uniforms, "Shininess", 0.0);
    m.index.value = values_.number(uniforms, "IndexOfRefraction", 1.0);
    const MaterialId id{std::uint32_t(scene_.materials.size())};
    scene_.materials.push_back({std::move(m), values_.location(node)});
    return id;
}

ColorInput UwAssets::color_input(const YAML::Node& uniforms, const char* name) {
    const YAML::Node uniform = YamlValues::find(uniforms, name);
    ColorInput input;
    if (!uniform.IsDefined()) return input;
    // Scenes of the course have "ColorMap" in places where it has no effect.
    values_.check_keys(uniform, name, {"Color", "Color Map", "ColorMap", "Use Texture"});
    if (values_.flag(uniform, "Use Texture", false)) {
        const std::string map = values_.text(uniform, "Color Map");
        if (map.empty()) {
            values_.warning(uniform, std::string("'") + name + "' uses a texture but names none");
        } else if (const std::optional<TextureId> id = texture(map, uniform)) {
            // The map replaces the colour instead of multiplying it.
            return {{1, 1, 1}, *id};
        }
    }
    input.color = values_.color(uniform, "Color");
    return input;
}

std::optional<TextureId> UwAssets::texture(const std::string& name, const YAML::Node& user) {
    if (const auto made = made_textures_.find(name); made != made_textures_.end()) {
        return made->second;
    }
    std::optional<TextureId> id;
    if (const auto found = textures_.find(name); found != textures_.end()) {
        values_.check_keys(found->second, "texture", {"Path", "Bilinear"});
        ImageTexture settings;
        const bool bilinear = values_.flag(found->second, "Bilinear", true);
        settings.filter = bilinear ? TextureFilter::Bilinear : TextureFilter::Nearest;
        // Texel i lies at i / width; but without interpolation it fills [i, i + 1).
        settings.corner_texels = bilinear;
        settings.uv_transform = kRowsFromTheTop;
        id = texture_files_.load(path_of(found->second), root_, settings, name,
                                 values_.location(found->second));
    } else {
        values_.error(user, "unknown texture '" + name + "'; " + names_of(textures_));
    }
    made_textures_.emplace(name, id);
    return id;
}

MeshIndex UwAssets::textured_cube(const YAML::Node& component) {
    if (textured_cube_) return *textured_cube_;
    TriangleMesh mesh;
    for (const CubeFace& face : kCubeFaces) {
        const std::uint32_t first = std::uint32_t(mesh.positions.size());
        for (const Vec2 uv : {Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}}) {
            mesh.positions.push_back(0.5 * cross(face.u, face.v) + (uv.x - 0.5) * face.u +
                                     (uv.y - 0.5) * face.v);
            mesh.uvs.push_back(uv);
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    textured_cube_ = MeshIndex(scene_.meshes.size());
    scene_.meshes.push_back(
        {"Cube", std::make_shared<TriangleMesh>(std::move(mesh)), values_.location(component)});
    return *textured_cube_;
}

std::optional<MeshIndex> UwAssets::mesh(const std::string& name, const YAML::Node& component) {
    if (const auto made = made_meshes_.find(name); made != made_meshes_.end()) return made->second;
    std::optional<MeshIndex>& id = made_meshes_[name];
    const auto found = meshes_.find(name);
    if (found == meshes_.end()) {
        values_.error(component, "unknown mesh '" + name + "'; " + names_of(meshes_));
        return id;
    }
    const std::size_t errors_before = diagnostics_.error_count();
    values_.check_keys(found->second, "mesh", {"Path"});
    TriangleMesh mesh;
    try {
        const std::filesystem::path file =
            resolve_inside(scene_roots(source_.options, root_), root_, path_of(found->second));
        mesh = read_mesh(file, source_.options, diagnostics_);
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Resource) throw;
        values_.error(found->second, "the mesh '" + name + "' cannot be read: " + e.what());
    }
    if (diagnostics_.error_count() != errors_before) return id;
    if (mesh.normals.empty()) make_smooth_normals(mesh);
    id = MeshIndex(scene_.meshes.size());
    scene_.meshes.push_back(
        {name, std::make_shared<TriangleMesh>(std::move(mesh)), values_.location(found->second)});
    return id;
}

}  // namespace alhazen
