// Readers of images, samplers, textures, and texture references of materials.
#include <algorithm>
#include <initializer_list>
#include "alhazen/formats/gltf/document/gltf_texture_info.h"

#include "alhazen/formats/gltf/document/gltf_uri.h"

namespace alhazen::gltf {

namespace {

void read_uri(const JsonObject& object, Image& image) {
    const auto uri = object.take_text("uri");
    if (!uri) return;
    if (is_data_uri(*uri)) {
        auto data = read_data_uri(*uri);
        if (!data) return object.error("uri", "malformed data: URI");
        image.data = std::move(data->bytes);
        if (image.mime_type.empty()) image.mime_type = data->media_type;
        if (image.data.empty()) object.error("uri", "the image has no bytes");
        return;
    }
    const bool is_path = uri->starts_with('/') || uri->starts_with('\\');
    if (is_absolute_uri(*uri) && !is_path) {
        image.elsewhere = true;
        return object.warning("uri", "not relative to the file; the image is left out");
    }
    const auto name = percent_decoded(*uri);
    if (!name) {
        return object.error("uri", "malformed: % must be followed by two hexadecimal digits");
    }
    if (name->empty()) return object.error("uri", "the name of the file is empty");
    image.uri = *name;
}

Image read_image_entry(const JsonObject& object) {
    Image image;
    image.name = object.text("name").value_or("");
    image.mime_type = object.text("mimeType").value_or("");
    image.view = object.index("bufferView", Collection::BufferViews);
    if (object.has("bufferView") == object.has("uri")) {
        object.error({}, "expected one of \"uri\" and \"bufferView\"");
    }
    if (object.has("bufferView")) object.require("mimeType");
    read_uri(object, image);
    return image;
}

Filter filter_in(const JsonObject& object, std::string_view key, bool minifies) {
    const auto code = object.integer(key);
    if (!code) return Filter::Unset;
    switch (*code) {
        case 9728:
            return Filter::Nearest;
        case 9729:
            return Filter::Linear;
        case 9984:
        case 9986:
            if (minifies) return Filter::NearestMipmap;
            break;
        case 9985:
        case 9987:
            if (minifies) return Filter::LinearMipmap;
            break;
        default:
            break;
    }
    object.warning(key, "there is no filter " + std::to_string(*code) + "; ignored");
    return Filter::Unset;
}

Wrap wrap_in(const JsonObject& object, std::string_view key) {
    const auto code = object.integer(key);
    if (!code || *code == 10497) return Wrap::Repeat;
    if (*code == 33071) return Wrap::Clamp;
    if (*code == 33648) return Wrap::Mirror;
    object.warning(key, "expected 10497, 33071 or 33648; taken as 10497 (repeat)");
    return Wrap::Repeat;
}

/// Reports an error if the declared media type of a texture's source is not one of `allowed`.
void media_type(const JsonObject& texture, const std::vector<Image>& images, Index source,
                std::initializer_list<std::string_view> allowed) {
    if (source >= images.size()) return;  // reported already
    const std::string& type = images[source].mime_type;
    if (type.empty() || std::find(allowed.begin(), allowed.end(), type) != allowed.end()) return;
    // Unknown types are reported elsewhere; the content then determines the type.
    if (type != "image/jpeg" && type != "image/png" && type != "image/webp") return;
    texture.error("source", "the source must not be an image of type " + type);
}

}  // namespace

void read_textures(const JsonObject& root, Loading& loading) {
    root.each_object("images", [&](const JsonObject& object, std::size_t) {
        loading.document.images.push_back(read_image_entry(object));
    });
    root.each_object("samplers", [&](const JsonObject& object, std::size_t) {
        (void)object.text("name");
        loading.document.samplers.push_back({.magnify = filter_in(object, "magFilter", false),
                                             .minify = filter_in(object, "minFilter", true),
                                             .wrap_s = wrap_in(object, "wrapS"),
                                             .wrap_t = wrap_in(object, "wrapT")});
    });
    root.each_object("textures", [&](const JsonObject& object, std::size_t) {
        (void)object.text("name");
        loading.document.textures.push_back({object.index("sampler", Collection::Samplers),
                                             object.index("source", Collection::Images)});
        // The extension's image is not read, but its index must be valid.
        object.with_extension("EXT_texture_webp", [&](const JsonObject& extension) {
            const auto source = extension.index("source", Collection::Images);
            if (!source) return;
            media_type(extension, loading.document.images, *source, {"image/webp"});
        });
        if (const auto source = loading.document.textures.back().source) {
            const std::vector<Image>& images = loading.document.images;
            media_type(object, images, *source, {"image/jpeg", "image/png"});
            if (*source < images.size() && images[*source].elsewhere) {
                loading.document.textures.back().source.reset();
            }
        }
    });
}

std::optional<TextureInfo> read_texture_info(const JsonObject& owner, std::string_view key,
                                             std::string_view strength) {
    std::optional<TextureInfo> result;
    owner.with_object(key, [&](const JsonObject& object) {
        TextureInfo info;
        object.require("index");
        info.texture = object.index("index", Collection::Textures).value_or(0);
        const auto set = [](const JsonObject& from) {
            return from.integer("texCoord", 0, kMaxTexCoord);
        };
        info.tex_coord = static_cast<Index>(set(object).value_or(0));
        if (!strength.empty()) {
            const Range range = strength == "strength" ? kUnitRange : Range{};
            object.number_into(strength, info.strength, range);
        }
        object.with_extension("KHR_texture_transform", [&](const JsonObject& transform) {
            transform.numbers_into("offset", info.offset);
            transform.numbers_into("scale", info.scale);
            transform.number_into("rotation", info.rotation);
            if (const auto other = set(transform)) info.tex_coord = static_cast<Index>(*other);
        });
        result = info;
    });
    return result;
}

}  // namespace alhazen::gltf
