#include "alhazen/accel/wide_bvh/build/clustering.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "alhazen/accel/wide_bvh/build/morton_order.h"
#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/accel/wide_bvh/build/tree_draft.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::size_t kRadius = 8;  // neighbors examined on each side
constexpr std::size_t kChunk = 4096;

struct Cluster {
    Box4 box;
    std::uint32_t node = 0;  ///< in the draft
    std::uint32_t kind = 0;  ///< common kind, or kLeafKinds
};

/// Finds the small subtrees in a part of the sorted references.
class Seeds {
  public:
    Seeds(std::span<const BuildReference> references, std::span<const std::uint64_t> codes,
          const LeafKinds& kinds, std::vector<DraftNode>& out)
        : references_(references), codes_(codes), kinds_(kinds), out_(out) {}

    /// `bit`: all codes of the range agree above it.
    void find(std::uint32_t begin, std::uint32_t end, int bit) {
        RangeSummary all;
        const std::uint32_t most = most_of(references_[begin].kind);
        for (std::uint32_t i = begin; i < end && i <= begin + most; ++i) {
            all.include(references_[i]);
        }
        if (all.size() == end - begin && all.indivisible(kinds_)) {
            out_.push_back({all.box.box(), 0, 0, begin, end});
            return;
        }
        std::uint32_t middle = begin;
        for (; bit >= 0 && (middle == begin || middle == end); --bit) {
            const std::uint64_t mask = std::uint64_t{1} << bit;
            const auto first_set =
                std::partition_point(codes_.begin() + begin, codes_.begin() + end,
                                     [mask](std::uint64_t code) { return (code & mask) == 0; });
            middle = static_cast<std::uint32_t>(first_set - codes_.begin());
        }
        if (middle == begin || middle == end) middle = begin + (end - begin) / 2;
        find(begin, middle, bit);
        find(middle, end, bit);
    }

  private:
    [[nodiscard]] std::uint32_t most_of(std::uint32_t kind) const {
        return kinds_[kind].indivisible();
    }

    std::span<const BuildReference> references_;
    std::span<const std::uint64_t> codes_;
    LeafKinds kinds_;
    std::vector<DraftNode>& out_;
};

class Clustering {
  public:
    explicit Clustering(std::vector<DraftNode> seeds) {
        draft_.nodes = std::move(seeds);
        count_ = draft_.nodes.size();
        draft_.nodes.resize(2 * count_ - 1);
    }

    DraftBvh run(std::span<const BuildReference> references) {
        clusters_.resize(count_);
        parallel_for(count_, kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const DraftNode& node = draft_.nodes[i];
                clusters_[i] = {Box4(node.box), static_cast<std::uint32_t>(i),
                                references[node.begin].kind};
            }
        });
        best_.resize(count_);
        next_.resize(count_);
        std::size_t used = count_;
        while (clusters_.size() > 1) used = round(used);
        draft_.root = static_cast<std::uint32_t>(used - 1);
        return std::move(draft_);
    }

  private:
    /// The cost of joining two clusters, with their numbers: symmetric, and different for every
    /// partner of a cluster.
    static std::uint64_t misfit(const Cluster& a, const Cluster& b, std::size_t i, std::size_t j) {
        Box4 box = a.box;
        box.include(b.box);
        float weight = box.weight();
        // Kinds do not share blocks.
        if (a.kind != b.kind) weight *= 2;
        return std::uint64_t{std::bit_cast<std::uint32_t>(weight)} << 32 | (i ^ j);
    }

    /// The best partner of every cluster of a chunk; each pair is examined once.
    void find_partners(std::size_t begin, std::size_t end) {
        const std::size_t n = clusters_.size();
        std::fill(&best_[begin], &best_[begin] + (end - begin), ~std::uint64_t{0});
        const std::size_t first = begin > kRadius ? begin - kRadius : 0;
        for (std::size_t i = first; i < end; ++i) {
            const std::size_t last = std::min(i + kRadius, n - 1);
            for (std::size_t j = std::max(i + 1, i < begin ? begin : 0); j <= last; ++j) {
                const std::uint64_t d = misfit(clusters_[i], clusters_[j], i, j);
                if (i >= begin) best_[i] = std::min(best_[i], d);
                if (j < end) best_[j] = std::min(best_[j], d);
            }
        }
    }
    [[nodiscard]] std::size_t partner(std::size_t i) const {
        return i ^ static_cast<std::uint32_t>(best_[i]);
    }
    [[nodiscard]] bool is_joined(std::size_t i) const { return partner(partner(i)) == i; }

    /// Joins all mutual best partners; returns the number of nodes in use.
    std::size_t round(std::size_t used) {
        const std::size_t n = clusters_.size();
        parallel_for(n, kChunk,
                     [&](std::size_t begin, std::size_t end) { find_partners(begin, end); });
        std::vector<std::size_t> joined((n - 1) / kChunk + 1), kept(joined.size());
        parallel_for(n, kChunk, [&](std::size_t begin, std::size_t end) {
            std::size_t pairs = 0, others = 0;
            for (std::size_t i = begin; i < end; ++i) {
                if (!is_joined(i)) {
                    ++others;
                } else {
                    pairs += i < partner(i);
                }
            }
            joined[begin / kChunk] = pairs;
            kept[begin / kChunk] = pairs + others;
        });
        std::size_t node = used, place = 0;
        for (std::size_t c = 0; c < joined.size(); ++c) {
            node += std::exchange(joined[c], node);
            place += std::exchange(kept[c], place);
        }
        if (16 * (n - place) < n) return pair_up(used);
        parallel_for(n, kChunk, [&](std::size_t begin, std::size_t end) {
            std::size_t to = kept[begin / kChunk], parent = joined[begin / kChunk];
            for (std::size_t i = begin; i < end; ++i) {
                if (!is_joined(i)) {
                    next_[to++] = clusters_[i];
                } else if (i < partner(i)) {
                    next_[to++] = join(clusters_[i], clusters_[partner(i)], parent++);
                }
            }
        });
        next_.resize(place);
        clusters_.swap(next_);
        next_.resize(place);
        return node;
    }

    /// For rounds with hardly any mutual partners, which some inputs cause: joins neighbors, so
    /// that the number of rounds stays small.
    std::size_t pair_up(std::size_t used) {
        const std::size_t n = clusters_.size();
        next_.resize((n + 1) / 2);
        for (std::size_t i = 0; i + 1 < n; i += 2) {
            next_[i / 2] = join(clusters_[i], clusters_[i + 1], used++);
        }
        if (n % 2 != 0) next_.back() = clusters_.back();
        clusters_.swap(next_);
        next_.resize(clusters_.size());
        return used;
    }

    Cluster join(const Cluster& a, const Cluster& b, std::size_t parent) {
        Cluster both{a.box, static_cast<std::uint32_t>(parent),
                     a.kind == b.kind ? a.kind : std::uint32_t{kLeafKinds}};
        both.box.include(b.box);
        draft_.nodes[parent] = {both.box.box(), a.node, b.node, 0, 0};
        return both;
    }

    DraftBvh draft_;
    std::size_t count_ = 0;
    std::vector<Cluster> clusters_, next_;
    std::vector<std::uint64_t> best_;
};

/// Parts of fixed size, searched in parallel.
std::vector<DraftNode> find_seeds(std::span<const BuildReference> references,
                                  std::span<const std::uint64_t> codes, const LeafKinds& kinds) {
    std::vector<std::vector<DraftNode>> parts((references.size() - 1) / kChunk + 1);
    parallel_for(references.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        Seeds(references, codes, kinds, parts[begin / kChunk])
            .find(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end), 62);
    });
    std::vector<DraftNode> seeds;
    for (const auto& part : parts) seeds.insert(seeds.end(), part.begin(), part.end());
    return seeds;
}

}  // namespace

BinaryBvh build_by_clustering(std::vector<BuildReference>& references, const LeafKinds& kinds) {
    if (references.empty()) return {};
    const std::vector<std::uint64_t> codes = sort_along_curve(references);
    const DraftBvh draft = Clustering(find_seeds(references, codes, kinds)).run(references);
    return linearize(draft, references);
}

}  // namespace alhazen
