#include "alhazen/importers/texture_table.h"

#include <utility>

#include "alhazen/base/file.h"
#include "alhazen/imaging/image_io.h"

namespace alhazen {

std::filesystem::path scene_root(const ImportOptions& options,
                                 const std::filesystem::path& fallback) {
    if (options.allowed_root.empty()) return fallback;
    return std::filesystem::absolute(options.allowed_root).lexically_normal();
}

std::filesystem::path folder_of(const std::filesystem::path& scene_file) {
    return std::filesystem::absolute(scene_file).lexically_normal().parent_path();
}

std::optional<TextureId> TextureTable::load(const std::string& file,
                                            const std::filesystem::path& folder,
                                            const Texture& settings, std::string name,
                                            const FileLocation& where) {
    std::shared_ptr<const Image> image;
    try {
        const std::filesystem::path path = resolve_inside(root_, folder, file);
        const auto [entry, fresh] = images_.try_emplace(path);
        if (fresh) entry->second = std::make_shared<const Image>(read_image(path));
        image = entry->second;
    } catch (const Error& error) {
        diagnostics_.error(where, std::string("texture: ") + error.what());
    }
    if (!image) return std::nullopt;
    Texture texture = settings;
    texture.image = std::move(image);
    scene_.textures.push_back({std::move(name), std::move(texture), where});
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

}  // namespace alhazen
