#pragma once
/// HTML fragments: escaped text, pictures and bytes as data URIs.
///
/// Source: RFC 4648 (base64), section 4; RFC 2397 (the data scheme).

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

/// Escapes text and double-quoted attributes; control characters become blanks, bytes
/// that are not UTF-8 are escaped as \x1b.
[[nodiscard]] std::string html_escaped(std::string_view text);

[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// The picture as "data:image/png;base64,...".
[[nodiscard]] std::string png_data_uri(const EncodedImage& image);

}  // namespace alhazen
