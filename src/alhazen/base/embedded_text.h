#pragma once
/// A text file that the build writes into the program (cmake/EmbedText.cmake).

#include <span>
#include <string>
#include <string_view>

namespace alhazen {

/// The file in parts, for compilers need not take literals above 64 KiB.
using EmbeddedText = std::span<const std::string_view>;

inline void append(std::string& text, EmbeddedText embedded) {
    for (const std::string_view part : embedded) text += part;
}

[[nodiscard]] inline std::string to_string(EmbeddedText embedded) {
    std::string text;
    append(text, embedded);
    return text;
}

}  // namespace alhazen
