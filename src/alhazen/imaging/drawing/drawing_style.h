#pragma once
/// The styles that both writers of drawings share.

#include <array>

#include "alhazen/imaging/drawing/drawing.h"

namespace alhazen {

struct LineLook {
    const char* name;
    double width;                ///< pixels
    std::array<double, 2> dash;  ///< drawn and skipped lengths; 0: solid
};

/// [LineStyle]
inline constexpr std::array<LineLook, 3> kLineLooks{
    {{"hidden", 0.5, {3, 2}}, {"crease", 0.6, {0, 0}}, {"silhouette", 1.4, {0, 0}}}};

[[nodiscard]] inline const LineLook& look_of(LineStyle style) {
    return kLineLooks[static_cast<std::size_t>(style)];
}

/// Width of the line around each region in its own colour, for writers that cannot switch
/// antialiasing off: no gap shows between regions.
inline constexpr double kSeam = 0.3;

}  // namespace alhazen
