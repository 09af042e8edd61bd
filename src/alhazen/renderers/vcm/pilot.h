#pragma once
/// A pilot run before a picture: whether merging vertices pays.
///
/// Source: Grittmann, Yazici, Georgiev and Slusallek, "Efficiency-Aware Multiple Importance
/// Sampling for Bidirectional Rendering Algorithms", SIGGRAPH 2022 (variance times cost decides,
/// measured beforehand at low resolution). Differs: one decision for a picture, between whole
/// methods, each run by itself. Noise that a method hides, because few samples all miss what is
/// rare, shows by the distance of its mean from that with merging. Conventions: costs are counted,
/// not timed: the decision is the same on every machine, for any threads and tiles. The whole frame
/// is looked at, whatever the crop.

#include <string>

#include "alhazen/renderers/vcm/vcm_passes.h"

namespace alhazen {

struct PilotFinding {
    bool pays = true;      ///< merging
    bool complete = true;  ///< false after a stop
    std::string sentence;  ///< that says so
};

/// `settings`: resolved for the frame of `film`.
[[nodiscard]] PilotFinding make_pilot_run(const RenderJob& job, const Film& film,
                                          const VcmSettings& settings);

}  // namespace alhazen
