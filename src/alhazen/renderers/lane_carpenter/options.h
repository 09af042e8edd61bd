#pragma once
/// Options of the renderers `lane_carpenter` and `clark`.

namespace alhazen {

/// Treatment of the gaps between parts of different subdivision.
enum class Cracks {
    Show,     ///< left as they are
    Tighter,  ///< halve the tolerance until no sample of the frame lies in one
    Clark,    ///< a straight edge stays straight, which avoids gaps
};

enum class SplitRule {
    Needed,  ///< along a direction that is not flat
    Both,    ///< always in both directions
};

struct ScanLineOptions {
    double flatness = 0.125;  ///< pixels
    Cracks cracks = Cracks::Clark;
    SplitRule split = SplitRule::Needed;
    bool all_first = false;    ///< subdivide all patches before the first scan line (Clark 1979)
    bool find_cracks = false;  ///< count the samples in cracks
};

}  // namespace alhazen
