#include "alhazen/accel/wide_bvh/binary_builder.h"

#include <algorithm>
#include <span>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr int kMaxSahLevel = 48;
constexpr int kMaxBins = 32;
constexpr std::uint32_t kSweepSize = 12;       // ranges up to this are swept, not binned
constexpr std::uint32_t kParallelSize = 8192;  // ranges from this on are tasks of their own
constexpr std::size_t kChunk = 32768;          // references binned by one task

using Counts = std::array<std::uint32_t, kLeafKinds>;

/// Boxes and numbers of a set of references.
struct Summary {
    FloatBox box;
    Counts count{};

    void include(const BuildReference& reference) {
        box.include(reference.box);
        ++count[reference.kind];
    }
    void include(const Summary& other) {
        box.include(other.box);
        for (std::size_t k = 0; k < kLeafKinds; ++k) count[k] += other.count[k];
    }
    /// Area times the cost of its blocks; 0 for none.
    [[nodiscard]] float cost(const LeafKinds& kinds) const {
        float blocks = 0;
        for (std::size_t k = 0; k < kLeafKinds; ++k) {
            blocks += kinds[k].cost * static_cast<float>(kinds[k].blocks(count[k]));
        }
        return blocks == 0.0f ? 0.0f : box.weight() * blocks;
    }
    [[nodiscard]] std::uint32_t size() const {
        std::uint32_t size = 0;
        for (const std::uint32_t n : count) size += n;
        return size;
    }
};

/// A range with the boxes of its primitives and of twice their centers.
struct Range {
    std::uint32_t begin, end;
    Summary all;
    FloatBox centers;

    [[nodiscard]] std::uint32_t size() const { return end - begin; }
    /// The one kind in it, or kLeafKinds.
    [[nodiscard]] std::uint32_t kind() const {
        for (std::uint32_t k = 0; k < kLeafKinds; ++k) {
            if (all.count[k] == size()) return k;
        }
        return kLeafKinds;
    }
    [[nodiscard]] int widest_axis() const {
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (centers.hi[k] - centers.lo[k] > centers.hi[axis] - centers.lo[axis]) axis = k;
        }
        return axis;
    }
};

/// The bin of a center along an axis of a range; the same function counts and partitions.
struct Binning {
    int bins;
    float lo[3], scale[3];

    Binning(const FloatBox& centers, std::uint32_t size)
        : bins(size < 64     ? 8
               : size < 1024 ? 16
                             : kMaxBins) {
        for (int k = 0; k < 3; ++k) {
            const float extent = centers.hi[k] - centers.lo[k];
            lo[k] = centers.lo[k];
            // A range too thin to divide has one bin.
            const float s = static_cast<float>(bins) * (1.0f - 1e-6f) / extent;
            scale[k] = extent > 0.0f && s < 1e37f ? s : 0.0f;
        }
    }
    [[nodiscard]] int bin(const BuildReference& reference, int axis) const {
        const int i = static_cast<int>((reference.center2(axis) - lo[axis]) * scale[axis]);
        return std::min(std::max(i, 0), bins - 1);
    }
};

using Bins = std::array<std::array<Summary, kMaxBins>, 3>;

struct Split {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;  ///< -1: none found
    int bin = 0;    ///< bins up to this one, or references up to this position, go left
};

class Builder {
  public:
    Builder(std::span<BuildReference> references, const LeafKinds& kinds)
        : references_(references),
          kinds_(kinds),
          nodes_(std::make_unique_for_overwrite<BinaryNode[]>(2 * references.size())) {}

    BinaryBvh build() {
        build(summarize(0, static_cast<std::uint32_t>(references_.size())), 0, 0);
        return {std::move(nodes_), false};
    }

  private:
    /// Subtrees of n references live in 2 n - 1 consecutive nodes: places do not depend on threads.
    void build(const Range& range, std::uint32_t index, int level) {
        BinaryNode& node = nodes_[index];
        node = {range.all.box, range.begin, range.end, 0, range.kind()};
        if (is_leaf(range)) return;
        const std::uint32_t middle = split(range, level);
        const std::uint32_t left = index + 1;
        const std::uint32_t right = index + 2 * (middle - range.begin);
        node.right = right;
        const auto build_left = [&] { build(summarize(range.begin, middle), left, level + 1); };
        const auto build_right = [&] { build(summarize(middle, range.end), right, level + 1); };
        if (range.size() >= kParallelSize) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

    [[nodiscard]] bool is_leaf(const Range& range) const {
        if (range.size() == 1) return true;
        const std::uint32_t kind = range.kind();
        if (kind == kLeafKinds) return false;
        // Half a block is not worth a box of its own, except by the cost that `collapse` weighs.
        return range.size() <= std::max(1u, kinds_[kind].width() / 2);
    }

    [[nodiscard]] Range summarize(std::uint32_t begin, std::uint32_t end) const {
        const auto add = [&](Range& range, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const BuildReference& r = references_[i];
                range.all.include(r);
                FloatBox center;
                for (int k = 0; k < 3; ++k) center.lo[k] = center.hi[k] = r.center2(k);
                range.centers.include(center);
            }
        };
        Range range{begin, end, {}, {}};
        for_chunks<Range>(
            begin, end, add,
            [&](const Range& part) {
                range.all.include(part.all);
                range.centers.include(part.centers);
            },
            range);
        return range;
    }

    /// Calls add(total, i, j) for a small range; for a large one in parallel on parts, which
    /// `merge` then takes in order.
    template <class T, class Add, class Merge>
    void for_chunks(std::uint32_t begin, std::uint32_t end, const Add& add, const Merge& merge,
                    T& total) const {
        if (end - begin <= 2 * kChunk) return add(total, begin, end);
        std::vector<T> parts((end - begin - 1) / kChunk + 1);
        parallel_for(end - begin, kChunk, [&](std::size_t i, std::size_t j) {
            add(parts[i / kChunk], begin + i, begin + j);
        });
        for (const T& part : parts) merge(part);
    }

    /// Divides a range in two that are not empty; returns where.
    std::uint32_t split(const Range& range, int level) {
        const std::span<BuildReference> all = references_.subspan(range.begin, range.size());
        std::uint32_t middle = 0;
        if (level < kMaxSahLevel) {
            middle = range.size() <= kSweepSize ? sweep(range, all) : split_by_bins(range, all);
        }
        if (middle == 0)
            middle = range.kind() == kLeafKinds ? split_by_kind(all) : halve(range, all);
        return range.begin + middle;
    }

    /// 0 when the centers cannot be told apart.
    std::uint32_t split_by_bins(const Range& range, std::span<BuildReference> all) {
        const Binning binning(range.centers, range.size());
        const auto add = [&](Bins& bins, std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                const BuildReference& r = references_[i];
                for (int axis = 0; axis < 3; ++axis) bins[axis][binning.bin(r, axis)].include(r);
            }
        };
        Bins bins{};
        for_chunks<Bins>(
            range.begin, range.end, add,
            [&](const Bins& part) {
                for (int axis = 0; axis < 3; ++axis) {
                    for (int b = 0; b < binning.bins; ++b) bins[axis][b].include(part[axis][b]);
                }
            },
            bins);
        const Split best = best_of_bins(bins, binning.bins);
        if (best.axis < 0) return 0;
        const auto middle = std::partition(all.begin(), all.end(), [&](const BuildReference& r) {
            return binning.bin(r, best.axis) <= best.bin;
        });
        return static_cast<std::uint32_t>(middle - all.begin());
    }

    [[nodiscard]] Split best_of_bins(const Bins& bins, int count) const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            std::array<float, kMaxBins> right_cost{};
            Summary right;
            for (int b = count - 1; b > 0; --b) {
                right.include(bins[axis][b]);
                right_cost[b] = right.cost(kinds_);
            }
            const std::uint32_t right_size = right.size();
            const std::uint32_t total = right_size + bins[axis][0].size();
            Summary left;
            for (int b = 0; b + 1 < count; ++b) {
                left.include(bins[axis][b]);
                const std::uint32_t size = left.size();
                if (size == 0 || size == total) continue;
                const float cost = left.cost(kinds_) + right_cost[b + 1];
                if (cost < best.cost) best = {cost, axis, b};
            }
        }
        return best;
    }

    /// The best of all splits of a few references in the order of their centers; 0 when all costs
    /// are equal and infinite.
    std::uint32_t sweep(const Range& range, std::span<BuildReference> all) const {
        Split best;
        int sorted = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(range.centers.hi[axis] > range.centers.lo[axis])) continue;
            sort_along(all, axis);
            sorted = axis;
            std::array<float, kSweepSize> right_cost{};
            Summary right;
            for (std::size_t i = all.size() - 1; i > 0; --i) {
                right.include(all[i]);
                right_cost[i] = right.cost(kinds_);
            }
            Summary left;
            for (std::size_t i = 0; i + 1 < all.size(); ++i) {
                left.include(all[i]);
                const float cost = left.cost(kinds_) + right_cost[i + 1];
                if (cost < best.cost) best = {cost, axis, static_cast<int>(i)};
            }
        }
        if (best.axis < 0) return 0;
        if (best.axis != sorted) sort_along(all, best.axis);
        return static_cast<std::uint32_t>(best.bin + 1);
    }

    static bool before(const BuildReference& a, const BuildReference& b, int axis) {
        const float ca = a.center2(axis);
        const float cb = b.center2(axis);
        return ca != cb ? ca < cb : a.id < b.id;
    }
    static void sort_along(std::span<BuildReference> all, int axis) {
        std::sort(all.begin(), all.end(), [axis](const BuildReference& a, const BuildReference& b) {
            return before(a, b, axis);
        });
    }

    static std::uint32_t split_by_kind(std::span<BuildReference> all) {
        std::uint32_t lowest = kLeafKinds;
        for (const BuildReference& r : all) lowest = std::min(lowest, r.kind);
        const auto middle = std::partition(
            all.begin(), all.end(), [&](const BuildReference& r) { return r.kind == lowest; });
        return static_cast<std::uint32_t>(middle - all.begin());
    }

    static std::uint32_t halve(const Range& range, std::span<BuildReference> all) {
        const std::size_t middle = all.size() / 2;
        const int axis = range.widest_axis();
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(middle), all.end(),
                         [axis](const BuildReference& a, const BuildReference& b) {
                             return before(a, b, axis);
                         });
        return static_cast<std::uint32_t>(middle);
    }

    std::span<BuildReference> references_;
    LeafKinds kinds_;
    std::unique_ptr<BinaryNode[]> nodes_;
};

}  // namespace

BinaryBvh build_binary(std::vector<BuildReference>& references, const LeafKinds& kinds) {
    if (references.empty()) return {};
    return Builder(references, kinds).build();
}

}  // namespace alhazen
