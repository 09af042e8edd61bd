// Checks the format of images from their first bytes.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>

#include "alhazen/base/file.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

unsigned byte_at(std::string_view bytes, std::size_t i) {
    return static_cast<unsigned char>(bytes[i]);
}

bool has_signature(std::string_view bytes, std::string_view start) {
    return bytes.substr(0, start.size()) == start;
}

/// The media type, for example "image/png"; empty if the first bytes match no format of glTF.
std::string media_type_of(std::string_view bytes) {
    if (has_signature(bytes, "\x89PNG\r\n\x1a\n")) return "image/png";
    if (has_signature(bytes, "\xff\xd8\xff")) return "image/jpeg";
    if (has_signature(bytes, "RIFF") && bytes.substr(8, 4) == "WEBP") return "image/webp";
    return "";
}

/// Number of bytes of an image that are inspected; decoding finds errors beyond.
constexpr std::size_t kHeadBytes = std::size_t{1} << 20;

/// Walks the JPEG segments up to the frame header. Returns the error message, empty on success.
std::string jpeg_refusal(std::string_view bytes) {
    constexpr int kMaxSegments = 10'000;
    std::size_t position = 2;
    for (int segment = 0; segment < kMaxSegments; ++segment) {
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
    return "";
}

std::string png_refusal(std::string_view bytes) {
    constexpr std::size_t kHeader = 8 + 8 + 13 + 4, kAround = 12;
    if (bytes.size() < kHeader) return "the PNG data ends within its header";
    const auto number_at = [&](std::size_t i) {
        return std::size_t{byte_at(bytes, i)} << 24 | byte_at(bytes, i + 1) << 16 |
               byte_at(bytes, i + 2) << 8 | byte_at(bytes, i + 3);
    };
    if (bytes.substr(12, 4) != "IHDR" || number_at(8) != 13) {
        return "the PNG data does not begin with IHDR";
    }
    if (number_at(16) == 0 || number_at(20) == 0) return "the PNG data has no pixels";
    for (std::size_t position = kHeader; bytes.size() - position >= kAround;) {
        const std::size_t length = number_at(position);
        if (bytes.substr(position + 4, 4) == "IDAT") return "";
        if (bytes.size() - position - kAround < length) break;
        position += kAround + length;
    }
    return "the PNG data ends before its pixels";
}

void check_bytes(const Loading& loading, const Image& image, const std::string& place,
                 std::string_view bytes) {
    const std::string type = media_type_of(bytes);
    if (type.empty()) {
        loading.warning(place, "the image is neither PNG nor JPEG");
        return;
    }
    if (type == "image/webp" && loading.extensions_used.count("EXT_texture_webp") == 0) {
        loading.error(place, "an image of image/webp needs the extension EXT_texture_webp");
    }
    if (!image.mime_type.empty() && image.mime_type != type &&
        has_signature(image.mime_type, "image/")) {
        loading.error(place, "the image is " + type + ", declared as " + image.mime_type);
        return;
    }
    const std::string refusal = bytes.size() == kHeadBytes ? ""
                                : type == "image/png"      ? png_refusal(bytes)
                                : type == "image/jpeg"     ? jpeg_refusal(bytes)
                                                           : "";
    if (!refusal.empty()) loading.error(place, refusal);
}

/// The first bytes of a regular file.
std::string head_of(const std::filesystem::path& path) {
    // Opening another kind of file may block, as for a FIFO.
    if (!std::filesystem::is_regular_file(path)) {
        throw Error(ErrorKind::File, path.string() + ": there is no such file");
    }
    std::ifstream file(path, std::ios::binary);
    std::string bytes(kHeadBytes, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    return bytes;
}

void check_file(const Loading& loading, const Image& image, const std::string& place) {
    try {
        const auto path = resolve_inside(loading.roots, loading.folder, image.uri);
        check_bytes(loading, image, place, head_of(path));
    } catch (const Error& error) {
        loading.error(place + "/uri", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        loading.error(place + "/uri", error.what());
    }
}

}  // namespace

void check_images(const Loading& loading) {
    const Document& document = loading.document;
    std::set<std::string> checked;  // files already checked; many images may name one
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        const Image& image = document.images[i];
        const std::string place = pointer_to("images", i);
        if (image.elsewhere) continue;
        if (!image.data.empty()) {
            check_bytes(loading, image, place, std::string_view(image.data).substr(0, kHeadBytes));
        } else if (image.view) {
            const BufferView& view = document.views[*image.view];
            const std::size_t size = document.buffers[view.buffer].bytes.size();
            // A view outside its buffer is already reported.
            if (document.buffers[view.buffer].lacks_data) {
                loading.error(place, "the image lies in a buffer without data");
            } else if (view.offset <= size && view.length <= size - view.offset) {
                check_bytes(loading, image, place, bytes_of(document, view).substr(0, kHeadBytes));
            }
            if (view.stride != 0) loading.error(place, "the buffer view must not have a stride");
        } else if (checked.insert(image.uri).second) {
            check_file(loading, image, place);
        }
    }
}

}  // namespace alhazen::gltf
