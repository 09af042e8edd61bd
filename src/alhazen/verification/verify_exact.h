#pragma once
/// Compares the solids of a scene with their exact crossings in 113 bits: whether all crossings are
/// found, at the right places, and whether the error bounds hold.
///
/// Conventions: each stored shape and CSG object is tested separately, in the frame of its
/// aggregate, with its placement there. Rays are whole lines, a third of them nearly tangent. A
/// result is correct if it agrees with the exact one about inside and outside, except at points
/// nearer to the true surface than the error bound of the ray tracer (twice the largest
/// `Surface::error`, plus the rounding of the ray's own numbers). Everything else is a
/// disagreement. Points must be within `Surface::error` of the true surface; beyond an edge, within
/// the ray's bound of it. Shapes and CSG objects without a formula (exact_crossings.h) are listed,
/// not checked; meshes are not checked. Rays are checked on all cores.

#include <cstdint>

#include "alhazen/verification/verify.h"

namespace alhazen {

/// A solid that was not checked, with the reason.
struct UncheckedSolid {
    std::string name;    ///< as in `SolidScene`, with its number: "3 cup"
    std::string reason;  ///< "a superellipsoid has no formula"
};

struct ExactReport {
    std::uint64_t solids = 0;     ///< stored shapes and CSG objects that were checked
    std::uint64_t unchecked = 0;  ///< closed shapes and CSG objects without a formula, or too many
    std::uint64_t left_out = 0;   ///< unchecked solids that have a formula: too many solids
    std::uint64_t triangles = 0;  ///< in meshes, which have no formula
    std::vector<UncheckedSolid> unchecked_solids;  ///< the first ones without a formula
    std::uint64_t rays = 0, crossings = 0;
    /// Rays that differ from the exact result by more than the bound in t, but stay nearer to the
    /// surface than it.
    std::uint64_t grazing = 0;
    std::uint64_t disagreements = 0;
    /// Largest distances of a crossing from its true place, for rays that do not graze, and of a
    /// point from the true surface, relative to their bounds.
    double worst_crossing = 0, worst_point = 0;
    std::vector<Disagreement> reported;

    [[nodiscard]] bool holds() const { return disagreements == 0; }
};

/// Distributes options.rays over the solids. Throws Error.
[[nodiscard]] ExactReport verify_exact(const SceneDescription& description,
                                       const VerifyOptions& options);

}  // namespace alhazen
