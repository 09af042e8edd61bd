#include "alhazen/accel/cells/octree_cells.h"

#include <algorithm>
#include <numeric>

#include "alhazen/accel/cells/cell_limits.h"
#include "alhazen/base/error.h"

namespace alhazen {

namespace {

/// Least width of the root along an axis, as a share of the largest.
constexpr double kLeastShare = 0.25;
/// Number of first levels, which cut off the empty space around a heap.
constexpr int kLevelsAroundHeaps = 3;

}  // namespace

OctreeCells::OctreeCells(const BoundsSource& source, int max_depth, int leaf_size)
    : space_(source), max_depth_(max_depth) {
    if (source.size() == 0) return;
    Box3& box = space_.box;
    // Cells thinner than their primitives would only multiply the entries.
    const double least = std::max(kLeastShare * max_component(box.size()), 4 * space_.pad);
    for (int k = 0; k < 3; ++k) {
        if (box.hi[k] - box.lo[k] < least) box.hi[k] = box.lo[k] + least;
        unit_size_[k] = (box.hi[k] - box.lo[k]) / (std::int32_t{1} << max_depth_);
        per_unit_size_[k] = (std::int32_t{1} << max_depth_) / (box.hi[k] - box.lo[k]);
    }
    std::vector<std::uint32_t> inside(source.size());
    std::iota(inside.begin(), inside.end(), 0u);
    nodes_.emplace_back();
    divide(0, std::move(inside), source, leaf_size);
}

Box3 OctreeCells::cell_box(const Node& node) const {
    Box3 b;
    for (int k = 0; k < 3; ++k) {
        const std::int32_t from = node.origin[static_cast<std::size_t>(k)];
        b.lo[k] = plane(k, from) - space_.pad;
        b.hi[k] = plane(k, from + span(node)) + space_.pad;
    }
    return b;
}

void OctreeCells::make_leaf(std::uint32_t index, const std::vector<std::uint32_t>& inside) {
    if (entries_.size() + inside.size() > 0xFFFFFFFFu) {
        throw Error(ErrorKind::Resource, "octree: more than 4294967295 entries in its leaves");
    }
    nodes_[index].first = static_cast<std::uint32_t>(entries_.size());
    nodes_[index].count = static_cast<std::uint32_t>(inside.size());
    entries_.insert(entries_.end(), inside.begin(), inside.end());
}

void OctreeCells::divide(std::uint32_t index, std::vector<std::uint32_t> inside,
                         const BoundsSource& source, int leaf_size) {
    if (inside.size() <= static_cast<std::size_t>(leaf_size) || nodes_[index].level >= max_depth_) {
        return make_leaf(index, inside);
    }
    const std::int32_t half = span(nodes_[index]) / 2;
    std::array<Node, 8> children;
    std::array<std::vector<std::uint32_t>, 8> parts;
    std::size_t sum = 0, used = 0;
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        Node& child = children[octant];
        child = {0,
                 0,
                 index,
                 nodes_[index].origin,
                 static_cast<std::uint8_t>(nodes_[index].level + 1),
                 static_cast<std::uint8_t>(octant),
                 true};
        for (std::size_t k = 0; k < 3; ++k) {
            if ((octant >> k & 1) != 0) child.origin[k] += half;
        }
        const Box3 cell = cell_box(child);
        for (const std::uint32_t i : inside) {
            if (source.overlaps(i, cell)) parts[octant].push_back(i);
        }
        sum += parts[octant].size();
        used += !parts[octant].empty();
    }
    // Most primitives lie in most children: they fill the cell, and smaller cells would not
    // separate them.
    if (sum > 5 * inside.size()) return make_leaf(index, inside);
    // A heap of overlapping primitives.
    if (inside.size() >= kHeap && used > 1 && nodes_[index].level >= kLevelsAroundHeaps &&
        static_cast<double>(sum) >= kSameCells * static_cast<double>(used * inside.size())) {
        return make_leaf(index, inside);
    }
    if (nodes_.size() + 8 >= kNone) {
        throw Error(ErrorKind::Resource, "octree: more than 4294967286 nodes");
    }
    inside = {};
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[index].leaf = false;
    nodes_[index].first = first;
    nodes_.insert(nodes_.end(), children.begin(), children.end());
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
        divide(first + octant, std::move(parts[octant]), source, leaf_size);
    }
}

}  // namespace alhazen
