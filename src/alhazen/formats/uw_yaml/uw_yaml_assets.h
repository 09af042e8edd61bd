#pragma once
/// Materials, textures and meshes of a course scene, read at their first use by a component,
/// because scenes list more assets than they use, and some files are absent.
///
/// Source: the scenes of UW CSE 457, 2020 (docs/reference/formats/uw_yaml.md).
/// Conventions: paths are relative to the parent folder of the course's `assets`.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/pictures/picture_finder.h"
#include "alhazen/formats/pictures/texture_table.h"
#include "alhazen/formats/uw_yaml/uw_yaml_document.h"

namespace alhazen {

/// The nearest ancestor of `scene_folder` (or itself) with a subfolder `assets`; otherwise
/// `scene_folder`.
[[nodiscard]] std::filesystem::path find_course_root(const std::filesystem::path& scene_folder);

class UwAssets {
  public:
    UwAssets(const YAML::Node& document, const ImportSource& source, SceneDescription& scene,
             Diagnostics& diagnostics);

    /// The material that `component` names; a grey one, with a report, if it is unavailable.
    MaterialId material(const YAML::Node& component);
    [[nodiscard]] bool is_textured(MaterialId material) const;
    /// The cube of side 1 as twelve triangles with the texture coordinates of the format.
    MeshIndex textured_cube(const YAML::Node& component);
    /// The mesh of that name, read from its file. Reports and returns none if it is unavailable.
    std::optional<MeshIndex> mesh(const std::string& name, const YAML::Node& component);
    [[nodiscard]] bool has_mesh(const std::string& name) const { return meshes_.contains(name); }

  private:
    using Table = std::map<std::string, YAML::Node>;
    Table table_of(const YAML::Node& document, const char* key);
    /// The file named by `Path`, relative to the root; as written if there is none.
    std::string path_of(const YAML::Node& asset);
    MaterialId make_material(const std::string& name, const YAML::Node& node);
    ColorInput color_input(const YAML::Node& uniforms, const char* name);
    std::optional<TextureId> texture(const std::string& name, const YAML::Node& user);

    YamlValues values_;
    const ImportSource& source_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::filesystem::path root_;
    TextureTable texture_files_;
    PictureFinder finder_;
    Table materials_, textures_, meshes_, shaders_;
    std::unordered_map<std::string, MaterialId> made_materials_;
    std::unordered_map<std::string, std::optional<TextureId>> made_textures_;
    std::unordered_map<std::string, std::optional<MeshIndex>> made_meshes_;
    std::optional<MeshIndex> textured_cube_;
};

}  // namespace alhazen
