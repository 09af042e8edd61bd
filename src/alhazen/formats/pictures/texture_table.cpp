#include "alhazen/formats/pictures/texture_table.h"

#include <algorithm>
#include <utility>

#include "alhazen/base/file.h"
#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

namespace {

/// The limit of all images together.
class TotalExceeded : public Error {
  public:
    TotalExceeded(const ImageLimits& limits, const std::string& name)
        : Error(ErrorKind::Resource,
                "the images of the scene take more than " + std::to_string(limits.max_bytes >> 20) +
                    " MiB (--max-image-mib) with '" + name.substr(0, 200) + "'") {}
};

}  // namespace

std::vector<std::filesystem::path> scene_roots(const ImportOptions& options,
                                               const std::filesystem::path& own) {
    std::vector<std::filesystem::path> roots{own};
    for (const std::filesystem::path& folder : options.allowed_folders) {
        roots.push_back(std::filesystem::absolute(folder).lexically_normal());
    }
    return roots;
}

std::filesystem::path folder_of(const std::filesystem::path& scene_file) {
    return std::filesystem::absolute(scene_file).lexically_normal().parent_path();
}

void TextureTable::count(std::uint64_t bytes, const std::string& name) {
    if (bytes > limits_.max_bytes - taken_bytes_) throw TotalExceeded(limits_, name);
    taken_bytes_ += bytes;
}

template <class Decode>
std::shared_ptr<const StoredImage> TextureTable::decoded(const Decode& decode) {
    ImageLimits left = limits_;
    left.max_bytes -= taken_bytes_;
    auto picture = std::make_shared<const StoredImage>(decode(left));
    // Decoding was limited to the memory left, so the sum cannot exceed the limit.
    taken_bytes_ += picture->memory_bytes();
    return picture;
}

std::optional<TextureId> TextureTable::load(const std::string& file,
                                            const std::filesystem::path& folder,
                                            const ImageTexture& settings, std::string name,
                                            const FileLocation& where) {
    Picture none;
    Picture* picture = &none;
    try {
        const std::filesystem::path path = resolve_inside(roots_, folder, file);
        const auto [entry, fresh] = files_.try_emplace(path);
        picture = &entry->second;
        if (fresh) {
            diagnostics_.note_file(path);
            picture->image =
                decoded([&](const ImageLimits& limits) { return read_stored_image(path, limits); });
            warn_of_nothing(*picture->image, where);
        }
    } catch (const ImageMemoryExceeded&) {
        throw TotalExceeded(limits_, file);
    } catch (const Error& error) {
        report(where, error);
    }
    return use(*picture, settings, std::move(name), where);
}

void TextureTable::warn_of_nothing(const StoredImage& picture, const FileLocation& where) {
    if (picture.held.are_none()) {
        diagnostics_.warning(where, std::string("texture: ") + kNoPixelsHeld);
    }
}

void TextureTable::report(const FileLocation& where, const Error& error) {
    const std::string message = std::string("texture: ") + error.what();
    if (error.kind() == ErrorKind::Resource) {
        throw Error(ErrorKind::Resource, to_string({Severity::Error, where, message}));
    }
    diagnostics_.error(where, message);
}

std::optional<TextureId> TextureTable::add(std::string_view encoded, const ImageTexture& settings,
                                           std::string name, const FileLocation& where) {
    const auto [entry, fresh] = embedded_.try_emplace({encoded.data(), encoded.size()});
    try {
        if (fresh) {
            // Shared bytes count once per image, which bounds the decoding time.
            count(encoded.size(), name);
            entry->second.image = decoded([&](const ImageLimits& limits) {
                return decode_stored_image(encoded, name, limits);
            });
            warn_of_nothing(*entry->second.image, where);
        }
    } catch (const ImageMemoryExceeded&) {
        throw TotalExceeded(limits_, name);
    } catch (const TotalExceeded&) {
        throw;
    } catch (const Error& error) {
        report(where, error);
    }
    return use(entry->second, settings, std::move(name), where);
}

void TextureTable::derive(TextureId id, const std::string& key,
                          const std::function<StoredImage(const StoredImage&)>& make) {
    TextureDescription& description = scene_.textures[std::size_t(id)];
    auto& texture = std::get<ImageTexture>(description.texture);
    const std::shared_ptr<const StoredImage> source = texture.image;
    const auto [entry, fresh] = derived_.try_emplace({source, key});
    if (fresh) {
        count(3 * std::uint64_t(source->width) * std::uint64_t(source->height), description.name);
        entry->second = std::make_shared<const StoredImage>(make(*source));
        count(MipPyramid::memory_bytes_for(*entry->second), description.name);
    }
    texture.image = entry->second;
}

std::optional<TextureId> TextureTable::use(Picture& picture, const ImageTexture& settings,
                                           std::string name, const FileLocation& where) {
    if (!picture.image) return std::nullopt;
    if (has_pyramid(settings.filter) &&
        !std::exchange(picture.counted_pyramid[settings.decode_srgb ? 1 : 0], true)) {
        count(MipPyramid::memory_bytes_for(*picture.image), name);
    }
    ImageTexture texture = settings;
    texture.image = picture.image;
    scene_.textures.push_back({std::move(name), std::move(texture), where});
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

}  // namespace alhazen
