#pragma once
/// Lower case for names that are compared: suffixes of files, keywords of formats.
///
/// Conventions: changes A to Z only, in every locale; all other bytes are kept.

#include <filesystem>
#include <string>

namespace alhazen {

[[nodiscard]] inline std::string lower_case(std::string text) {
    for (char& c : text) {
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    }
    return text;
}

/// The suffix of a file name in lower case with its dot, such as ".png" for "Picture.PNG"; empty if
/// there is none.
[[nodiscard]] inline std::string lower_suffix(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

}  // namespace alhazen
