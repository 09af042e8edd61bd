#pragma once
/// The solids of a scene that `verify_exact` checks, in traced and exact form; names and reasons of
/// the unchecked solids.
///
/// Conventions: each stored shape and CSG object counts once, in the frame of its aggregate,
/// including those in instances. Internal to this folder.

#include <memory>
#include <string>
#include <vector>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/scene/scene.h"
#include "alhazen/solids/solid_list.h"
#include "alhazen/verification/exact_crossings.h"
#include "alhazen/verification/verify_exact.h"

namespace alhazen {

/// One solid: its traced form and its exact crossings.
struct ExactSolid {
    std::shared_ptr<const Aggregate> aggregate;
    const CsgSolid* csg = nullptr;
    /// Reason why it is not checked; empty if it is.
    std::string reason;
    /// The aggregate that stores the shape, or the CSG object itself.
    const Aggregate* stored_in = nullptr;
    PrimitiveId shape = kNoPrimitive;
    /// List of this solid only, which tells whether lines begin inside.
    std::shared_ptr<const SolidList> solids;

    [[nodiscard]] bool begins_inside(const Ray& ray) const;
    [[nodiscard]] ExactCrossings crossings(const ExactLine& line, Real128 least) const;
    /// The distance along the line from its origin to the nearest surface of the solid, or of any
    /// leaf (boundaries between media included).
    [[nodiscard]] Real128 nearest(const ExactLine& line, bool of_any_leaf) const;
};

/// All solids that the aggregate stores.
[[nodiscard]] std::vector<ExactSolid> exact_solids(
    const std::shared_ptr<const Aggregate>& aggregate);

/// The first solids without a formula, each with its first placement.
[[nodiscard]] std::vector<UncheckedSolid> unchecked_solids(const std::vector<ExactSolid>& all,
                                                           const SceneDescription& description,
                                                           const Scene& scene);

}  // namespace alhazen
