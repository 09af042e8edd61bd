#pragma once
/// Settings of adaptive supersampling, as `--antialias` takes them:
/// "whitted:threshold=T,depth=D,guarantee=on|off|all,weigh=on|off,neighbours=on|off",
/// "exact:error=E,filter=NAME,radius=R".

#include <string>

namespace alhazen {

struct FilterEntry;

struct AntialiasSettings {
    static constexpr int kDeepest = 8;
    static constexpr int kLargestStep = 64;

    /// Cells whose shades differ by more than this are divided: by so much of the pixel's value,
    /// cut off at 1 in each channel, a cell may be off.
    double threshold = 0.02;
    /// Above 0: pixel selection instead of what follows. At first one pixel in `step` of each row
    /// and column has a ray.
    int step = 0;
    int depth = 4;          ///< most divisions of a pixel, at most kDeepest
    bool guarantee = true;  ///< look for objects between the rays
    /// Look for them also where something nearer is at all corners: behind gaps that no corner ray
    /// passes.
    bool behind_all = false;
    /// Shades count as parts of the pixel: by the area of their cell. Off: as they are, cut off at
    /// 1, at every level alike.
    bool weigh = true;
    /// Cells also look at the rays of their neighbours, and pixels beside a divided one at their
    /// centre.
    bool neighbours = true;
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
