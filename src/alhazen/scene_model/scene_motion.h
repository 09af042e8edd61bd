#pragma once
/// What moves in a scene, and the time during which the shutter is open.
///
/// Conventions: times of a description are in the unit of its file (seconds in glTF); those of a
/// compiled scene are relative: 0, the shutter opens, to 1, it closes.

#include <vector>

#include "alhazen/geometry/motion/transform_motion.h"

namespace alhazen {

struct Shutter {
    double open = 0, close = 1;  ///< equal: nothing moves
    friend bool operator==(const Shutter&, const Shutter&) = default;
};

/// A part that moves: at the time of a key, object_from_part = outer * key * inner.
struct PartMotion {
    Affine outer;
    std::vector<TransformKey> keys;
    Affine inner;

    [[nodiscard]] Affine at(double time) const {
        return outer * TransformMotion(keys).at(time).outer_from_inner * inner;
    }
};

/// Where the shutter is open for no time all others are so far away that nothing moves.
inline constexpr double kMoment = 0x1p60;

/// `keys`, of any struct with a member `time`, with relative times.
template <class Keys>
[[nodiscard]] Keys relative_to(const Shutter& shutter, Keys keys) {
    const double length = shutter.close - shutter.open;
    const double scale = length > 0.0 ? 1.0 / length : kMoment;
    for (auto& key : keys) key.time = (key.time - shutter.open) * scale;
    return keys;
}

struct SceneDescription;

/// Sets the shutter, and the parts and meshes that move to where they are as it opens.
void open_shutter(SceneDescription& description, const Shutter& shutter);
/// False: every time shows the same.
[[nodiscard]] bool has_motion(const SceneDescription& description);

}  // namespace alhazen
