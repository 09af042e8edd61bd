#pragma once
/// The exact solids of a scene, shot once more with 113 bits: whether every crossing is
/// there, where it is, and whether the bounds of errors hold.
///
/// Conventions: each stored shape and CSG object by itself, in the frame of its aggregate, with the
/// placement that it has there; whole lines, a third of them aimed to graze. What is found is right
/// where it says inside and outside as the truth does, but for points that are nearer to the true
/// surface than the bound of the error that the tracer itself states (twice the largest
/// `Surface::error`, and what the ray's own numbers round). Anything else is a disagreement. Points
/// must be within `Surface::error` of the true surface; beyond an edge, within the ray's bound of
/// it. Shapes and CSG objects without a formula (exact_crossings.h) are named, not checked; meshes
/// are no matter of this. Rays are checked on all cores.

#include <cstdint>

#include "alhazen/verification/verify.h"

namespace alhazen {

/// A solid that was not checked, and why.
struct UncheckedSolid {
    std::string name;    ///< as in `SolidScene`, with its number: "3 cup"
    std::string reason;  ///< "a superellipsoid has no formula"
};

struct ExactReport {
    std::uint64_t solids = 0;     ///< stored shapes and CSG objects that were checked
    std::uint64_t unchecked = 0;  ///< closed shapes and CSG objects without a formula, or too many
    std::uint64_t left_out = 0;   ///< of these, those that have one: too many
    std::uint64_t triangles = 0;  ///< of meshes, which have no formula here
    std::vector<UncheckedSolid> unchecked_solids;  ///< the first of them that have no formula
    std::uint64_t rays = 0, crossings = 0;
    /// Rays that differ from the truth for longer than the bound, nearer to the surface than it.
    std::uint64_t grazing = 0;
    std::uint64_t disagreements = 0;
    /// Largest distance of a crossing from its true place where rays do not graze, and of a
    /// point from the true surface, as shares of their bounds.
    double worst_crossing = 0, worst_point = 0;
    std::vector<Disagreement> reported;

    [[nodiscard]] bool holds() const { return disagreements == 0; }
};

/// Spreads options.rays over the solids. Throws Error.
[[nodiscard]] ExactReport verify_exact(const SceneDescription& description,
                                       const VerifyOptions& options);

}  // namespace alhazen
