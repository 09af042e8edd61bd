#include "alhazen/accel/wide_bvh/build/spatial_split.h"

#include <algorithm>
#include <cmath>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr int kMaxSpatialBins = 16;
/// Number of bins for a set of this size.
int bins_for(std::size_t size) {
    return size < 2048 ? 8 : kMaxSpatialBins;
}
/// Boxes whose overlap is less than this share of the root's surface are not split.
constexpr float kAlpha = 1e-5f;

bool is_empty(const FloatBox& box) {
    return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

float half_area(const FloatBox& box) {
    const float x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
    return x * y + y * z + z * x;
}

float overlap(const Box4& a, const Box4& b) {
    FloatBox common;
    for (int k = 0; k < 3; ++k) {
        common.lo[k] = std::max(a.lo[k], b.lo[k]);
        common.hi[k] = std::min(a.hi[k], b.hi[k]);
    }
    return is_empty(common) ? 0 : half_area(common);
}

struct SpatialBin {
    Box4 box;
    KindCounts enter{}, leave{};  ///< numbers of pieces that begin and end here
};

/// The contents of one side.
struct Side {
    Box4 box;
    KindCounts count{};
};

struct SpatialSplit {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    float plane = 0;
    Side left, right;
};

void add(SpatialBin* bins, const BuildReference& r, const BinPlanes& planes,
         const ReferenceSplitter& splitter) {
    const int axis = planes.axis;
    const bool whole = !splitter.can_split(r.kind);
    const int first = planes.bin(whole ? 0.5f * r.center2(axis) : r.lo[axis]);
    const int last = whole ? first : planes.bin(r.hi[axis]);
    ++bins[first].enter[r.kind];
    ++bins[last].leave[r.kind];
    if (first == last) return bins[first].box.include(Box4(r));
    Box4 slices[kMaxSpatialBins];
    splitter.slice(r, planes, first, last, slices);
    for (int i = first; i <= last; ++i) bins[i].box.include(slices[i - first]);
}

void add(KindCounts& a, const KindCounts& b) {
    for (std::size_t k = 0; k < kLeafKinds; ++k) a[k] += b[k];
}

void best_plane(const SpatialBin* bins, const BinPlanes& planes, const LeafKinds& kinds,
                SpatialSplit& best) {
    Side rights[kMaxSpatialBins];
    Side right;
    for (int b = planes.bins - 1; b > 0; --b) {
        right.box.include(bins[b].box);
        add(right.count, bins[b].leave);
        rights[b] = right;
    }
    Side left;
    for (int b = 0; b + 1 < planes.bins; ++b) {
        left.box.include(bins[b].box);
        add(left.count, bins[b].enter);
        const Side& other = rights[b + 1];
        if (total(left.count) == 0 || total(other.count) == 0) continue;
        const float cost = left.box.weight() * blocks_cost(left.count, kinds) +
                           other.box.weight() * blocks_cost(other.count, kinds);
        if (cost < best.cost) best = {cost, planes.axis, planes(b + 1), left, other};
    }
}

/// A range of the references, followed by spare capacity.
struct ReferenceRange {
    std::uint32_t begin, end, limit;

    [[nodiscard]] std::uint32_t size() const { return end - begin; }
    [[nodiscard]] std::uint32_t capacity() const { return limit - begin; }
};

using ReferencePair = std::pair<ReferenceRange, ReferenceRange>;

/// Decides whether to search for a spatial split at a level. After several failures in a row it
/// skips more and more levels, since a search reads all references.
class SplitSearchBackoff {
  public:
    /// Must be called once per level.
    [[nodiscard]] bool tries() {
        if (wait_ == 0) return true;
        --wait_;
        return false;
    }
    void note(bool found) {
        failures_ = found ? 0 : failures_ + 1;
        wait_ = failures_ < kInARow ? 0 : 1 << std::min(failures_ - kInARow, 8);
    }

  private:
    static constexpr int kInARow = 4;
    int failures_ = 0;
    int wait_ = 0;  ///< levels to skip
};

class SpatialBuilder {
  public:
    SpatialBuilder(std::vector<BuildReference>& references, const LeafKinds& kinds,
            const ReferenceSplitter& splitter)
        : references_(references), kinds_(kinds), splitter_(splitter) {}

    BinaryBvh build() {
        const auto count = static_cast<std::uint32_t>(references_.size());
        const auto limit = static_cast<std::uint32_t>(std::min(
            kSpatialSplitBudget * static_cast<double>(count) + 8, double{NodeRef::kMaxNodes} / 2));
        const RangeSummary all = summarize(references_);
        references_.resize(std::max(count, limit));
        nodes_ = make_huge_array<BinaryNode>(2 * references_.size());
        least_overlap_ = kAlpha * half_area(all.box.box());
        build({0, count, static_cast<std::uint32_t>(references_.size())}, all, 0, 0, {});
        return {std::move(nodes_), static_cast<std::uint32_t>(2 * references_.size()), false};
    }

  private:
    /// Subtrees with capacity for n references use 2 n - 1 consecutive nodes.
    void build(const ReferenceRange& slots, const RangeSummary& all, std::uint32_t index, int level,
               SplitSearchBackoff backoff) {
        nodes_[index] = {all.box.box(), slots.begin, slots.end, 0, all.kind()};
        if (all.indivisible(kinds_)) return;
        RangeSummary left, right;
        const auto halves = divide_slots(slots, all, level, backoff, left, right);
        const std::uint32_t right_index = index + 2 * halves.first.capacity();
        nodes_[index].right = right_index;
        const auto build_left = [&] { build(halves.first, left, index + 1, level + 1, backoff); };
        const auto build_right = [&] {
            build(halves.second, right, right_index, level + 1, backoff);
        };
        if (slots.size() >= kParallelBuildSize) {
            parallel_invoke(build_left, build_right);
        } else {
            build_left();
            build_right();
        }
    }

    ReferencePair divide_slots(const ReferenceRange& slots, const RangeSummary& all, int level,
                               SplitSearchBackoff& backoff, RangeSummary& left,
                               RangeSummary& right) {
        const std::span<BuildReference> range = span_of(slots);
        ObjectSplit object;
        if (level < kMaxSahLevel) {
            object = best_object_split(range, all, kinds_);
            ReferencePair halves;
            if (backoff.tries() && is_worth_a_try(slots, all, object)) {
                const bool found = try_spatial(slots, all, object, left, right, halves);
                backoff.note(found);
                if (found) return halves;
            }
        }
        const std::uint32_t middle = object.axis >= 0 ? divide(range, all, object, left, right)
                                                      : divide_evenly(range, all, left, right);
        const std::uint32_t cut = slots.begin + middle;
        // A set that fits into one block stays together: it may become one.
        if (fits_one_block(all)) return {{slots.begin, cut, cut}, {cut, slots.end, slots.limit}};
        const auto halves = share(slots, middle, slots.size() - middle);
        std::move_backward(references_.begin() + cut, references_.begin() + slots.end,
                           references_.begin() + halves.second.end);
        return halves;
    }

    [[nodiscard]] std::span<BuildReference> span_of(const ReferenceRange& slots) {
        return std::span(references_).subspan(slots.begin, slots.size());
    }

    /// Capacities of both sides, with the spare part in proportion to their sizes.
    static ReferencePair share(const ReferenceRange& slots, std::uint32_t left,
                               std::uint32_t right) {
        const std::uint64_t spare = slots.capacity() - (left + right);
        const auto left_spare = static_cast<std::uint32_t>(spare * left / (left + right));
        const std::uint32_t middle = slots.begin + left + left_spare;
        return {{slots.begin, slots.begin + left, middle}, {middle, middle + right, slots.limit}};
    }

    [[nodiscard]] bool is_worth_a_try(const ReferenceRange& slots, const RangeSummary& all,
                                      const ObjectSplit& object) const {
        if (slots.capacity() == slots.size() || fits_one_block(all)) return false;
        return object.axis < 0 || overlap(object.left, object.right) > least_overlap_;
    }

    bool try_spatial(const ReferenceRange& slots, const RangeSummary& all,
                     const ObjectSplit& object, RangeSummary& left, RangeSummary& right,
                     ReferencePair& halves) {
        const SpatialSplit split = best_spatial_split(span_of(slots), all);
        if (!(split.cost < object.cost)) return false;
        std::vector<BuildReference> sides[2];
        distribute(slots, split, sides);
        if (sides[0].empty() || sides[1].empty()) return false;
        halves = share(slots, static_cast<std::uint32_t>(sides[0].size()),
                      static_cast<std::uint32_t>(sides[1].size()));
        std::copy(sides[0].begin(), sides[0].end(), references_.begin() + halves.first.begin);
        std::copy(sides[1].begin(), sides[1].end(), references_.begin() + halves.second.begin);
        left = summarize(sides[0]);
        right = summarize(sides[1]);
        return true;
    }

    /// True if dividing primitives would only increase their number.
    [[nodiscard]] bool fits_one_block(const RangeSummary& all) const {
        const std::uint32_t kind = all.kind();
        return kind != kLeafKinds && all.size() <= kinds_[kind].width();
    }

    [[nodiscard]] SpatialSplit best_spatial_split(std::span<const BuildReference> range,
                                                  const RangeSummary& all) const {
        SpatialSplit best_of[3];
        const auto search = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const int axis = static_cast<int>(i);
                const BinPlanes planes(all.box, axis, bins_for(range.size()));
                if (!planes.usable()) continue;
                SpatialBin bins[kMaxSpatialBins];
                for (const BuildReference& r : range) add(bins, r, planes, splitter_);
                best_plane(bins, planes, kinds_, best_of[axis]);
            }
        };
        if (range.size() >= kParallelBuildSize) {
            parallel_for(3, 1, search);
        } else {
            search(0, 3);
        }
        return *std::min_element(
            best_of, best_of + 3,
            [](const SpatialSplit& a, const SpatialSplit& b) { return a.cost < b.cost; });
    }

    /// Moves every reference to its side, or divides it while there is capacity.
    void distribute(const ReferenceRange& slots, const SpatialSplit& split,
                    std::vector<BuildReference> (&sides)[2]) {
        std::uint32_t spare = slots.capacity() - slots.size();
        for (const BuildReference& r : span_of(slots)) {
            if (r.hi[split.axis] <= split.plane) {
                sides[0].push_back(r);
                continue;
            }
            if (r.lo[split.axis] >= split.plane) {
                sides[1].push_back(r);
                continue;
            }
            const int whole = side_of_whole(r, split);
            if (whole >= 0 || spare == 0) {
                sides[whole >= 0 ? whole : nearer_side(r, split)].push_back(r);
                continue;
            }
            FloatBox below, above;
            splitter_.split(r, split.axis, split.plane, below, above);
            if (is_empty(below) || is_empty(above)) {
                // The reference lies here entirely; rounding may have emptied both parts.
                sides[is_empty(above) ? 0 : 1].push_back(r);
                continue;
            }
            sides[0].emplace_back(below, r.id, r.kind);
            sides[1].emplace_back(above, r.id, r.kind);
            --spare;
        }
    }

    static int nearer_side(const BuildReference& r, const SpatialSplit& split) {
        return r.center2(split.axis) < 2 * split.plane ? 0 : 1;
    }

    /// The side on which a reference is better kept whole, or -1.
    [[nodiscard]] int side_of_whole(const BuildReference& r, const SpatialSplit& split) const {
        if (!splitter_.can_split(r.kind)) return nearer_side(r, split);
        // Counts fractions of blocks; otherwise no single reference would matter.
        const auto count = [&](const Side& side) { return static_cast<float>(total(side.count)); };
        const auto grown = [&](const Side& side) {
            Box4 box = side.box;
            box.include(Box4(r));
            return box.weight();
        };
        const float l = split.left.box.weight(), n = count(split.left);
        const float t = split.right.box.weight(), m = count(split.right);
        const float divided = l * n + t * m;
        const float left = grown(split.left) * n + t * (m - 1);
        const float right = l * (n - 1) + grown(split.right) * m;
        if (left < divided && left <= right) return 0;
        return right < divided ? 1 : -1;
    }

    std::vector<BuildReference>& references_;
    LeafKinds kinds_;
    const ReferenceSplitter& splitter_;
    HugeArray<BinaryNode> nodes_;
    float least_overlap_ = 0;
};

}  // namespace

void ReferenceSplitter::slice(const BuildReference& reference, const BinPlanes& planes, int first,
                              int last, Box4* slices) const {
    BuildReference rest = reference;
    bool more = true;
    for (int i = first; i <= last; ++i, ++slices) {
        *slices = Box4();
        if (!more) continue;
        FloatBox below = rest.box(), above;
        if (i < last) split(rest, planes.axis, planes(i + 1), below, above);
        if (!is_empty(below)) *slices = Box4(below);
        more = !is_empty(above);
        if (more) rest.set_box(above);
    }
}

BinaryBvh build_with_spatial_splits(std::vector<BuildReference>& references, const LeafKinds& kinds,
                                    const ReferenceSplitter& splitter) {
    if (references.empty()) return {};
    return SpatialBuilder(references, kinds, splitter).build();
}

}  // namespace alhazen
