#pragma once
/// glTF animations at one time: the channels of a document change a pose.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.11 and appendix C.
/// Differs: nothing. Conventions: seconds; before the first and after the last key the value of
/// that key; linear rotations take the shorter way around.

#include <span>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/gltf/document/gltf_budget.h"
#include "alhazen/formats/gltf/scene/gltf_pose.h"

namespace alhazen::gltf {

/// The keys of one sampler. `values` holds `width` numbers a key; three times as many for cubic
/// splines (in-tangent, value, out-tangent).
struct Keys {
    std::vector<double> times;  ///< ascending
    std::vector<double> values;
    std::size_t width = 1;
    Interpolation interpolation = Interpolation::Linear;
};

/// The value at `time`, `width` numbers; linear ones component by component.
[[nodiscard]] std::vector<double> value_at(const Keys& keys, double time);
/// The same for quaternions (width 4): spherical where linear, unit in any case.
[[nodiscard]] Quaternion rotation_at(const Keys& keys, double time);

/// Applies the animations that `options` chooses at options.time to `pose`; nothing without a time.
/// Throws Error (Usage) when options.animation is neither a name nor a position in the file; the
/// message lists what there is.
void apply_animations(const Document& document, const ImportSource& source, Pose& pose,
                      Budget& budget, Diagnostics& diagnostics);

}  // namespace alhazen::gltf
