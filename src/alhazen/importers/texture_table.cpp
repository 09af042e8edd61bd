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
    Picture picture;
    try {
        const std::filesystem::path path = resolve_inside(root_, folder, file);
        const auto [entry, fresh] = files_.try_emplace(path);
        if (fresh)
            entry->second = std::make_shared<const StoredImage>(read_stored_image(path, limits_));
        picture = entry->second;
    } catch (const Error& error) {
        diagnostics_.error(where, std::string("texture: ") + error.what());
    }
    return use(picture, settings, std::move(name), where);
}

std::optional<TextureId> TextureTable::add(std::string_view encoded, const std::string& key,
                                           const Texture& settings, std::string name,
                                           const FileLocation& where) {
    const auto [entry, fresh] = embedded_.try_emplace(key);
    try {
        if (fresh) {
            entry->second = std::make_shared<const StoredImage>(
                decode_stored_image(encoded, name.empty() ? key : name, limits_));
        }
    } catch (const Error& error) {
        diagnostics_.error(where, std::string("texture: ") + error.what());
    }
    return use(entry->second, settings, std::move(name), where);
}

std::optional<TextureId> TextureTable::use(const Picture& picture, const Texture& settings,
                                           std::string name, const FileLocation& where) {
    if (!picture) return std::nullopt;
    Texture texture = settings;
    texture.image = picture;
    scene_.textures.push_back({std::move(name), std::move(texture), where});
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

}  // namespace alhazen
