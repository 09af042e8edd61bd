#pragma once
/// URIs of buffers and images: file names or embedded data.
///
/// Source: IETF RFC 3986 (URI), RFC 2397 (data: URI), RFC 4648 (base64).
/// Differs: spaces and other characters that are invalid in a URI are accepted, since many programs
/// write plain file names. Only base64 data: URIs are read.

#include <optional>
#include <string>
#include <string_view>

namespace alhazen::gltf {

/// True if the URI begins with "data:".
[[nodiscard]] bool is_data_uri(std::string_view uri);
/// True if the URI begins with a scheme ("http:"), "//" or "/": not a file name relative to the
/// document.
[[nodiscard]] bool is_absolute_uri(std::string_view uri);
/// Decodes percent escapes; none if a percent sign is not followed by two hex digits.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view uri);
/// Decodes base64 with or without padding; none for invalid characters or an invalid length.
[[nodiscard]] std::optional<std::string> base64_decoded(std::string_view text);

struct DataUri {
    std::string media_type;  ///< "image/png", in lower case; may be empty
    std::string bytes;
};
/// Decodes a data: URI; none if it is malformed or not base64.
[[nodiscard]] std::optional<DataUri> read_data_uri(std::string_view uri);

}  // namespace alhazen::gltf
