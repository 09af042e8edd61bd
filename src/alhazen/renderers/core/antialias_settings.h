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

    /// A cell is divided if its shades, clamped to 1 in each channel, differ by more than this: the
    /// permitted error of a cell as a part of the pixel's value.
    double threshold = 0.02;
    /// Above 0: pixel selection, which ignores the settings below. The first pass has a ray in one
    /// pixel of `step` in each row and column.
    int step = 0;
    int depth = 4;          ///< most divisions of a pixel, at most kDeepest
    bool guarantee = true;  ///< search for objects between the rays
    /// Search also where all corner rays hit something nearer: an object may show through a gap
    /// between them.
    bool behind_all = false;
    /// True: differences of shades are weighted by the area of their cell. False: they count in
    /// full at every level.
    bool weigh = true;
    /// A cell is also compared with the rays on its sides that neighbours have traced; a pixel next
    /// to a divided one adds its centre.
    bool neighbours = true;
    /// True: the exact mean of each pixel (Renderer::gives_exact_areas); the settings above are
    /// ignored.
    bool exact = false;
    const FilterEntry* filter = nullptr;  ///< for `exact`; null: the mean over the pixel
    double radius = 0.5;                  ///< of the filter, in pixels
    double error = 1e-4;                  ///< for `exact`: largest error of a pixel's colour
};

/// Throws Error (Usage) for an unknown name or setting and for values out of range.
[[nodiscard]] AntialiasSettings parse_antialias(const std::string& text);

}  // namespace alhazen
