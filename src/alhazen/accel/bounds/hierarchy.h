#pragma once
/// A hierarchy of bounds traversed depth first.
///
/// Source: Foley, van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., section 15.10.2
/// (HIER_traverse); Kay and Kajiya, SIGGRAPH 1986 (the hierarchy, by median splits).
/// Differs: `order=nearest` visits the nearest child first; the source leaves the order open.
/// Complexity: O(n log n) to build, O(log n) per ray for tight bounds.

#include <variant>

#include "alhazen/accel/bounds/bound_kind.h"
#include "alhazen/accel/bounds/depth_first.h"
#include "alhazen/accel/core/accelerator.h"

namespace alhazen {

/// A hierarchy of one of the kinds of bounds.
using AnyBoundTree = std::variant<BoundTree<BoxBound>, BoundTree<SphereBound>,
                                  BoundTree<SlabBound<7>>, BoundTree<SlabBound<13>>>;
[[nodiscard]] AnyBoundTree median_split_tree(const BoundsSource& source, NestingBound bound);
[[nodiscard]] std::size_t memory_bytes(const AnyBoundTree& tree);

class Hierarchy {
  public:
    static constexpr const char* kName = "hierarchy";
    static constexpr const char* kDescription = "bounds in a hierarchy, traversed depth first";
    struct Config {
        NestingBound bound = NestingBound::Box;
        ChildOrder order = ChildOrder::NearestFirst;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader) {
        static constexpr const char* kOrders[] = {"stored", "nearest"};
        return {read_nesting_bound(reader, NestingBound::Box),
                static_cast<ChildOrder>(
                    reader.choice("order", "order of the children of a node", 1, kOrders))};
    }

    [[nodiscard]] static Hierarchy build(const BoundsSource& source, const Config& config) {
        return {median_split_tree(source, config.bound), config.order};
    }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        std::visit(
            [&](const auto& tree) { traverse_depth_first(tree, order_, ray, visitor, stats); },
            tree_);
    }

    [[nodiscard]] std::size_t memory_bytes() const { return alhazen::memory_bytes(tree_); }
    [[nodiscard]] const AnyBoundTree& tree() const { return tree_; }

  private:
    Hierarchy(AnyBoundTree tree, ChildOrder order) : tree_(std::move(tree)), order_(order) {}

    AnyBoundTree tree_;
    ChildOrder order_;
};
static_assert(Accelerator<Hierarchy>);

}  // namespace alhazen
