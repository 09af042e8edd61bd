#pragma once
/// Materials of the SBT-raytracer format: nested defaults, names, texture maps.
///
/// Source: docs/reference/formats/ray.md.
/// Differs: a reference to an undefined name is an error (the course program silently uses the
/// default).

#include <map>
#include <optional>
#include <string>

#include "alhazen/formats/pictures/picture_finder.h"
#include "alhazen/formats/pictures/texture_table.h"
#include "alhazen/formats/ray/ray_context.h"
#include "alhazen/formats/text/block_reader.h"

namespace alhazen {

/// The value of a material and, once it is used, its id in the scene.
struct RayMaterial {
    Material value;
    std::optional<MaterialId> id;
    FileLocation location;
};

class RayMaterials {
  public:
    explicit RayMaterials(RayContext& context);

    /// The material written as `value`: a block (a modified copy of `enclosing`) or a name.
    RayMaterial read(TextNode value, const RayMaterial& enclosing);
    /// Handles a `material { name = "n"; ... }` item of the dictionary family: defines a name,
    /// changes no default.
    void define(TextNode entry, const RayMaterial& enclosing);

    /// The material's id; added to the scene at its first use.
    MaterialId use(RayMaterial& material);

  private:
    RayMaterial read_block(TextNode block, const RayMaterial& enclosing);
    RayMaterial named(TextNode word, const RayMaterial& fallback);
    void read_color(BlockReader& reader, std::string_view key, ColorInput& out);
    void read_scalar(BlockReader& reader, std::string_view key, double scale, double map_scale,
                     ScalarInput& out);
    std::optional<TextureId> read_map(TextNode value, std::string_view key);
    std::string read_name(BlockReader& reader);
    void refuse_extensions(BlockReader& reader);
    void add_name(const std::string& name, RayMaterial& material);

    RayContext& context_;
    std::filesystem::path folder_;
    TextureTable textures_;
    PictureFinder finder_;
    std::map<std::string, TextureId> maps_;
    std::map<std::string, RayMaterial> by_name_;
};

}  // namespace alhazen
