#pragma once
/// Evaluates glTF animations at one time: the channels of a document modify a pose.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.11 and appendix C.
/// Conventions: times in seconds. Before the first and after the last key the value of that key
/// holds. Linear interpolation of rotations takes the shorter arc.

#include <span>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/gltf/document/gltf_budget.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// Keys of one sampler. `values` has `width` numbers per key; three times as many for cubic splines
/// (in-tangent, value, out-tangent).
struct Keys {
    std::vector<double> times;  ///< ascending
    std::vector<double> values;
    std::size_t width = 1;
    Interpolation interpolation = Interpolation::Linear;
};

/// The `width` numbers at `time`; linear interpolation works per component.
[[nodiscard]] std::vector<double> value_at(const Keys& keys, double time);
/// The rotation at `time` (width 4): linear interpolation is spherical. The result is unit.
[[nodiscard]] Quaternion rotation_at(const Keys& keys, double time);

/// Applies the animations selected by `options` at options.time to `pose`; does nothing without a
/// time. Throws Error (Usage) if options.animation is neither a name nor an index in the file; the
/// message lists the animations.
void apply_animations(const Document& document, const ImportSource& source, Pose& pose,
                      Budget& budget, Diagnostics& diagnostics);

}  // namespace alhazen::gltf
