#pragma once
/// The solids of a scene that `verify_exact` checks: what is traced, what is true of it, and of
/// those that it cannot check the names and the reasons.
///
/// Conventions: each stored shape and CSG object once, in the frame of its aggregate; instances
/// inward. Internal to this folder.

#include <memory>
#include <string>
#include <vector>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/scene/scene.h"
#include "alhazen/solids/solid_list.h"
#include "alhazen/verification/exact_crossings.h"
#include "alhazen/verification/verify_exact.h"

namespace alhazen {

/// A solid by itself: what is traced, and what is true.
struct ExactSolid {
    std::shared_ptr<const Aggregate> aggregate;
    const CsgSolid* csg = nullptr;
    /// Why it is not checked; empty: it is.
    std::string reason;
    /// Where it is stored: the aggregate that holds the shape, or the CSG object itself.
    const Aggregate* stored_in = nullptr;
    PrimitiveId shape = kNoPrimitive;
    /// Of this one: says where lines begin.
    std::shared_ptr<const SolidList> solids;

    [[nodiscard]] bool begins_inside(const Ray& ray) const;
    [[nodiscard]] ExactCrossings crossings(const ExactLine& line, Real128 least) const;
    /// The distance along the line from its origin to the nearest surface: of the solid, or of any
    /// leaf, as walls between media are.
    [[nodiscard]] Real128 nearest(const ExactLine& line, bool of_any_leaf) const;
};

/// All that the aggregate stores.
[[nodiscard]] std::vector<ExactSolid> exact_solids(
    const std::shared_ptr<const Aggregate>& aggregate);

/// The first solids without a formula, by the first place where each stands.
[[nodiscard]] std::vector<UncheckedSolid> unchecked_solids(const std::vector<ExactSolid>& all,
                                                           const SceneDescription& description,
                                                           const Scene& scene);

}  // namespace alhazen
