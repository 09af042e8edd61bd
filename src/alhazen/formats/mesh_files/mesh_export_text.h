#pragma once
/// Text output common to OBJ and MTL: names are spelt identically in both files.

#include <array>
#include <charconv>
#include <string>
#include <vector>

#include "alhazen/formats/text/unique_labels.h"

namespace alhazen {

/// Appends a blank and the shortest text that reads back as `value`.
inline void append_number(std::string& out, double value) {
    std::array<char, 40> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    out += ' ';
    out.append(buffer.data(), end);
}

/// A name for a line of its own, without control characters and surrounding blanks.
inline std::string one_line(std::string line) {
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '_';
    }
    const std::size_t first = line.find_first_not_of(' ');
    if (first == std::string::npos) return {};
    line = line.substr(first, line.find_last_not_of(' ') - first + 1);
    // A backslash at the end of the line would continue the line.
    if (line.back() == '\\') line.back() = '_';
    return line;
}

/// The name of an object or a material, without what would begin a comment.
inline std::string one_name(const std::string& text) {
    std::string name = one_line(text);
    if (name == "#" || name.starts_with("# ")) name.front() = '_';
    for (std::size_t at = name.find(" #"); at != name.npos; at = name.find(" #", at + 1)) {
        if (at + 2 == name.size() || name[at + 2] == ' ') name[at] = '_';
    }
    return name;
}

/// A name for each object of an OBJ, all different: readers join objects of equal name. `kind`
/// replaces an empty name.
template <class Objects>
[[nodiscard]] std::vector<std::string> object_names(const Objects& objects,
                                                    const std::string& kind) {
    std::vector<std::string> names;
    for (const auto& object : objects) names.push_back(one_name(object.name));
    return unique_labels(names, kind);
}

}  // namespace alhazen
