#pragma once
/// Lower case for names that programs compare: suffixes of files, keywords of formats.
///
/// Conventions: A to Z only, in every locale; bytes of other characters stay as they are.

#include <filesystem>
#include <string>

namespace alhazen {

[[nodiscard]] inline std::string lower_case(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    }
    return text;
}

/// The suffix of a file's name with its dot, ".png" of "Picture.PNG"; empty without one.
[[nodiscard]] inline std::string lower_suffix(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

}  // namespace alhazen
