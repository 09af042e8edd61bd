#pragma once
/// What the writers of OBJ and MTL share: a name must be spelt the same in both files.
///
/// Source: none. Differs: nothing.

#include <array>
#include <charconv>
#include <string>

namespace alhazen {

/// A blank and the shortest text that reads back as `value`.
inline void append_number(std::string& out, double value) {
    std::array<char, 40> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    out += ' ';
    out.append(buffer.data(), end);
}

/// A name on a line of its own: no control characters, no blanks around it.
inline std::string one_line(std::string line) {
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
    }
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos) return {};
    line = line.substr(first, line.find_last_not_of(' ') - first + 1);
    // A backslash before the end of the line would join the next one.
    if (line.back() == '\\') line.back() = '_';
    return line;
}

}  // namespace alhazen
