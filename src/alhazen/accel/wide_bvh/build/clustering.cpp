#include "alhazen/accel/wide_bvh/build/clustering.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "alhazen/accel/wide_bvh/build/morton_order.h"
#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/accel/wide_bvh/build/tree_draft.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::size_t kRadius = 8;  // neighbors examined on each side
constexpr std::size_t kChunk = 4096;

using Int4 = std::int32_t __attribute__((vector_size(16)));

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
        : references_(references.data()), codes_(codes.data()), kinds_(kinds), out_(out) {}

    void find(std::uint32_t begin, std::uint32_t end) {
        if (end - begin <= kinds_[references_[begin].kind].indivisible()) {
            RangeSummary all;
            for (std::uint32_t i = begin; i < end; ++i) all.include(references_[i]);
            if (all.indivisible(kinds_)) {
                out_.push_back({all.box.box(), 0, 0, begin, end});
                return;
            }
        }
        const std::uint32_t middle = divide(begin, end);
        find(begin, middle);
        find(middle, end);
    }

  private:
    /// At the first bit in which codes differ; in the middle where they are all the same.
    [[nodiscard]] std::uint32_t divide(std::uint32_t begin, std::uint32_t end) const {
        const std::uint64_t differ = codes_[begin] ^ codes_[end - 1];
        if (differ == 0) return begin + (end - begin) / 2;
        const std::uint64_t mask = std::bit_floor(differ);
        const auto first_set =
            std::partition_point(codes_ + begin, codes_ + end,
                                 [mask](std::uint64_t code) { return (code & mask) == 0; });
        return static_cast<std::uint32_t>(first_set - codes_);
    }

    const BuildReference* references_;
    const std::uint64_t* codes_;
    LeafKinds kinds_;
    std::vector<DraftNode>& out_;
};

/// The partners of the clusters of a chunk: the joined box of the least surface, then the number
/// that differs in the lowest bits.
class Partners {
  public:
    Partners(const Cluster* clusters, std::size_t count) : clusters_(clusters), count_(count) {}

    /// Writes the partners of the clusters from `begin` to `end`, at most kChunk.
    void find(std::size_t begin, std::size_t end, std::uint32_t* partners) {
        load(begin, end);
        weigh(end - begin);
        choose(begin, end - begin, partners);
    }

  private:
    static constexpr std::size_t kLanes = 4;
    static constexpr std::size_t kMargin = 2 * kRadius + 3 * kLanes;  // read beside a chunk
    static constexpr std::size_t kRoom = kChunk + kMargin;

    /// Clusters from kRadius before the chunk to kRadius behind it, a row for each number. Where
    /// there is none, an infinite box stands.
    void load(std::size_t begin, std::size_t end) {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        const std::size_t rows = end - begin + kMargin;
        for (std::size_t i = 0; i < rows; ++i) {
            const std::size_t from = begin + i - kRadius;  // wraps around before the first one
            if (from >= count_) {
                for (auto& row : lo_) row[i] = -kFar;
                for (auto& row : hi_) row[i] = kFar;
                kind_[i] = 0;
                continue;
            }
            const Cluster& c = clusters_[from];
            for (int k = 0; k < 3; ++k) {
                lo_[k][i] = c.box.lo[k];
                hi_[k][i] = c.box.hi[k];
            }
            kind_[i] = c.kind;
        }
    }
    template <class V, class T>
    static V lanes(const T* from) {
        V v;
        std::memcpy(&v, from, sizeof(v));
        return v;
    }
    /// weight_[d - 1][i]: of rows i and i + d together.
    void weigh(std::size_t size) {
        for (std::size_t i = 0; i < size + kRadius + kLanes; i += kLanes) {
            Float4 lo[3], hi[3];
            for (std::size_t k = 0; k < 3; ++k) {
                lo[k] = lanes<Float4>(&lo_[k][i]);
                hi[k] = lanes<Float4>(&hi_[k][i]);
            }
            const Int4 kind = lanes<Int4>(&kind_[i]);
            for (std::size_t d = 1; d <= kRadius; ++d) {
                Float4 size_of[3];
                for (std::size_t k = 0; k < 3; ++k) {
                    size_of[k] = greater(lanes<Float4>(&hi_[k][i + d]), hi[k]) -
                                 lesser(lanes<Float4>(&lo_[k][i + d]), lo[k]);
                }
                const auto& [x, y, z] = size_of;
                // As Box4::weight.
                Float4 weight = x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
                // Kinds do not share blocks.
                const Int4 differ = lanes<Int4>(&kind_[i + d]) != kind;
                weight += masked(weight, differ);
                std::memcpy(&weight_[d - 1][i], &weight, sizeof(weight));
            }
        }
    }
    static Float4 masked(Float4 v, Int4 mask) {
        Int4 bits;
        std::memcpy(&bits, &v, sizeof(bits));
        bits &= mask;
        std::memcpy(&v, &bits, sizeof(v));
        return v;
    }
    void choose(std::size_t begin, std::size_t size, std::uint32_t* partners) const {
        for (std::size_t i = 0; i < size; i += kLanes) {
            const auto number = static_cast<std::int32_t>(begin + i);
            const Int4 self = Int4{0, 1, 2, 3} + number;
            Float4 least = Float4{1, 1, 1, 1} * std::numeric_limits<float>::infinity();
            Int4 apart{};
            const auto offer = [&](Float4 weight, Int4 other) {
                const Int4 differ = self ^ other;
                const Int4 better = (weight < least) | ((weight == least) & (differ < apart));
                least = lesser(weight, least);
                apart = (better & differ) | (~better & apart);
            };
            for (std::size_t d = 1; d <= kRadius; ++d) {
                const auto distance = static_cast<std::int32_t>(d);
                const float* const row = weight_[d - 1];
                offer(lanes<Float4>(row + kRadius + i), self + distance);
                offer(lanes<Float4>(row + kRadius + i - d), self - distance);
            }
            const Int4 partner = self ^ apart;
            std::memcpy(partners + begin + i, &partner,
                        std::min(kLanes, size - i) * sizeof(std::uint32_t));
        }
    }

    const Cluster* clusters_;
    std::size_t count_;
    float lo_[3][kRoom], hi_[3][kRoom];
    std::uint32_t kind_[kRoom];
    float weight_[kRadius][kRoom];
};

class Clustering {
  public:
    /// `nodes`: the seeds, and room for as many nodes less one.
    Clustering(DraftNode* nodes, std::size_t count)
        : nodes_(nodes),
          count_(count),
          clusters_(make_huge_array<Cluster>(count)),
          next_(make_huge_array<Cluster>(count)),
          partners_(make_huge_array<std::uint32_t>(count)) {}

    /// Returns the root.
    std::uint32_t run(const BuildReference* references) {
        parallel_for(count_, kChunk, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const DraftNode& node = nodes_[i];
                clusters_[i] = {Box4(node.box), static_cast<std::uint32_t>(i),
                                references[node.begin].kind};
            }
        });
        std::size_t used = count_;
        while (count_ > 1) used = round(used);
        return static_cast<std::uint32_t>(used - 1);
    }

  private:
    [[nodiscard]] bool is_joined(std::size_t i) const { return partners_[partners_[i]] == i; }

    /// Joins all mutual best partners; returns the number of nodes in use.
    std::size_t round(std::size_t used) {
        const std::size_t n = count_;
        parallel_for(n, kChunk, [&](std::size_t begin, std::size_t end) {
            const auto search = std::make_unique<Partners>(clusters_.get(), n);
            search->find(begin, end, partners_.get());
        });
        std::vector<std::size_t> joined((n - 1) / kChunk + 1), kept(joined.size());
        parallel_for(n, kChunk, [&](std::size_t begin, std::size_t end) {
            std::size_t pairs = 0, others = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const std::size_t one = is_joined(i);
                pairs += one & static_cast<std::size_t>(i < partners_[i]);
                others += 1 - one;
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
                } else if (i < partners_[i]) {
                    next_[to++] = join(clusters_[i], clusters_[partners_[i]], parent++);
                }
            }
        });
        clusters_.swap(next_);
        count_ = place;
        return node;
    }

    /// For rounds with hardly any mutual partners, which some inputs cause: joins neighbors, so
    /// that the number of rounds stays small.
    std::size_t pair_up(std::size_t used) {
        const std::size_t n = count_;
        for (std::size_t i = 0; i + 1 < n; i += 2) {
            next_[i / 2] = join(clusters_[i], clusters_[i + 1], used++);
        }
        if (n % 2 != 0) next_[n / 2] = clusters_[n - 1];
        clusters_.swap(next_);
        count_ = (n + 1) / 2;
        return used;
    }

    Cluster join(const Cluster& a, const Cluster& b, std::size_t parent) {
        Cluster both{a.box, static_cast<std::uint32_t>(parent),
                     a.kind == b.kind ? a.kind : std::uint32_t{kLeafKinds}};
        both.box.include(b.box);
        nodes_[parent] = {both.box.box(), a.node, b.node, 0, 0};
        return both;
    }

    DraftNode* nodes_;
    std::size_t count_;  ///< of clusters
    HugeArray<Cluster> clusters_, next_;
    HugeArray<std::uint32_t> partners_;
};

/// The seeds of parts of fixed size, searched in parallel.
std::vector<std::vector<DraftNode>> find_seeds(std::span<const BuildReference> references,
                                               std::span<const std::uint64_t> codes,
                                               const LeafKinds& kinds) {
    std::vector<std::vector<DraftNode>> parts((references.size() - 1) / kChunk + 1);
    parallel_for(references.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        std::vector<DraftNode>& part = parts[begin / kChunk];
        part.reserve((end - begin) / 2);
        Seeds(references, codes, kinds, part)
            .find(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end));
    });
    return parts;
}

}  // namespace

BinaryBvh build_by_clustering(std::span<BuildReference> references, const LeafKinds& kinds) {
    if (references.empty()) return {};
    const std::size_t size = references.size();
    const auto room = make_huge_array<BuildReference>(size);
    const std::span sorted(room.get(), size);
    HugeArray<DraftNode> nodes;
    std::size_t seeds = 0;
    {
        const auto codes = make_huge_array<std::uint64_t>(size);
        sort_along_curve(references, sorted, {codes.get(), size});
        const auto parts = find_seeds(sorted, {codes.get(), size}, kinds);
        for (const auto& part : parts) seeds += part.size();
        nodes = make_huge_array<DraftNode>(2 * seeds - 1);
        DraftNode* to = nodes.get();
        for (const auto& part : parts) to = std::copy(part.begin(), part.end(), to);
    }
    const std::uint32_t root = Clustering(nodes.get(), seeds).run(sorted.data());
    return linearize(DraftView{{nodes.get(), 2 * seeds - 1}, root}, sorted, references);
}

}  // namespace alhazen
