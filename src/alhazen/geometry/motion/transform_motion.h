#pragma once
/// A placement that changes during the exposure, given by keys at several times.
///
/// Source: Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985 (slerp); Shoemake
/// and Duff, "Matrix Animation and Polar Decomposition", Graphics Interface 1992 (a matrix as
/// rotation times stretch, each interpolated in its own way).
/// Conventions: between two keys translation and stretch change linearly, and the rotation about a
/// fixed axis the shorter way: successive keys must be less than half a turn apart. The placement
/// is constant before the first and after the last key. Time is 0 at shutter opening and 1 at
/// closing; keys may lie outside. At a key the placement has the key's bits.
/// Threads: const functions may be called from several threads.

#include <array>
#include <span>
#include <vector>

#include "alhazen/geometry/motion/moving_box.h"
#include "alhazen/geometry/placement.h"

namespace alhazen {

struct TransformKey {
    double time = 0;
    Affine outer_from_inner;
    friend bool operator==(const TransformKey&, const TransformKey&) = default;
};

/// The fault of the keys, or null: times that do not ascend, singular transforms, or two transforms
/// of opposite handedness, between which the placement would be singular.
[[nodiscard]] const char* fault_of(std::span<const TransformKey> keys);

class TransformMotion {
  public:
    /// Precondition: at least one key, and fault_of(keys) is null.
    explicit TransformMotion(std::span<const TransformKey> keys);

    [[nodiscard]] Placement at(double time) const;
    /// The motion in an outer, static frame.
    [[nodiscard]] TransformMotion inside(const Affine& outer_from_here) const;
    /// A moving box that contains the image of `inner` at every time from 0 to 1.
    [[nodiscard]] MovingBox bounds(const Box3& inner) const;

  private:
    using Quaternion = std::array<double, 4>;  ///< x, y, z, w
    struct Key {
        double time;
        Affine own;  ///< as given by the caller
        Quaternion rotation;
        Mat3 stretch;
    };
    /// The change between two keys.
    struct Step {
        double angle = 0;        ///< of the rotation between the keys, in radians
        bool translates = true;  ///< true if only the translation changes
        Mat3 linear, inverse;    ///< of the whole placement, if `translates`
    };
    /// A time between key `i` and the next; `share` 0 is at the key.
    struct Moment {
        std::size_t i;
        double share;
    };

    [[nodiscard]] Moment moment(double time) const;
    /// The transform without `outer_`.
    [[nodiscard]] Affine own_at(const Moment& m) const;
    void find_linear_parts();
    /// A bound on the distance of a moving point from its chord, over an n-th of a step.
    [[nodiscard]] double sag(std::size_t step, double reach, int n) const;

    std::vector<Key> keys_;
    std::vector<Step> steps_;  ///< [i] from key i to the next
    Affine outer_;
    bool has_outer_ = false;
};

}  // namespace alhazen
