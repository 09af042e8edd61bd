#include "alhazen/renderers/cone_tracing/cone_tree.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace alhazen {

namespace {

constexpr int kConeBins = 16;

int bin_of(double at, double lo, double scale) {
    const double place = (at - lo) * scale;
    return place < kConeBins - 1 ? static_cast<int>(place) : kConeBins - 1;
}

}  // namespace

ConeTree::ConeTree(std::span<const Box3> boxes) {
    if (boxes.empty()) return;
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
    struct Work {
        std::uint32_t node, first, end;
    };
    std::vector<Work> work{{0, 0, static_cast<std::uint32_t>(boxes.size())}};
    nodes_.emplace_back();
    while (!work.empty()) {
        const Work w = work.back();
        work.pop_back();
        Box3 box;
        for (std::uint32_t k = w.first; k < w.end; ++k) box.include(boxes[order_[k]]);
        box = padded(box);
        nodes_[w.node].center = box.center();
        nodes_[w.node].half = box.hi - box.center();
        if (w.end - w.first <= kLeafItems) {
            nodes_[w.node].first = w.first;
            nodes_[w.node].count = w.end - w.first;
            continue;
        }
        const std::uint32_t middle = divide(boxes, w.first, w.end);
        const auto child = static_cast<std::uint32_t>(nodes_.size());
        nodes_[w.node].first = child;
        nodes_.emplace_back();
        nodes_.emplace_back();
        work.push_back({child, w.first, middle});
        work.push_back({child + 1, middle, w.end});
    }
}

std::uint32_t ConeTree::divide(std::span<const Box3> boxes, std::uint32_t first,
                               std::uint32_t end) {
    Box3 centers;
    for (std::uint32_t k = first; k < end; ++k) centers.include(boxes[order_[k]].center());
    const int axis = dominant_axis(centers.size());
    const double lo = centers.lo[axis], size = centers.size()[axis];
    const auto begin = order_.begin() + first, last = order_.begin() + end;
    const std::uint32_t half = first + (end - first) / 2;
    if (size > 0.0) {
        // Finite, so that a box at the begin of boxes too close to be told apart is in the first
        // bin.
        const double scale = std::min(kConeBins / size, std::numeric_limits<double>::max());
        std::array<Box3, kConeBins> box;
        std::array<std::uint32_t, kConeBins> count{};
        for (auto k = begin; k != last; ++k) {
            const int bin = bin_of(boxes[*k].center()[axis], lo, scale);
            box[static_cast<std::size_t>(bin)].include(boxes[*k]);
            ++count[static_cast<std::size_t>(bin)];
        }
        std::array<double, kConeBins> right{};
        Box3 sum;
        std::uint32_t n = 0;
        for (std::size_t b = kConeBins - 1; b > 0; --b) {
            sum.include(box[b]);
            n += count[b];
            right[b] = n * sum.half_area();
        }
        sum = Box3{};
        n = 0;
        double best = std::numeric_limits<double>::infinity();
        int split = -1;
        for (std::size_t b = 0; b + 1 < kConeBins; ++b) {
            sum.include(box[b]);
            n += count[b];
            const double cost = n * sum.half_area() + right[b + 1];
            if (n > 0 && n < end - first && cost < best) {
                best = cost;
                split = static_cast<int>(b);
            }
        }
        if (split >= 0) {
            const auto at = std::partition(begin, last, [&](std::uint32_t k) {
                return bin_of(boxes[k].center()[axis], lo, scale) <= split;
            });
            return static_cast<std::uint32_t>(at - order_.begin());
        }
    }
    return half;
}

}  // namespace alhazen
