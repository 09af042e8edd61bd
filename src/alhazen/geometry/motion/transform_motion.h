#pragma once
/// A placement that changes while the shutter is open, given at some times.
///
/// Source: Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985 (slerp); Shoemake
/// and Duff, "Matrix Animation and Polar Decomposition", Graphics Interface 1992 (a matrix as
/// rotation times stretch, each interpolated in its own way).
/// Conventions: between two keys the translation and the stretch change linearly, the rotation
/// about a fixed axis by the shorter way: keys lie less than half a turn apart. Before the first
/// and after the last key nothing moves. Time 0: the shutter opens; 1: it closes; keys may lie
/// outside. At a key the placement has the key's bits.
/// Threads: const functions may be called from many.

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

/// What is wrong with keys; null where nothing is: times that do not ascend, transforms without an
/// inverse, or two that mirror differently, between which something would be flat.
[[nodiscard]] const char* fault_of(std::span<const TransformKey> keys);

class TransformMotion {
  public:
    /// Precondition: keys without fault, at least one.
    explicit TransformMotion(std::span<const TransformKey> keys);

    [[nodiscard]] Placement at(double time) const;
    /// The same in a frame around it, which rests.
    [[nodiscard]] TransformMotion inside(const Affine& outer_from_here) const;
    /// Contains the image of `inner` at every time from 0 to 1.
    [[nodiscard]] MovingBox bounds(const Box3& inner) const;

  private:
    using Quaternion = std::array<double, 4>;  ///< x, y, z, w
    struct Key {
        double time;
        Affine own;  ///< as given
        Quaternion rotation;
        Mat3 stretch;
    };
    /// Between two keys.
    struct Step {
        double angle = 0;        ///< of the rotation from one to the other, radians
        bool translates = true;  ///< and does nothing else
        Mat3 linear, inverse;    ///< where it translates: of the whole placement
    };
    /// Between key `i` and the next; `share` 0 is the key itself.
    struct Moment {
        std::size_t i;
        double share;
    };

    [[nodiscard]] Moment moment(double time) const;
    /// The transform inside of `outer_`.
    [[nodiscard]] Affine own_at(const Moment& m) const;
    void find_linear_parts();
    /// Bound of the distance of a moving point from its chord, over an n-th of a step.
    [[nodiscard]] double sag(std::size_t step, double reach, int n) const;

    std::vector<Key> keys_;
    std::vector<Step> steps_;  ///< [key before]
    Affine outer_;
    bool has_outer_ = false;
};

}  // namespace alhazen
