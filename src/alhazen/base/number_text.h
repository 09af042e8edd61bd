#pragma once
/// Formats numbers for messages.
///
/// Source: std::to_chars.
/// Conventions: the shortest text that reads back as the same number, such as 1e+150 or 1e-75.

#include <array>
#include <charconv>
#include <string>

namespace alhazen {

inline std::string shortest(double value) {
    std::array<char, 32> text{};
    char* const end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return std::string(text.data(), end);
}

}  // namespace alhazen
