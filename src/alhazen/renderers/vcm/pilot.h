#pragma once
/// A pilot run before a picture, which determines whether merging vertices pays.
///
/// Source: Grittmann, Yazici, Georgiev and Slusallek, "Efficiency-Aware Multiple Importance
/// Sampling for Bidirectional Rendering Algorithms", SIGGRAPH 2022 (decision by variance times
/// cost, measured beforehand at low resolution). Differs: one decision per picture, between whole
/// methods that are run separately. Noise hidden because few samples all miss rare contributions is
/// detected by the difference of the method's mean from that with merging. Conventions: costs are
/// counted, not timed: the decision is the same on every machine, for any threads and tiles. The
/// whole frame is covered, regardless of the crop.

#include <string>

#include "alhazen/renderers/vcm/vcm_passes.h"

namespace alhazen {

struct PilotFinding {
    bool pays = true;      ///< merging pays
    bool complete = true;  ///< false after a stop
    std::string sentence;  ///< states the result
};

/// `settings`: resolved for the frame of `film`.
[[nodiscard]] PilotFinding make_pilot_run(const RenderJob& job, const Film& film,
                                          const VcmSettings& settings);

}  // namespace alhazen
