#pragma once
/// The addresses of buffers and images: names of files, or the bytes themselves.
///
/// Source: IETF RFC 3986 (URI), RFC 2397 (data: URI), RFC 4648 (base64).
/// Differs: spaces and other characters that a URI may not hold are taken as they stand, as many
/// programs write plain file names. Only base64 data: URIs are read.

#include <optional>
#include <string>
#include <string_view>

namespace alhazen::gltf {

/// Whether the address begins with "data:".
[[nodiscard]] bool is_data_uri(std::string_view uri);
/// Whether it begins with a scheme ("http:"), "//" or "/": no name of a file beside the document.
[[nodiscard]] bool is_absolute_uri(std::string_view uri);
/// Replaces %20 and the like; nothing when a percent sign is not followed by two hex digits.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view uri);
/// Bytes of base64 with or without its padding; nothing for characters or a length that it cannot
/// have.
[[nodiscard]] std::optional<std::string> base64_decoded(std::string_view text);

struct DataUri {
    std::string media_type;  ///< "image/png"; may be empty
    std::string bytes;
};
/// The bytes of a data: URI; nothing when it is malformed or not base64.
[[nodiscard]] std::optional<DataUri> read_data_uri(std::string_view uri);

}  // namespace alhazen::gltf
