#include "alhazen/importers/texture_table.h"

#include <algorithm>
#include <utility>

#include "alhazen/base/file.h"
#include "alhazen/imaging/image_io.h"

namespace alhazen {

namespace {

/// The limit of all pictures together: ends the import, where one bad picture does not.
class TotalExceeded : public Error {
  public:
    explicit TotalExceeded(const ImageLimits& limits)
        : Error(ErrorKind::Resource, "the pictures of the scene together are larger than " +
                                         std::to_string(limits.max_total_pixels) +
                                         " pixels of 8 bits (--max-texture-pixels)") {}
};

/// In pixels of 8-bit codes.
std::uint64_t cost_of(const StoredImage& image) {
    const std::uint64_t pixels = std::uint64_t(image.width) * std::uint64_t(image.height);
    return pixels << image.samples.index();  // bytes, shorts (2), floats (4)
}

}  // namespace

std::filesystem::path scene_root(const ImportOptions& options,
                                 const std::filesystem::path& fallback) {
    if (options.allowed_root.empty()) return fallback;
    return std::filesystem::absolute(options.allowed_root).lexically_normal();
}

std::filesystem::path folder_of(const std::filesystem::path& scene_file) {
    return std::filesystem::absolute(scene_file).lexically_normal().parent_path();
}

template <class Decode>
TextureTable::Picture TextureTable::decoded(const Decode& decode, std::uint64_t least) {
    const std::uint64_t left = limits_.max_total_pixels - taken_pixels_;
    if (least > left) throw TotalExceeded(limits_);
    taken_pixels_ += least;  // even when it cannot be decoded: looking at it took its time
    ImageLimits limits = limits_;
    limits.max_pixels = std::min(limits.max_pixels, left);
    try {
        auto picture = std::make_shared<const StoredImage>(decode(limits));
        const std::uint64_t cost = cost_of(*picture);
        if (cost > left) throw TotalExceeded(limits_);
        if (cost > least) taken_pixels_ += cost - least;
        return picture;
    } catch (const Error& error) {
        // It passes alone, but not with those before it.
        if (error.kind() == ErrorKind::Resource && left < limits_.max_pixels) {
            throw TotalExceeded(limits_);
        }
        throw;
    }
}

std::optional<TextureId> TextureTable::load(const std::string& file,
                                            const std::filesystem::path& folder,
                                            const Texture& settings, std::string name,
                                            const FileLocation& where) {
    Picture picture;
    try {
        const std::filesystem::path path = resolve_inside(root_, folder, file);
        const auto [entry, fresh] = files_.try_emplace(path);
        if (fresh) {
            diagnostics_.note_file(path);
            entry->second =
                decoded([&](const ImageLimits& limits) { return read_stored_image(path, limits); });
        }
        picture = entry->second;
    } catch (const TotalExceeded&) {
        throw;
    } catch (const Error& error) {
        diagnostics_.error(where, std::string("texture: ") + error.what());
    }
    return use(picture, settings, std::move(name), where);
}

std::optional<TextureId> TextureTable::add(std::string_view encoded, const Texture& settings,
                                           std::string name, const FileLocation& where) {
    const auto [entry, fresh] = embedded_.try_emplace({encoded.data(), encoded.size()});
    try {
        if (fresh) {
            entry->second = decoded(
                [&](const ImageLimits& limits) {
                    return decode_stored_image(encoded, name, limits);
                },
                encoded.size() / 4);
        }
    } catch (const TotalExceeded&) {
        throw;
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
