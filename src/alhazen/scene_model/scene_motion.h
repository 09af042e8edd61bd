#pragma once
/// The motion of a scene and the shutter interval.
///
/// Conventions: times of a description are in the unit of its file (seconds in glTF). Times of a
/// compiled scene are relative: the shutter opens at 0 and closes at 1.

#include <vector>

#include "alhazen/geometry/motion/transform_motion.h"

namespace alhazen {

struct Shutter {
    double open = 0, close = 1;  ///< equal: nothing moves
    friend bool operator==(const Shutter&, const Shutter&) = default;
};

/// The motion of a part: at the time of a key, object_from_part = outer * key * inner.
struct PartMotion {
    Affine outer;
    std::vector<TransformKey> keys;
    Affine inner;

    [[nodiscard]] Affine at(double time) const {
        return outer * TransformMotion(keys).at(time).outer_from_inner * inner;
    }
};

/// The scale of relative times if the shutter opens and closes at once: so large that nothing
/// moves.
inline constexpr double kMoment = 0x1p60;

/// `keys` with relative times; Keys: a range of any struct with a member `time`.
template <class Keys>
[[nodiscard]] Keys relative_to(const Shutter& shutter, Keys keys) {
    const double length = shutter.close - shutter.open;
    const double scale = length > 0.0 ? 1.0 / length : kMoment;
    for (auto& key : keys) key.time = (key.time - shutter.open) * scale;
    return keys;
}

struct SceneDescription;

/// Sets the shutter, and puts moving parts and meshes where they are as it opens.
void open_shutter(SceneDescription& description, const Shutter& shutter);
/// False if parts and meshes are the same at every time.
[[nodiscard]] bool geometry_moves(const SceneDescription& description);
/// False if the scene is the same at every time.
[[nodiscard]] bool has_motion(const SceneDescription& description);

}  // namespace alhazen
