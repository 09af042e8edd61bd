#include "alhazen/accel/wide_bvh/build/sah_cost.h"

namespace alhazen {

double sah_cost(const WideBvh& tree, const LeafKinds& kinds) {
    if (tree.empty) return 0;
    const auto leaf_cost = [&](NodeRef leaf) {
        return static_cast<double>(kinds[leaf.kind()].cost) * leaf.count();
    };
    if (tree.root.is_leaf()) return leaf_cost(tree.root);
    FloatBox all;
    double cost = 0;
    with_nodes(tree, [&](const auto& nodes) {
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const auto& node = nodes[n];
            for (std::size_t i = 0; i < node.child_count(); ++i) {
                const FloatBox box = node.box(i);
                const NodeRef child = node.child[i];
                cost +=
                    static_cast<double>(box.weight()) * (child.is_leaf() ? leaf_cost(child) : 1.0);
                if (NodeRef::node(static_cast<std::uint32_t>(n)) == tree.root) all.include(box);
            }
        }
    });
    return 1.0 + cost / static_cast<double>(all.weight());
}

}  // namespace alhazen
