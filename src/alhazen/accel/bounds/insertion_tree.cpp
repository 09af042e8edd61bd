#include "alhazen/accel/bounds/insertion_tree.h"

#include <algorithm>

#include "alhazen/base/interruption.h"

namespace alhazen {
namespace {

BoxBound hull(const BoxBound& a, const BoxBound& b) {
    BoxBound both = a;
    both.include(b);
    return both;
}

}  // namespace

double insertion_area(const BoxBound& bound) {
    const double edges = bound.range[0].width() + bound.range[1].width() + bound.range[2].width();
    return bound.half_area() + 1e-9 * edges * edges;
}

InsertionTree::InsertionTree(std::size_t primitives) : leaf_of_(primitives, kNone) {
    nodes_.reserve(2 * primitives);
}

std::uint32_t InsertionTree::new_node() {
    if (!free_.empty()) {
        const std::uint32_t node = free_.back();
        free_.pop_back();
        nodes_[node] = {};
        return node;
    }
    nodes_.emplace_back();
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t InsertionTree::child_to_descend(const Node& node, const BoxBound& bound) const {
    struct Growth {
        double increase, area;
        std::uint32_t leaves;
        auto operator<=>(const Growth&) const = default;
    };
    std::uint32_t best = kNone;
    Growth least{};
    for (const std::uint32_t c : node.children) {
        const Node& child = nodes_[c];
        const double area = insertion_area(child.bound);
        const Growth growth{insertion_area(hull(child.bound, bound)) - area, area, child.leaves};
        if (best == kNone || growth < least) {
            least = growth;
            best = c;
        }
    }
    return best;
}

InsertionTree::Place InsertionTree::best_place(const BoxBound& bound) {
    Place best;
    double inherited = 0;
    const auto offer = [&](std::uint32_t node, bool as_child, double increase) {
        // At equal cost prefers the deeper node: coincident boxes then make no chain. The first
        // offer is always taken, even if areas are so large that costs overflow.
        const bool better = as_child ? increase < best.increase : increase <= best.increase;
        if (best.node == kNone || better) best = {node, as_child, increase};
    };
    for (std::uint32_t n = root_;;) {
        const Node& node = nodes_[n];
        looked_at_ += n == root_ ? 1 : 0;
        const double area = insertion_area(node.bound);
        const double grown = insertion_area(hull(node.bound, bound));
        const auto k = static_cast<double>(node.children.size());
        offer(n, false, inherited + 2.0 * grown);
        if (node.children.empty()) return best;
        if (node.children.size() < kMostChildren) {
            offer(n, true, inherited + k * (grown - area) + grown);
        }
        inherited += k * (grown - area);
        if (inherited >= best.increase) return best;
        looked_at_ += node.children.size();
        n = child_to_descend(node, bound);
    }
}

double InsertionTree::insert(std::uint32_t primitive, const BoxBound& bound) {
    interruption_point();
    const std::uint32_t leaf = new_node();
    nodes_[leaf].bound = bound;
    nodes_[leaf].primitive = primitive;
    leaf_of_[primitive] = leaf;
    if (root_ == kNone) {
        root_ = leaf;
        return 0;
    }
    const Place place = best_place(bound);
    if (place.as_child) {
        nodes_[leaf].parent = place.node;
        nodes_[place.node].children.push_back(leaf);
        grow_upward(place.node, bound);
    } else {
        put_beside(place.node, leaf);
    }
    return place.increase;
}

void InsertionTree::put_beside(std::uint32_t node, std::uint32_t leaf) {
    const std::uint32_t above = nodes_[node].parent;
    const std::uint32_t both = new_node();
    Node& made = nodes_[both];
    made.parent = above;
    made.children = {node, leaf};
    made.bound = hull(nodes_[node].bound, nodes_[leaf].bound);
    made.leaves = nodes_[node].leaves + 1;
    nodes_[node].parent = nodes_[leaf].parent = both;
    if (above == kNone) {
        root_ = both;
        return;
    }
    replace_child(above, node, both);
    grow_upward(above, nodes_[leaf].bound);
}

void InsertionTree::replace_child(std::uint32_t parent, std::uint32_t old_child,
                                  std::uint32_t new_child) {
    auto& children = nodes_[parent].children;
    *std::find(children.begin(), children.end(), old_child) = new_child;
}

void InsertionTree::grow_upward(std::uint32_t node, const BoxBound& bound) {
    for (; node != kNone; node = nodes_[node].parent) {
        nodes_[node].bound.include(bound);
        ++nodes_[node].leaves;
    }
}

void InsertionTree::shrink_upward(std::uint32_t node) {
    for (; node != kNone; node = nodes_[node].parent) {
        Node& n = nodes_[node];
        n.bound = nodes_[n.children.front()].bound;
        for (const std::uint32_t c : n.children) n.bound.include(nodes_[c].bound);
        --n.leaves;
    }
}

void InsertionTree::remove(std::uint32_t primitive) {
    const std::uint32_t leaf = leaf_of_[primitive];
    const std::uint32_t above = nodes_[leaf].parent;
    leaf_of_[primitive] = kNone;
    free_.push_back(leaf);
    if (above == kNone) {
        root_ = kNone;
        return;
    }
    auto& children = nodes_[above].children;
    children.erase(std::find(children.begin(), children.end(), leaf));
    if (children.size() > 1) {
        shrink_upward(above);
        return;
    }
    // A node with one child left is replaced by the child.
    const std::uint32_t left = children.front();
    const std::uint32_t top = nodes_[above].parent;
    nodes_[left].parent = top;
    free_.push_back(above);
    if (top == kNone) {
        root_ = left;
        return;
    }
    replace_child(top, above, left);
    shrink_upward(top);
}

double InsertionTree::cost() const {
    if (root_ == kNone) return 0;
    double sum = 0;
    std::vector<std::uint32_t> rest{root_};
    while (!rest.empty()) {
        const Node& node = nodes_[rest.back()];
        rest.pop_back();
        sum += static_cast<double>(node.children.size()) * insertion_area(node.bound);
        rest.insert(rest.end(), node.children.begin(), node.children.end());
    }
    return sum;
}

BoundTree<BoxBound> InsertionTree::flattened() const {
    BoundTree<BoxBound> flat;
    if (root_ == kNone) return flat;
    flat.nodes.resize(nodes_.size() - free_.size());
    // Breadth first: the children of a node get consecutive indices.
    std::vector<std::uint32_t> order{root_};
    order.reserve(flat.nodes.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Node& node = nodes_[order[i]];
        const bool leaf = node.children.empty();
        flat.nodes[i] = {node.bound,
                         leaf ? node.primitive : static_cast<std::uint32_t>(order.size()),
                         static_cast<std::uint32_t>(node.children.size())};
        order.insert(order.end(), node.children.begin(), node.children.end());
    }
    return flat;
}

}  // namespace alhazen
