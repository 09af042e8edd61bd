#include "alhazen/shapes/patches/patch_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace alhazen {

namespace {

struct Range {
    std::size_t begin, end;
    Box3 box;

    [[nodiscard]] std::size_t count() const { return end - begin; }
};

class Builder {
  public:
    Builder(std::span<const Box3> boxes, std::vector<std::uint32_t>& order)
        : boxes_(boxes), order_(order) {
        order_.resize(boxes.size());
        std::iota(order_.begin(), order_.end(), 0u);
    }

    std::vector<PatchBoxes> build() {
        nodes_.emplace_back();
        fill(0, range(0, boxes_.size()), 0);
        return std::move(nodes_);
    }

  private:
    [[nodiscard]] Range range(std::size_t begin, std::size_t end) const {
        Range r{begin, end, {}};
        for (std::size_t k = begin; k < end; ++k) r.box.include(boxes_[order_[k]]);
        return r;
    }
    [[nodiscard]] Vec3 middle(std::size_t k) const { return boxes_[order_[k]].center(); }

    /// Partitions a range in two; returns the start of the second.
    std::size_t split(const Range& r, bool evenly) {
        constexpr int kBins = 16;
        Box3 middles;
        for (std::size_t k = r.begin; k < r.end; ++k) middles.include(middle(k));
        const int axis = dominant_axis(middles.size());
        const double lo = middles.lo[axis], width = middles.size()[axis];
        const std::size_t half = r.begin + r.count() / 2;
        if (evenly || !(width > 0.0)) return half;
        const auto bin_of = [&](std::uint32_t i) {
            return std::min(kBins - 1,
                            static_cast<int>(kBins * ((boxes_[i].center()[axis] - lo) / width)));
        };
        std::array<Box3, kBins> bins;
        std::array<std::size_t, kBins> counts{};
        for (std::size_t k = r.begin; k < r.end; ++k) {
            const auto bin = static_cast<std::size_t>(bin_of(order_[k]));
            bins[bin].include(boxes_[order_[k]]);
            ++counts[bin];
        }
        const int cut = best_cut(bins, counts);
        std::size_t first = 0;
        for (int k = 0; k < cut; ++k) first += counts[static_cast<std::size_t>(k)];
        // Split at multiples of whole nodes, so that nodes of leaves are full.
        if (r.count() > kBoxChildren) {
            const std::size_t whole = (first + kBoxChildren / 2) / kBoxChildren * kBoxChildren;
            const std::size_t most = (r.count() - 1) / kBoxChildren * kBoxChildren;
            first = std::clamp(whole, std::size_t{kBoxChildren}, most);
        }
        first = std::clamp(first, std::size_t{1}, r.count() - 1);
        const auto at = [&](std::size_t k) {
            return order_.begin() + static_cast<std::ptrdiff_t>(k);
        };
        std::nth_element(at(r.begin), at(r.begin + first), at(r.end),
                         [&](std::uint32_t i, std::uint32_t j) {
                             const double x = boxes_[i].center()[axis];
                             const double y = boxes_[j].center()[axis];
                             return x != y ? x < y : i < j;
                         });
        return r.begin + first;
    }
    /// The first bin of the second half.
    template <std::size_t kBins>
    static int best_cut(const std::array<Box3, kBins>& bins,
                        const std::array<std::size_t, kBins>& counts) {
        std::array<double, kBins> before{};
        Box3 box;
        std::size_t count = 0;
        for (std::size_t k = 0; k + 1 < kBins; ++k) {
            if (counts[k] != 0) box.include(bins[k]);
            count += counts[k];
            before[k + 1] = count == 0 ? 0.0 : box.half_area() * static_cast<double>(count);
        }
        box = {};
        count = 0;
        double best = kInfinity;
        int cut = 1;
        for (std::size_t k = kBins; --k > 0;) {
            if (counts[k] != 0) box.include(bins[k]);
            count += counts[k];
            const double cost =
                before[k] + (count == 0 ? 0.0 : box.half_area() * static_cast<double>(count));
            if (cost < best) {
                best = cost;
                cut = static_cast<int>(k);
            }
        }
        return cut;
    }

    void fill(std::size_t node, const Range& all, int depth) {
        // Even splits below bound the depth of the tree, and thus the stack of a search.
        const bool evenly = depth > 8;
        std::vector<Range> parts;
        if (all.count() > 0) parts.push_back(all);
        // A range that fits into one node is not split, so that nodes of leaves are full.
        const auto worth = [&](const Range& r) {
            if (r.count() < 2) return -1.0;
            if (r.count() <= kBoxChildren && all.count() > kBoxChildren) return -1.0;
            return evenly ? static_cast<double>(r.count()) : r.box.half_area();
        };
        while (parts.size() < kBoxChildren) {
            const auto largest = std::max_element(
                parts.begin(), parts.end(),
                [&](const Range& a, const Range& b) { return worth(a) < worth(b); });
            if (largest == parts.end() || worth(*largest) < 0.0) break;
            const Range whole = *largest;
            const std::size_t cut = split(whole, evenly);
            *largest = range(whole.begin, cut);
            parts.push_back(range(cut, whole.end));
        }
        set_planes(nodes_[node], all.box);
        nodes_[node].used = (1u << parts.size()) - 1;
        for (std::size_t k = 0; k < kBoxChildren; ++k) {
            std::uint32_t child = 0;
            if (k < parts.size() && parts[k].count() == 1) {
                child = kLeafChild | static_cast<std::uint32_t>(parts[k].begin);
            } else if (k < parts.size()) {
                child = static_cast<std::uint32_t>(nodes_.size());
                nodes_.emplace_back();
                fill(child, parts[k], depth + 1);
            }
            set(nodes_[node], k, k < parts.size() ? parts[k].box : Box3{}, child);
        }
    }
    /// Quantisation of a node's planes; the first and last planes are outside of all boxes.
    static void set_planes(PatchBoxes& node, const Box3& box) {
        for (int axis = 0; axis < 3; ++axis) {
            const double lo = box.empty() ? 0.0 : box.lo[axis],
                         hi = box.empty() ? 0.0 : box.hi[axis];
            node.from[axis] = static_cast<float>(lo - 2.0 * kBoxMargin);
            const double size = hi + 2.0 * kBoxMargin - node.from[axis];
            node.step[axis] = static_cast<float>(1.000001 * size / kLastPlane);
        }
    }
    static void set(PatchBoxes& node, std::size_t k, const Box3& box, std::uint32_t child) {
        node.child[k] = child;
        for (int axis = 0; axis < 3; ++axis) {
            node.planes[0][axis][k] = kLastPlane;
            node.planes[1][axis][k] = 0;
            if (box.empty()) continue;
            const double from = node.from[axis], step = node.step[axis];
            const double lo = (box.lo[axis] - kBoxMargin - from) / step;
            const double hi = (box.hi[axis] + kBoxMargin - from) / step;
            node.planes[0][axis][k] = static_cast<std::uint8_t>(std::max(std::floor(lo), 0.0));
            node.planes[1][axis][k] =
                static_cast<std::uint8_t>(std::min<double>(std::ceil(hi), kLastPlane));
        }
    }

    static constexpr std::uint8_t kLastPlane = 255;
    std::span<const Box3> boxes_;
    std::vector<std::uint32_t>& order_;
    std::vector<PatchBoxes> nodes_;
};

}  // namespace

std::vector<PatchBoxes> make_patch_boxes(std::span<const Box3> boxes,
                                         std::vector<std::uint32_t>& order) {
    return Builder(boxes, order).build();
}

}  // namespace alhazen
