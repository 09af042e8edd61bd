// Images: what their bytes say they are.
#include <cstdint>

#include "alhazen/base/file.h"
#include "alhazen/importers/gltf_readers.h"

namespace alhazen::gltf {

namespace {

unsigned byte_at(std::string_view bytes, std::size_t i) {
    return static_cast<unsigned char>(bytes[i]);
}

bool begins_with(std::string_view bytes, std::string_view start) {
    return bytes.substr(0, start.size()) == start;
}

/// "image/png" and the like; empty when the first bytes are of no format that glTF knows.
std::string media_type_of(std::string_view bytes) {
    if (begins_with(bytes, "\x89PNG\r\n\x1a\n")) return "image/png";
    if (begins_with(bytes, "\xff\xd8\xff")) return "image/jpeg";
    if (begins_with(bytes, "RIFF") && bytes.substr(8, 4) == "WEBP") return "image/webp";
    return "";
}

/// Walks the segments up to the one with the picture's size: why that fails, or nothing.
std::string jpeg_refusal(std::string_view bytes) {
    std::size_t position = 2;
    while (true) {
        if (bytes.size() - position < 4) return "the JPEG data ends within its header";
        if (byte_at(bytes, position) != 0xFF) return "malformed JPEG data";
        const unsigned marker = byte_at(bytes, position + 1);
        if (marker == 0xFF) {  // padding
            ++position;
            continue;
        }
        const bool is_frame =
            marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
        const std::size_t length =
            256 * byte_at(bytes, position + 2) + byte_at(bytes, position + 3);
        if (length < 2) return "a segment of the JPEG data has an invalid length";
        if (bytes.size() - position - 2 < length) return "the JPEG data ends within its header";
        if (is_frame) return length < 8 ? "malformed JPEG data" : "";
        if (marker == 0xD9 || marker == 0xDA) return "the JPEG data has no frame";
        position += 2 + length;
    }
}

std::string png_refusal(std::string_view bytes) {
    constexpr std::size_t kHeader = 8 + 8 + 13 + 4;
    if (bytes.size() < kHeader) return "the PNG data ends within its header";
    return bytes.substr(12, 4) == "IHDR" ? "" : "the PNG data does not begin with IHDR";
}

void check_bytes(const Loading& loading, const Image& image, const std::string& place,
                 std::string_view bytes) {
    const std::string type = media_type_of(bytes);
    if (type.empty()) {
        loading.warning(place, "the image is neither PNG nor JPEG");
        return;
    }
    if (!image.mime_type.empty() && image.mime_type != type &&
        begins_with(image.mime_type, "image/")) {
        loading.error(place, "the image is " + type + ", declared is " + image.mime_type);
        return;
    }
    const std::string refusal = type == "image/png"    ? png_refusal(bytes)
                                : type == "image/jpeg" ? jpeg_refusal(bytes)
                                                       : "";
    if (!refusal.empty()) loading.error(place, refusal);
}

}  // namespace

void check_images(const Loading& loading) {
    const Document& document = loading.document;
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        const Image& image = document.images[i];
        const std::string place = pointer_to("images", i);
        if (!image.data.empty()) {
            check_bytes(loading, image, place, image.data);
        } else if (image.view) {
            const BufferView& view = document.views[*image.view];
            const std::size_t size = document.buffers[view.buffer].bytes.size();
            // A view that leaves its buffer was reported already.
            if (view.offset <= size && view.length <= size - view.offset) {
                check_bytes(loading, image, place, bytes_of(document, view));
            }
            if (view.stride != 0) loading.error(place, "the buffer view must not have a stride");
        } else {
            try {
                const auto path = resolve_inside(loading.root, loading.folder, image.uri);
                check_bytes(loading, image, place,
                            read_file(path, loading.source.options.max_included_bytes));
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::Resource) throw;
                loading.error(place + "/uri", error.what());
            }
        }
    }
}

}  // namespace alhazen::gltf
