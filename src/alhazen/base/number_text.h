#pragma once
/// Formats numbers for messages.
///
/// Source: std::to_chars.
/// Conventions: the shortest text that reads back as the number: 1e+150, not 150 digits; 1e-75, not
/// 0.000000.

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
