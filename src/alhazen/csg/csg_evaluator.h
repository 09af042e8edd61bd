#pragma once
/// Interface of CSG evaluators, which find where a ray enters and leaves a solid, and their table.
///
/// Conventions: transitions in [ray.t_min, ray.t_max], ascending, as csg_solid.h defines them; all
/// evaluators find the same transitions, bit for bit.
/// Threads: const functions may be called from many threads.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/csg/csg_solid.h"

namespace alhazen {

/// The leaves that fill the solid before and after a point on a ray: the lowest-numbered of the
/// leaves that make it solid there; CsgTree::kNone outside.
struct CsgSides {
    std::uint32_t before = CsgTree::kNone, after = CsgTree::kNone;
};

class CsgEvaluator {
  public:
    virtual ~CsgEvaluator() = default;
    /// The first transition; returns false and leaves `hit` unchanged if there is none.
    virtual bool first(const CsgRay& ray, Hit& hit, TraversalStats* stats) const = 0;
    /// Appends all transitions; a boundary between two media counts twice, once for each. Returns
    /// true if the ray starts inside.
    virtual bool all(const CsgRay& ray, std::vector<Hit>& hits, TraversalStats* stats) const = 0;
    /// The interface of `first` for rays in lanes; null if lanes are not faster.
    [[nodiscard]] virtual const LaneSolid* lane_solid() const { return nullptr; }
    /// The leaves on both sides of the transition at t.
    [[nodiscard]] virtual CsgSides sides(const CsgRay& ray, double t) const = 0;
    /// Bytes of the evaluator, without the solid.
    [[nodiscard]] virtual std::size_t memory_bytes() const = 0;
};

struct CsgEvaluatorEntry {
    const char* name;
    const char* description;  ///< one line
    /// Creates the evaluator, which keeps a reference to the solid.
    std::unique_ptr<const CsgEvaluator> (*make)(const CsgSolid& solid);
};

/// The evaluators, the default first.
[[nodiscard]] std::span<const CsgEvaluatorEntry> csg_evaluator_table();

inline constexpr const char* kDefaultCsgEvaluator = "event_heap";

/// The entry called `name`. Throws Error (Usage) with the valid names for an unknown one.
[[nodiscard]] const CsgEvaluatorEntry& find_csg_evaluator(const std::string& name);

}  // namespace alhazen
