#pragma once
/// Pieces of HTML: text made safe, pictures and bytes as data URIs.
///
/// Source: RFC 4648 (base64), section 4; RFC 2397 (the data scheme). Differs: nothing.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

/// For text and for attributes in double quotes; control characters become blanks.
[[nodiscard]] std::string html_escaped(std::string_view text);

[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// "data:image/png;base64,...".
[[nodiscard]] std::string png_data_uri(const EncodedImage& image);

}  // namespace alhazen
