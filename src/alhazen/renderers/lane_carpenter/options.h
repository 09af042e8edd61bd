#pragma once
/// Options of the renderers `lane_carpenter` and `clark`.

namespace alhazen {

/// What becomes of the gaps between parts of different subdivision.
enum class Cracks {
    Show,     ///< as subdivision leaves them
    Tighter,  ///< the tolerance is halved until no sample lies in one
    Clark,    ///< a straight edge stays straight: there are none
};

enum class SplitRule {
    Needed,  ///< along a direction that is not flat
    Both,    ///< always into four
};

struct ScanLineOptions {
    double flatness = 0.125;  ///< pixels
    Cracks cracks = Cracks::Clark;
    SplitRule split = SplitRule::Needed;
    bool all_first = false;    ///< subdivide all patches before the first scan line (Clark 1979)
    bool find_cracks = false;  ///< count the samples in cracks
};

}  // namespace alhazen
