#pragma once
/// Text of BRL-CAD's shaders: names and parameters.
///
/// Source: BRL-CAD, manual pages of `rt` and of its shaders.
/// Conventions: both forms of the files, `stack checker a=255,0,0;plastic sh=4` and
/// `stack {{checker {a {255 0 0}}} {plastic {sh 4}}}`, give the same list. A parameter is a word;
/// its values are the numbers after it.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct BrlcadShader {
    std::string name;
    std::vector<std::pair<std::string, std::vector<double>>> parameters;

    /// The values of the last parameter with one of these names; null if there is none.
    [[nodiscard]] const std::vector<double>* find(std::string_view long_name,
                                                  std::string_view short_name = {}) const;
    /// The first value; none if there is none.
    [[nodiscard]] std::optional<double> number(std::string_view long_name,
                                               std::string_view short_name = {}) const;
    /// The first three values; none if there are fewer.
    [[nodiscard]] std::optional<Rgb> three(std::string_view long_name,
                                           std::string_view short_name = {}) const;
};

/// The shaders of a text, in order; `stack` and `envmap` are shaders themselves and precede those
/// that they contain. Empty for an empty text.
[[nodiscard]] std::vector<BrlcadShader> read_brlcad_shaders(const std::string& text);

}  // namespace alhazen
