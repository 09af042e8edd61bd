#pragma once
/// A hierarchy of boxes built by inserting primitives one by one where the expected cost grows
/// least.
///
/// Source: Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray Tracing", IEEE
/// CG&A 7(5), 1987.
/// Differs: of children with equal growth, the search descends into the smaller one, then into the
/// one with fewer primitives (equal growth, often of zero, would make chains); it leaves a path
/// where the inherited cost exceeds the best position so far (Haines, Ray Tracing News). `reinsert`
/// removes primitives and inserts them again, which the source does not do (Bittner, Hapala and
/// Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", CGF 32(1), 2013).
/// Complexity: O(n log n) expected for each order tried.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/accel/bounds/depth_first.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

/// The expected number of bounds tested by a ray that intersects the root: 1 + sum over the inner
/// nodes of k A / A(root), with k children and area A. 0 for an empty tree.
[[nodiscard]] double goldsmith_salmon_cost(const BoundTree<BoxBound>& tree);

class GoldsmithSalmon {
  public:
    static constexpr const char* kName = "goldsmith_salmon";
    static constexpr const char* kDescription =
        "hierarchy of boxes, each primitive inserted where the cost grows least";
    struct Config {
        int orders = 1;  ///< random orders of insertion to try, keeping the cheapest tree.
                         ///< 0: the scene's order
        std::uint64_t seed = 1;
        int reinsert = 0;  ///< passes that remove every primitive and insert it again
        ChildOrder order = ChildOrder::NearestFirst;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    [[nodiscard]] static GoldsmithSalmon build(const BoundsSource& source, const Config& config);

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        traverse_depth_first(tree_, order_, ray, visitor, stats);
    }

    [[nodiscard]] std::size_t memory_bytes() const { return tree_.memory_bytes(); }
    [[nodiscard]] const BoundTree<BoxBound>& tree() const { return tree_; }

  private:
    BoundTree<BoxBound> tree_;
    ChildOrder order_ = ChildOrder::NearestFirst;
};
static_assert(Accelerator<GoldsmithSalmon>);

}  // namespace alhazen
