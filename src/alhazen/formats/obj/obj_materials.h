#pragma once
/// Materials of an OBJ scene: locates libraries and images and creates a Material for each used
/// entry.
///
/// Source: see mtl_reader.h. Interpretation of statements and illumination models:
/// docs/reference/formats/obj.md.
/// Conventions: a missing or unreadable library or image is a warning; a name that no library
/// defines gives the grey material, with one warning.

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/obj/mtl_reader.h"
#include "alhazen/formats/obj/obj_statements.h"
#include "alhazen/formats/pictures/picture_finder.h"
#include "alhazen/formats/pictures/texture_table.h"

namespace alhazen {

class ObjMaterials {
  public:
    ObjMaterials(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics,
                 bool colored);

    /// Reads the files of the `mtllib` lines.
    void load(const std::vector<ObjLibrary>& libraries);
    /// Makes one material of those whose names differ by a comment alone, at the first of them.
    void unify(ObjStatements& statements) const;
    /// The material of this `usemtl` name, first given at `where`; added to the scene at its first
    /// use.
    MaterialId use(const std::string& name, const FileLocation& where);

  private:
    /// False if the file does not exist.
    bool load_library(const std::string& name, const FileLocation& where);
    MaterialId grey();
    MaterialId add(const MtlMaterial& m);
    void set_reflection(const MtlMaterial& m, Material& out);
    void set_light_through(const MtlMaterial& m, Material& out);
    void set_metallic_roughness(const MtlMaterial& m, Material& out);
    [[nodiscard]] double dissolve_of(const MtlMaterial& m);
    /// The normal map from the `norm` map, otherwise from the bump map: images of directions are
    /// used unchanged, height images are converted to normals.
    NormalMap normal_map(const MtlMaterial& m);
    bool is_normal_map(const std::shared_ptr<const StoredImage>& picture);
    [[nodiscard]] std::optional<std::size_t> find_entry(const std::string& name) const;
    /// The picture of this name; none if there is no such file. A comment may follow the name.
    std::optional<std::string> find_picture(const std::string& written);
    TextureId texture(const MtlMap& map, bool is_color);
    ColorInput color(const Rgb& value, const MtlMap& map);
    ScalarInput scalar(double value, const MtlMap& map);

    [[nodiscard]] ImageTexture& image_texture(TextureId id) {
        return std::get<ImageTexture>(scene_.textures[static_cast<std::size_t>(id)].texture);
    }

    const ImportSource& source_;
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    bool colored_;  ///< true if the vertices have colours
    Diagnostics picture_findings_;
    std::filesystem::path folder_;
    std::vector<std::filesystem::path> roots_;
    TextureTable textures_;
    PictureFinder finder_;
    std::vector<MtlMaterial> entries_;
    std::vector<std::string> entry_folders_;  ///< [entry] of its library, relative to the scene
    std::string current_folder_;              ///< of the current entry
    std::unordered_map<std::string, std::size_t> entry_of_;
    std::unordered_map<std::string, std::size_t> entry_of_part_;  ///< by names without comments
    std::unordered_map<std::string, MaterialId> used_;
    std::unordered_map<std::string, bool> loaded_;
    std::unordered_map<std::shared_ptr<const StoredImage>, bool> is_normal_map_;
    std::optional<MaterialId> grey_;
};

}  // namespace alhazen
