#include "alhazen/session/conversion/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/formats/native/write/native_writer.h"
#include "alhazen/formats/pictures/picture_export.h"
#include "alhazen/formats/text/unique_labels.h"
#include "alhazen/session/conversion/convert_output.h"
#include "alhazen/session/conversion/placed_meshes.h"
#include "alhazen/session/conversion/placed_surfaces.h"
#include "alhazen/session/masked_parts.h"
#include "alhazen/session/scene_files.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffixes =
    ".alhazen (the whole scene), .ply .obj .stl (its meshes; .obj also patches), .bpt (patches)";
/// Limit of placed meshes in a mesh file: about 200 bytes each during conversion.
constexpr std::uint64_t kMaxPlacedMeshes = 4'000'000;

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

ConvertReport write_native(const SceneDescription& description, ConvertOutput& output) {
    for (const MeshDescription& mesh : description.meshes) {
        output.report().triangles += mesh.mesh->triangles.size();
    }
    const std::string text = native_scene_text(
        description, output.folder(),
        [&](const std::string& name, auto bytes) { return output.write_beside(name, bytes); });
    return output.finish(bytes_of(text));
}

/// The part of a refusal about settings that avoid it; `by_triangles`: triangles are no loss.
std::string advice_of(const ConvertOptions& options, bool by_triangles) {
    std::string advice;
    if (by_triangles && !options.tolerance_setting.empty()) {
        advice += options.tolerance_setting + " makes triangles of them, ";
    }
    if (!options.meshes_only_setting.empty()) {
        advice += options.meshes_only_setting + " leaves them out, ";
    }
    return advice;
}

// Mesh formats.

/// The number of parts that move or whose vertices move; the parts of an object count once.
std::uint64_t moving_parts(const SceneDescription& description) {
    std::uint64_t count = 0;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) {
            const auto* mesh = std::get_if<MeshIndex>(&part.what);
            const bool deforms = mesh != nullptr &&
                                 !description.meshes[static_cast<std::size_t>(*mesh)].keys.empty();
            if (part.motion || deforms) ++count;
        }
    }
    return count;
}

/// Counts what no mesh format holds.
void note_losses(const SceneDescription& description, ConvertReport& report) {
    report.masked_parts = masked_parts(description);
    report.moving_parts = moving_parts(description);
    report.moment = description.shutter.open;
}

/// Moves the files to their places; throws if `options` refuse what they lose.
ConvertReport finish(const std::string& bytes, const ConvertOptions& options, const fs::path& path,
                     ConvertOutput& output) {
    const std::vector<std::string> losses = losses_of(output.report());
    if (options.strict && !losses.empty()) {
        std::string message = path.string() + " cannot hold all of the scene:";
        for (const std::string& line : losses) message += "\nerror: " + line;
        throw Error(ErrorKind::Scene, message);
    }
    return output.finish(bytes_of(bytes));
}

/// Throws if the counts exceed limits. `surfaces`: patches and surfaces that the file holds besides
/// triangles.
void check_counts(const PlacedCounts& counts, std::size_t surfaces, const fs::path& path,
                  const ConvertOptions& options) {
    const std::string shapes = shapes_in_words(counts);
    const char* held = surfaces > 0 ? "triangles and patches" : "triangles";
    if (!shapes.empty() && !options.meshes_only) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} holds {} only; the scene also has {}: {}.alhazen keeps "
                                "everything",
                                path.string(), held, shapes, advice_of(options, true)));
    }
    if (counts.triangles == 0 && surfaces == 0) {
        throw Error(ErrorKind::Scene,
                    fmt::format("{}: the scene has no triangles to write", path.string()));
    }
    if (counts.triangles > options.max_triangles || counts.meshes > kMaxPlacedMeshes) {
        throw Error(
            ErrorKind::Resource,
            fmt::format("with its instances the scene has {} triangles in {} meshes; at "
                        "most {} in {} can be written",
                        counts.triangles, counts.meshes, options.max_triangles, kMaxPlacedMeshes));
    }
}

/// Material names as single words, as other programs require.
std::vector<std::string> material_words(const SceneDescription& description) {
    std::vector<std::string> names;
    for (const MaterialDescription& m : description.materials) {
        std::string name = m.material.name;
        for (char& c : name) {
            const auto byte = static_cast<unsigned char>(c);
            if (byte <= 0x20 || byte == 0x7F || c == '#' || c == '\\') c = '_';
        }
        names.push_back(std::move(name));
    }
    return unique_labels(names, "material");
}

/// A material for surfaces whose u is written in reverse: its textures are looked up at 1 - u.
struct ReversedMaterial {
    std::size_t material = 0;
    std::string name;
};

/// Gives mirrored surfaces with textures such materials; returns these.
std::vector<ReversedMaterial> reverse_materials(const SceneDescription& description,
                                                const std::vector<std::string>& names,
                                                std::vector<NamedSurface>& surfaces) {
    std::map<std::string, std::size_t> index;
    std::vector<std::string> all = names;
    for (std::size_t i = 0; i < names.size(); ++i) {
        index[names[i]] = i;
        all.push_back(names[i] + "_mirrored");
    }
    const std::vector<std::string> labels = unique_labels(all, "material");
    std::vector<ReversedMaterial> reversed;
    std::set<std::size_t> known;
    for (NamedSurface& surface : surfaces) {
        if (!is_mirroring(surface.placement)) continue;
        const std::size_t i = index.at(surface.material);
        if (!reads_textures(description.materials[i].material)) continue;
        surface.material = labels[names.size() + i];
        if (known.insert(i).second) reversed.push_back({i, surface.material});
    }
    return reversed;
}

/// The same texture for coordinates with u in reverse.
MtlTexture reversed(MtlTexture texture) {
    UvTransform& uv = texture.settings.uv_transform;
    uv.offset = {uv.offset.x + uv.uu, uv.offset.y + uv.vu};
    uv.uu = -uv.uu;
    uv.vu = -uv.vu;
    return texture;
}

/// The text of the reversed materials; its losses are those of the materials, and normal maps.
std::string reversed_material_text(const SceneDescription& description,
                                   const std::vector<ReversedMaterial>& reversed_materials,
                                   std::span<const MtlTexture> textures,
                                   std::vector<std::string>& lost) {
    if (reversed_materials.empty()) return {};
    std::vector<MtlTexture> other;
    for (const MtlTexture& texture : textures) other.push_back(reversed(texture));
    std::vector<Material> materials;
    for (const ReversedMaterial& from : reversed_materials) {
        materials.push_back(description.materials[from.material].material);
        Material& material = materials.back();
        if (material.normal_map.texture != kNoTexture) {
            lost.push_back("the normal map of mirrored patches (material '" + material.name + "')");
        }
        material.name = from.name;
    }
    std::vector<std::string> same_losses;
    return mtl_text(materials, other, same_losses);
}

/// Writes pictures to the folder and materials to OUT.mtl; returns the name of that file.
std::string write_materials(const SceneDescription& description,
                            const std::vector<std::string>& names,
                            const std::vector<ReversedMaterial>& reversed_materials,
                            ConvertOutput& output) {
    std::map<const StoredImage*, std::string> files;
    std::vector<MtlTexture> textures;
    const auto write = [&](const ImageTexture& texture) {
        const StoredImage& image = *texture.image;
        std::string& file = files[&image];
        if (file.empty()) {
            const PictureFile picture = picture_file(image);
            file =
                fmt::format("{}/texture_{}.{}", output.folder(), textures.size(), picture.suffix);
            file = output.write_beside(file, picture.bytes);
        }
        textures.push_back({file, texture});
    };
    for (const TextureDescription& texture : description.textures) {
        const auto lose = [&](const SolidTexture&) {
            output.report().lost.push_back("solid texture " + texture.name);
            textures.push_back({"", {}});
        };
        std::visit(Overloaded{write, lose}, texture.texture);
    }
    std::vector<Material> materials;
    for (std::size_t i = 0; i < names.size(); ++i) {
        materials.push_back(description.materials[i].material);
        materials.back().name = names[i];
    }
    const fs::path name = output.sibling(".mtl");
    std::string text = mtl_text(materials, textures, output.report().lost);
    text += reversed_material_text(description, reversed_materials, textures, output.report().lost);
    output.write_sibling(name, bytes_of(text));
    return name.string();
}

/// The number of meshes with tangents that a normal map uses. `names` [material].
std::uint64_t meshes_that_use_tangents(const SceneDescription& description,
                                       std::span<const std::string> names,
                                       std::span<const NamedMesh> meshes) {
    std::set<std::string_view> mapped;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const Material& material = description.materials[i].material;
        const bool coat = material.metallic_roughness &&
                          material.metallic_roughness->coat.normal_map.texture != kNoTexture;
        if (coat || material.normal_map.texture != kNoTexture) mapped.insert(names[i]);
    }
    const auto uses = [&](const NamedMesh& from) {
        if (from.mesh->tangents.empty()) return false;
        if (from.mesh->vertex_materials.empty()) return mapped.contains(from.material);
        return std::any_of(
            from.mesh->vertex_materials.begin(), from.mesh->vertex_materials.end(),
            [&](std::uint32_t m) { return mapped.contains(from.vertex_material_names[m]); });
    };
    return std::uint64_t(std::count_if(meshes.begin(), meshes.end(), uses));
}

ConvertReport write_meshes(const SceneDescription& description, const std::string& suffix,
                           const fs::path& path, const ConvertOptions& options,
                           ConvertOutput& output) {
    PlacedCounts counts = count_placed(description);
    const std::vector<std::string> names = material_words(description);
    std::vector<NamedSurface> surfaces;
    if (suffix == ".obj") {
        surfaces = placed_surfaces(description, fits_obj_surface, names, counts);
    }
    check_counts(counts, surfaces.size(), path, options);
    output.report().triangles = counts.triangles;
    output.report().left_out = shapes_in_words(counts);
    note_losses(description, output.report());
    const std::vector<NamedMesh> meshes = placed_meshes(description, names);
    std::string bytes;
    if (suffix == ".stl") {
        bytes = stl_bytes(meshes);
        output.report().collapsed = triangles_that_floats_collapse(meshes);
        output.report().moved = greatest_move_by_floats(meshes);
        output.report().tolerance = options.tolerance;
    } else if (suffix == ".obj") {
        output.report().mixed_faces = faces_of_several_materials(meshes);
        output.report().lost_mapped_tangents = meshes_that_use_tangents(description, names, meshes);
        output.report().lost_alpha = meshes_with_vertex_alpha(meshes);
        output.report().clamped_colors = meshes_with_colors_beyond_one(meshes);
        output.report().unit_normals = meshes_with_normals_of_several_lengths(meshes);
        const auto reversed_materials = reverse_materials(description, names, surfaces);
        bytes = obj_text(meshes, write_materials(description, names, reversed_materials, output));
        bytes += obj_surfaces_text(surfaces);
    } else if (meshes.size() == 1 && meshes.front().placement == Affine{} &&
               meshes.front().mesh->vertex_materials.empty()) {
        bytes = ply_bytes(*meshes.front().mesh);  // with its tangents, bit for bit
    } else {
        const std::uint64_t without = meshes_without_tangents(meshes);
        if (without > 0) output.report().lost_tangents = meshes.size() - without;
        bytes = ply_bytes(meshes);
    }
    return finish(bytes, options, path, output);
}

/// Writes the non-rational Bezier patches.
ConvertReport write_patches(const SceneDescription& description, const fs::path& path,
                            const ConvertOptions& options, ConvertOutput& output) {
    PlacedCounts counts = count_placed(description);
    const std::vector<NamedSurface> surfaces =
        placed_surfaces(description, fits_bpt, material_words(description), counts);
    std::string others = shapes_in_words(counts);
    if (counts.meshes > 0) {
        others += fmt::format("{}{} mesh{}", others.empty() ? "" : ", ", counts.meshes,
                              counts.meshes > 1 ? "es" : "");
    }
    if (!others.empty() && !options.meshes_only) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} holds Bezier patches without weights only; the scene also has "
                                "{}: {}.alhazen keeps everything",
                                path.string(), others, advice_of(options, false)));
    }
    if (surfaces.empty()) {
        throw Error(ErrorKind::Scene,
                    fmt::format("{}: the scene has no patches to write", path.string()));
    }
    output.report().left_out = others;
    note_losses(description, output.report());
    return finish(bpt_text(surfaces), options, path, output);
}

}  // namespace

std::string rounded_up(double value) {
    // Three digits are within 1/200 of the value.
    return fmt::format("{:.3g}", 1.00502 * value);
}

std::vector<std::string> losses_of(const ConvertReport& report) {
    std::vector<std::string> lines;
    // `{}` of the sentence is the number of what is lost.
    const auto lose = [&](std::uint64_t n, const char* one, const char* several,
                          const char* sentence) {
        if (n == 0) return;
        const std::string count = fmt::format("{} {}", n, n == 1 ? one : several);
        lines.push_back(fmt::format(fmt::runtime(sentence), count));
    };
    lose(report.masked_parts, "part", "parts",
         "mesh files do not keep the visibility masks of {} (.alhazen keeps 'visible_to')");
    const std::string moment = fmt::format(
        "mesh files do not keep the motion of {{}}, written as at time {:g}, when the shutter "
        "opens (.alhazen keeps it)",
        report.moment);
    lose(report.moving_parts, "part", "parts", moment.c_str());
    lose(report.lost_tangents, "mesh", "meshes",
         "a PLY has tangents if all meshes have them: those of {} are left out (.alhazen keeps "
         "them)");
    lose(report.lost_mapped_tangents, "mesh", "meshes",
         "an OBJ has no tangents, which normal maps use: those of {} are left out (.alhazen keeps "
         "them)");
    lose(report.lost_alpha, "mesh", "meshes",
         "vertices of an OBJ have no alpha: that of {} is left out (.alhazen and .ply keep it)");
    lose(report.clamped_colors, "mesh", "meshes",
         "vertex colours of an OBJ are from 0 to 1: those of {} are clamped (.alhazen and .ply "
         "keep them)");
    lose(report.unit_normals, "mesh", "meshes",
         "normals of an OBJ have no lengths, which weigh them between vertices: those of {} are "
         "made unit (.alhazen and .ply keep the lengths)");
    lose(report.mixed_faces, "face", "faces",
         "a face of an OBJ has one material: {} between vertices of different materials got that "
         "of the first vertex");
    lose(report.collapsed, "triangle", "triangles",
         "an STL holds floats: corners of {} come together, which lose their area (.alhazen, .ply "
         "and .obj keep them apart)");
    if (report.tolerance > 0.0 && report.moved > report.tolerance) {
        lines.push_back(fmt::format(
            "an STL holds floats: corners move by up to {}, more than the tolerance of {:g} "
            "(.alhazen, .ply and .obj keep them in place)",
            rounded_up(report.moved), report.tolerance));
    }
    for (const std::string& what : report.lost) {
        lines.push_back("the MTL file cannot express " + what);
    }
    return lines;
}

std::vector<std::string> conversion_warnings(const ConvertReport& report) {
    std::vector<std::string> lines = losses_of(report);
    if (!report.left_out.empty()) {
        const bool patches = report.files.back().extension() == ".bpt";
        lines.insert(lines.begin(), fmt::format("left out, as they are not {}: {}",
                                                patches ? "patches" : "meshes", report.left_out));
    }
    return lines;
}

void check_convert_target(const fs::path& scene, const fs::path& path) {
    const std::string suffix = lower_suffix(path);
    if (suffix != ".alhazen" && suffix != ".ply" && suffix != ".obj" && suffix != ".stl" &&
        suffix != ".bpt") {
        throw Error(ErrorKind::Usage, fmt::format("cannot convert to '{}'; possible are {}",
                                                  path.string(), kSuffixes));
    }
    if (is_same_file(scene, path)) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} is the scene itself; expected another file", path.string()));
    }
}

ConvertReport convert(const SceneDescription& description, const fs::path& path,
                      const ConvertOptions& options) {
    check_convert_target(description.path, path);
    check_writable(path);
    const std::string suffix = lower_suffix(path);
    ConvertOutput output(path, suffix);
    output.check_inputs(files_of_scene(description));
    if (suffix == ".alhazen") return write_native(description, output);
    if (suffix == ".bpt") return write_patches(description, path, options, output);
    return write_meshes(description, suffix, path, options, output);
}

}  // namespace alhazen
