#pragma once
/// The importance of a node of the light tree: an estimate of the light that it sends to a point.
///
/// For a node of intensity I with the mean axis m (shorter than 1 where axes differ) and the
/// variance v of places along an axis, and a point at the offset x with the normal n:
///     I (a + sqrt(a^2 + s x^2 + v)) (c + sqrt(c^2 + v)) / (x^2 + v)^2,
///     a = -m x, c = n x, s = max(kTurned (1 - m^2), kLeastTurn).
/// (a + sqrt(a^2 + s x^2)) / 2 estimates the mean of max(0, cosine) |x| over the lights: exactly
/// where all axes are equal, and where they are all directions alike. The term v does the same for
/// different places. Of two-sided nodes, and points that light from both sides reaches, the roots
/// count twice instead, without a or c.
///
/// Conventions: numbers are float, in the frame of the tree; sums are from left to right.
/// An importance is 0 only if all lights of the node are behind the surface, or a point outside of
/// all their cones. It is positive for every other light, whatever is rounded: the terms
/// kLeastTurn, kGrazing and LightTree::Node::variance make each root larger than the number
/// beside it by more than a rounding.

#include <array>

#include "alhazen/illumination/light_tree.h"

namespace alhazen {

/// The factor s for axes that are all directions alike: the mean of max(0, cosine) is 1 / 4.
inline constexpr float kTurned = 0.25f;
inline constexpr float kLeastTurn = 1e-6f;
/// The square of an angle by which a node may be below the horizon, for the rounding of offsets.
inline constexpr float kGrazing = 1e-9f;
/// Points that are farther away are moved to this distance.
inline constexpr double kFarFromLights = 1e5;

/// A point in the frame of a tree.
struct PointOfTree {
    PointOfTree(const LightTree& tree, const LitPoint& at);

    float point[3], normal[3];
    bool both_sides, in_volume;
};

/// The importances of the children of a node. `cones`: null, if the tree has none.
[[nodiscard]] std::array<float, LightTree::kWidth> importances(const LightTree::Node& node,
                                                               const LightTree::Cones* cones,
                                                               const PointOfTree& at);

}  // namespace alhazen
