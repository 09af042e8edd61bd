#pragma once
/// Converts a loaded scene to another format: the whole scene as native text, its meshes as PLY,
/// OBJ or STL, its patches as OBJ or .bpt.
///
/// Conventions: OUT.alhazen refers to its meshes (binary PLY) and pictures (PNG, EXR) in OUT_files/
/// beside it; OUT.obj refers to its materials in OUT.mtl and its pictures in the same folder. All
/// references are relative: file and folder can be moved together. Referenced files are written
/// first, each atomically, and OUT last. Files of these names are replaced; other files are left
/// alone. A file of OUT_files/ that another scene beside OUT names and whose bytes differ is never
/// replaced: the new file gets another name. A target that could be a file of the scene is refused,
/// and nothing is written. A failed conversion removes the files and the folder that it created.
/// Mesh files contain every placed mesh in the frame of the scene, in the order of the description.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct ConvertOptions {
    /// Mesh formats: omit shapes that are not meshes instead of refusing the scene.
    bool meshes_only = false;
    /// How the caller's user sets `meshes_only`, advised by the refusal; "": not at all.
    std::string meshes_only_setting = "--meshes-only";
    /// The same of replacing shapes by triangles before the conversion.
    std::string tolerance_setting = "--tolerance X";
    double tolerance = 0.0;  ///< that of the triangles which replace shapes; 0: there are none
    bool strict = false;     ///< refuse the scene if the file cannot hold all of the parts written
    std::uint64_t max_triangles = 400'000'000;  ///< limit of a mesh file, instances expanded
};

struct ConvertReport {
    std::vector<std::filesystem::path> files;  ///< in the order they were written; the last is OUT
    std::uint64_t bytes = 0;                   ///< total size of the files
    std::uint64_t triangles = 0;     ///< written: each mesh once (native), or all placed meshes
    std::uint64_t masked_parts = 0;  ///< mesh formats: parts whose visibility mask is lost
    std::uint64_t moving_parts = 0;  ///< mesh formats: parts whose motion is lost
    double moment = 0;               ///< at which the moving parts are written: the shutter opens
    /// OBJ: faces whose vertices have different materials; each has that of its first vertex.
    std::uint64_t mixed_faces = 0;
    std::uint64_t lost_tangents = 0;         ///< PLY: placed meshes whose tangents are lost
    std::uint64_t lost_mapped_tangents = 0;  ///< OBJ: the same, if a normal map uses them
    /// OBJ: placed meshes whose vertex colours lose their alpha, or are clamped to 0 to 1.
    std::uint64_t lost_alpha = 0, clamped_colors = 0;
    std::uint64_t unit_normals = 0;  ///< OBJ: placed meshes whose normals lose their lengths
    std::uint64_t collapsed = 0;     ///< STL: triangles of which two corners become one
    double moved = 0;      ///< STL: the greatest distance by which its floats move a corner
    double tolerance = 0;  ///< of the options
    std::string left_out;  ///< shapes that meshes_only dropped: "2 spheres, 1 plane"
    /// OBJ: material properties that MTL cannot express, one line each.
    std::vector<std::string> lost;
};

/// Three digits of a positive number, not below it.
[[nodiscard]] std::string rounded_up(double value);

/// What the file does not hold of the parts that it has, a line for each kind.
[[nodiscard]] std::vector<std::string> losses_of(const ConvertReport& report);
/// The parts that were left out, and the losses, a line for each kind.
[[nodiscard]] std::vector<std::string> conversion_warnings(const ConvertReport& report);

/// Throws Error (Usage) with the known suffixes when `path` has none of them, or when it is the
/// file `scene` itself. Call it before loading.
void check_convert_target(const std::filesystem::path& scene, const std::filesystem::path& path);

/// Writes a valid `description` in the format of the suffix of `path`. Throws Error: Usage as above
/// and for content that the format cannot hold, Scene for an empty result and, if strict, for
/// losses (nothing is written then), Resource beyond the limits, File when a file cannot be
/// written.
ConvertReport convert(const SceneDescription& description, const std::filesystem::path& path,
                      const ConvertOptions& options = {});

}  // namespace alhazen
