#include "alhazen/accel/bounds/goldsmith_salmon.h"

#include <limits>
#include <numeric>

#include "alhazen/accel/bounds/insertion_tree.h"
#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

std::vector<std::uint32_t> scene_order(std::size_t size) {
    std::vector<std::uint32_t> order(size);
    std::iota(order.begin(), order.end(), 0u);
    return order;
}

void shuffle(std::vector<std::uint32_t>& order, RandomStream& random) {
    for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[random.below(i)]);
    }
}

}  // namespace

double goldsmith_salmon_cost(const BoundTree<BoxBound>& tree) {
    if (tree.nodes.empty()) return 0;
    const double whole = insertion_area(tree.nodes.front().bound);
    double sum = 0;
    for (const auto& node : tree.nodes) {
        // All areas are 0 if all primitives are one point.
        const double share = whole > 0 ? insertion_area(node.bound) / whole : 1.0;
        sum += static_cast<double>(node.count) * share;
    }
    return 1.0 + sum;
}

GoldsmithSalmon::Config GoldsmithSalmon::configure(SettingsReader& reader) {
    static constexpr const char* kOrders[] = {"stored", "nearest"};
    Config config;
    config.orders = reader.count(
        "orders", "random orders of insertion to try, 0: the scene's order", 1, 0, 1000);
    config.seed = static_cast<std::uint64_t>(
        reader.count("seed", "seed of the random orders", 1, 0, std::numeric_limits<int>::max()));
    config.reinsert =
        reader.count("reinsert", "passes that insert every primitive again", 0, 0, 100);
    config.order = static_cast<ChildOrder>(
        reader.choice("order", "order of the children of a node", 1, kOrders));
    return config;
}

GoldsmithSalmon GoldsmithSalmon::build(const BoundsSource& source, const Config& config) {
    std::vector<BoxBound> bounds;
    for (std::size_t i = 0; i < source.size(); ++i) bounds.push_back(BoxBound::of(source, i));
    std::vector<std::uint32_t> order = scene_order(bounds.size());
    RandomStream random(config.seed);
    GoldsmithSalmon best;
    best.order_ = config.order;
    double least = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < std::max(config.orders, 1); ++attempt) {
        if (config.orders > 0) shuffle(order, random);
        InsertionTree tree(bounds.size());
        for (const std::uint32_t i : order) tree.insert(i, bounds[i]);
        for (int pass = 0; pass < config.reinsert; ++pass) {
            for (const std::uint32_t i : order) {
                tree.remove(i);
                tree.insert(i, bounds[i]);
            }
        }
        BoundTree<BoxBound> flat = tree.flattened();
        const double cost = goldsmith_salmon_cost(flat);
        if (attempt > 0 && !(cost < least)) continue;
        least = cost;
        best.tree_ = std::move(flat);
    }
    return best;
}

}  // namespace alhazen
