#pragma once
/// A hierarchy of boxes made by inserting one primitive after the other where the expected cost
/// grows least.
///
/// Source: Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray Tracing", IEEE
/// CG&A 7(5), 1987.
/// Differs: of children that grow equally the smaller one is descended into, then the one of fewer
/// primitives (equal growth, often of zero, makes chains otherwise); a path is left where what is
/// inherited costs more than the best place so far (Haines, Ray Tracing News). With `reinsert`
/// primitives are taken out and inserted again, which the source does not do (Bittner, Hapala and
/// Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", CGF 32(1), 2013).
/// Complexity: O(n log n) expected for each order that is tried.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/accel/bounds/depth_first.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

/// The expected number of bounds that a ray tests which meets the root: 1 + sum over the inner
/// nodes of k A / A(root), with k children and area A. 0 for a tree without nodes.
[[nodiscard]] double goldsmith_salmon_cost(const BoundTree<BoxBound>& tree);

class GoldsmithSalmon {
  public:
    static constexpr const char* kName = "goldsmith_salmon";
    static constexpr const char* kDescription =
        "boxes in a hierarchy, each primitive inserted where the cost grows least";
    struct Config {
        int orders = 1;  ///< random orders of insertion that are tried; the cheapest tree is kept.
                         ///< 0: the scene's own
        std::uint64_t seed = 1;
        int reinsert = 0;  ///< passes that take every primitive out and insert it again
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
