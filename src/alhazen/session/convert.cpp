#include "alhazen/session/convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/importers/native/native_writer.h"
#include "alhazen/importers/picture_export.h"
#include "alhazen/importers/unique_labels.h"
#include "alhazen/session/placed_meshes.h"

namespace alhazen {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSuffixes = ".alhazen (the whole scene), .ply .obj .stl (its meshes)";
/// Placed meshes of a mesh file: some 200 bytes each while it is made.
constexpr std::uint64_t kMaxPlacedMeshes = 4'000'000;

bool is_same_file(const fs::path& a, const fs::path& b) {
    std::error_code failed;  // one of them does not exist: they differ
    return fs::equivalent(a, b, failed) && !failed;
}

/// Writes OUT and the files that it names, and keeps the report.
class Output {
  public:
    explicit Output(fs::path path) : path_(std::move(path)) { report_.files.reserve(4); }

    /// Relative to OUT: where the files that it names are.
    [[nodiscard]] std::string folder() const { return path_.stem().string() + "_files"; }
    [[nodiscard]] fs::path sibling(const char* suffix) const {
        return fs::path(path_.stem()).concat(suffix);
    }

    /// Throws Error (Usage) when one of `inputs` could be replaced: it is OUT or the file of its
    /// materials, or lies in the folder of its files.
    void check_inputs(const std::set<fs::path>& inputs, const std::string& suffix) const {
        std::vector<fs::path> written{path_};
        if (suffix == ".obj") written.push_back(path_.parent_path() / sibling(".mtl"));
        const bool has_folder = suffix == ".obj" || suffix == ".alhazen";
        const fs::path files = path_.parent_path() / folder();
        for (const fs::path& input : inputs) {
            std::error_code failed;
            const fs::path target = fs::canonical(input, failed);
            const bool replaced = std::any_of(written.begin(), written.end(), [&](const auto& w) {
                return is_same_file(w, input);
            });
            const bool inside =
                has_folder && (is_same_file(fs::absolute(input).parent_path(), files) ||
                               is_same_file(target.parent_path(), files));
            if (!replaced && !inside) continue;
            throw Error(
                ErrorKind::Usage,
                fmt::format("{} belongs to the scene that is read and could be overwritten; "
                            "expected another name for {}",
                            input.string(), path_.string()));
        }
    }

    void write_beside(const fs::path& name, std::span<const std::byte> bytes) {
        const fs::path path = path_.parent_path() / name;
        if (name.has_parent_path()) make_folder(path.parent_path());
        write(path, bytes);
    }
    ConvertReport finish(std::span<const std::byte> bytes) {
        write(path_, bytes);
        return std::move(report_);
    }
    ConvertReport& report() { return report_; }

  private:
    static void make_folder(const fs::path& folder) {
        std::error_code failed;
        fs::create_directory(folder, failed);
        if (failed || !fs::is_directory(folder)) {
            throw Error(ErrorKind::File, "cannot make the folder: " + failed.message(),
                        {folder.string(), 0, 0});
        }
    }
    void write(const fs::path& path, std::span<const std::byte> bytes) {
        write_file_atomically(path, bytes);
        report_.files.push_back(path);
        report_.bytes += bytes.size();
    }

    fs::path path_;
    ConvertReport report_;
};

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

ConvertReport write_native(const SceneDescription& description, Output& output) {
    for (const MeshDescription& mesh : description.meshes) {
        output.report().triangles += mesh.mesh->triangles.size();
    }
    const std::string text = native_scene_text(
        description, output.folder(),
        [&](const std::string& name, auto bytes) { output.write_beside(name, bytes); });
    return output.finish(bytes_of(text));
}

// Mesh formats.

void check_counts(const PlacedCounts& counts, const fs::path& path, const ConvertOptions& options) {
    const std::string shapes = shapes_in_words(counts);
    if (!shapes.empty() && !options.meshes_only) {
        throw Error(ErrorKind::Usage,
                    fmt::format("{} holds triangles only; the scene also has {}: --meshes-only "
                                "leaves them out, .alhazen keeps everything",
                                path.string(), shapes));
    }
    if (counts.triangles == 0) {
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

/// Names that other programs read as one word.
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

/// Pictures in the folder, materials in OUT.mtl; returns the name of that file.
std::string write_materials(const SceneDescription& description,
                            const std::vector<std::string>& names, Output& output) {
    std::map<const StoredImage*, std::string> files;
    std::vector<std::string> texture_files;
    for (const TextureDescription& texture : description.textures) {
        const StoredImage* image = texture.texture.image.get();
        std::string& file = files[image];
        if (file.empty()) {
            const PictureFile picture = picture_file(*image);
            file = fmt::format("{}/texture_{}.{}", output.folder(), texture_files.size(),
                               picture.suffix);
            output.write_beside(file, picture.bytes);
        }
        texture_files.push_back(file);
    }
    std::vector<Material> materials;
    for (std::size_t i = 0; i < names.size(); ++i) {
        materials.push_back(description.materials[i].material);
        materials.back().name = names[i];
    }
    const fs::path name = output.sibling(".mtl");
    const std::string text = mtl_text(materials, texture_files);
    output.write_beside(name, bytes_of(text));
    return name.string();
}

ConvertReport write_meshes(const SceneDescription& description, const std::string& suffix,
                           const fs::path& path, const ConvertOptions& options, Output& output) {
    const PlacedCounts counts = count_placed(description);
    check_counts(counts, path, options);
    output.report().triangles = counts.triangles;
    output.report().left_out = shapes_in_words(counts);
    const std::vector<std::string> names = material_words(description);
    const std::vector<NamedMesh> meshes = placed_meshes(description, names);
    std::string bytes;
    if (suffix == ".stl") {
        bytes = stl_bytes(meshes);
    } else if (suffix == ".obj") {
        bytes = obj_text(meshes, write_materials(description, names, output));
    } else if (meshes.size() == 1 && meshes.front().placement == Affine{} &&
               meshes.front().mesh->vertex_materials.empty()) {
        bytes = ply_bytes(*meshes.front().mesh);  // with its tangents, bit for bit
    } else {
        bytes = ply_bytes(meshes);
    }
    return output.finish(bytes_of(bytes));
}

/// All files that the scene was read from.
std::set<fs::path> inputs_of(const SceneDescription& description) {
    std::set<fs::path> inputs = description.files;
    if (!description.path.empty()) inputs.insert(description.path);
    return inputs;
}

}  // namespace

void check_convert_target(const fs::path& scene, const fs::path& path) {
    const std::string suffix = lower_suffix(path);
    if (suffix != ".alhazen" && suffix != ".ply" && suffix != ".obj" && suffix != ".stl") {
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
    Output output(path);
    const std::string suffix = lower_suffix(path);
    output.check_inputs(inputs_of(description), suffix);
    if (suffix == ".alhazen") return write_native(description, output);
    return write_meshes(description, suffix, path, options, output);
}

}  // namespace alhazen
