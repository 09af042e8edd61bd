#pragma once
/// Settings of adaptive supersampling, as `--antialias` takes them:
/// "whitted:threshold=T,depth=D,guarantee=on|off", "exact:error=E,filter=NAME,radius=R".

#include <string>

namespace alhazen {

struct FilterEntry;

struct AntialiasSettings {
    static constexpr int kDeepest = 8;

    /// Four shades whose channels, cut off at 1, differ by more than this are refined.
    double threshold = 0.05;
    int depth = 4;          ///< most divisions of a pixel, at most kDeepest
    bool guarantee = true;  ///< look for objects between the rays
    /// Instead of all above: the exact mean of each pixel, from renderers that know the areas of
    /// what they show.
    bool exact = false;
    const FilterEntry* filter = nullptr;  ///< of `exact`; null: the mean
    double radius = 0.5;                  ///< of the filter, in pixels
    double error = 1e-4;                  ///< of the colour of a pixel, of `exact`
};

/// Throws Error (Usage) for an unknown name or setting and for values out of range.
[[nodiscard]] AntialiasSettings parse_antialias(const std::string& text);

}  // namespace alhazen
