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

/// Finds small subtrees in a part of the sorted references.
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
    /// Divides at the first bit in which codes differ, or in the middle if they are all equal.
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

/// The partners of the clusters of a chunk: by the joined box of the least surface, then by the
/// index that differs in the lowest bits.
class Partners {
  public:
    Partners(const Cluster* clusters, std::size_t count) : clusters_(clusters), count_(count) {}

    /// Writes the partners of the clusters from `begin` to `end`, at most kChunk.
    void find(std::size_t begin, std::size_t end, std::uint32_t* partners) {
        if (load(begin, end)) {
            weigh<true>(end - begin);
        } else {
            weigh<false>(end - begin);
        }
        choose(begin, end - begin, partners);
    }

  private:
    static constexpr std::size_t kLanes = 4;
    static constexpr std::size_t kMargin = 2 * kRadius + 3 * kLanes;  // read beside a chunk
    static constexpr std::size_t kCapacity = kChunk + kMargin;

    /// Loads clusters from kRadius before the chunk to kRadius behind it, one row for each value;
    /// missing ones have an infinite box. Returns whether kinds differ.
    bool load(std::size_t begin, std::size_t end) {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        const std::size_t rows = end - begin + kMargin;
        const std::uint32_t kind = clusters_[begin].kind;
        bool mixed = kind == kLeafKinds;
        for (std::size_t i = 0; i < rows; ++i) {
            const std::size_t from = begin + i - kRadius;  // wraps around before the first one
            if (from >= count_) {
                for (auto& row : lo_) row[i] = -kFar;
                for (auto& row : hi_) row[i] = kFar;
                kind_[i] = kind;
                continue;
            }
            const Cluster& c = clusters_[from];
            for (int k = 0; k < 3; ++k) {
                lo_[k][i] = c.box.lo[k];
                hi_[k][i] = c.box.hi[k];
            }
            kind_[i] = c.kind;
            mixed = mixed || c.kind != kind;
        }
        return mixed;
    }
    template <class V, class T>
    static V lanes(const T* from) {
        V v;
        std::memcpy(&v, from, sizeof(v));
        return v;
    }
    /// weight_[d - 1][i]: of rows i and i + d together.
    template <bool kMixed>
    void weigh(std::size_t size) {
        for (std::size_t i = 0; i < size + kRadius + kLanes; i += kLanes) {
            const Float4 lo[3] = {lanes<Float4>(&lo_[0][i]), lanes<Float4>(&lo_[1][i]),
                                  lanes<Float4>(&lo_[2][i])};
            const Float4 hi[3] = {lanes<Float4>(&hi_[0][i]), lanes<Float4>(&hi_[1][i]),
                                  lanes<Float4>(&hi_[2][i])};
            for (std::size_t d = 1; d <= kRadius; ++d) {
                // Not a loop, in which the compiler would keep the boxes in memory.
                const auto size_along = [&](std::size_t k) {
                    return greater(lanes<Float4>(&hi_[k][i + d]), hi[k]) -
                           lesser(lanes<Float4>(&lo_[k][i + d]), lo[k]);
                };
                const Float4 x = size_along(0), y = size_along(1), z = size_along(2);
                // As Box4::weight.
                Float4 weight = x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
                if constexpr (kMixed) {
                    // Kinds do not share blocks.
                    const Int4 differ = lanes<Int4>(&kind_[i + d]) != lanes<Int4>(&kind_[i]);
                    weight += bits_as<Float4>(bits_as<Int4>(weight) & differ);
                }
                std::memcpy(&weight_[d - 1][i], &weight, sizeof(weight));
            }
        }
    }
    template <class To, class From>
    static To bits_as(From from) {
        To to;
        static_assert(sizeof(to) == sizeof(from));
        std::memcpy(&to, &from, sizeof(to));
        return to;
    }
    void choose(std::size_t begin, std::size_t size, std::uint32_t* partners) const {
        for (std::size_t i = 0; i < size; i += kLanes) {
            Float4 least = lanes<Float4>(&weight_[0][kRadius + i]);
            for (std::size_t d = 1; d <= kRadius; ++d) {
                least = lesser(lanes<Float4>(&weight_[d - 1][kRadius + i]), least);
                least = lesser(lanes<Float4>(&weight_[d - 1][kRadius + i - d]), least);
            }
            // Among those with the least weight selects the one whose index differs least. Indices
            // are compared as the bits of floats, which have the same order; the placeholder for
            // all others is larger.
            const Int4 self = Int4{0, 1, 2, 3} + static_cast<std::int32_t>(begin + i);
            constexpr std::int32_t kOther = 1 << 30;
            // Avoids denormal numbers, which some threads treat as zero.
            constexpr std::int32_t kBias = 1 << 23;
            Float4 apart = bits_as<Float4>(Int4{} + (kOther + kBias));
            const auto offer = [&](const float* weights, Int4 other) {
                const Int4 heavier = lanes<Float4>(weights) != least;
                const Int4 differ = (self ^ other) & (kOther - 1);
                const Int4 offered = (~heavier & differ) | (heavier & kOther);
                apart = lesser(bits_as<Float4>(offered + kBias), apart);
            };
            for (std::size_t d = 1; d <= kRadius; ++d) {
                const auto distance = static_cast<std::int32_t>(d);
                offer(&weight_[d - 1][kRadius + i], self + distance);
                offer(&weight_[d - 1][kRadius + i - d], self - distance);
            }
            const Int4 partner = self ^ (bits_as<Int4>(apart) - kBias);
            std::memcpy(partners + begin + i, &partner,
                        std::min(kLanes, size - i) * sizeof(std::uint32_t));
        }
    }

    const Cluster* clusters_;
    std::size_t count_;
    float lo_[3][kCapacity], hi_[3][kCapacity];
    std::uint32_t kind_[kCapacity];
    float weight_[kRadius][kCapacity];
};

class Clustering {
  public:
    /// `nodes`: the seeds, followed by capacity for one node less than there are seeds.
    Clustering(DraftNode* nodes, std::size_t count)
        : nodes_(nodes),
          count_(count),
          clusters_(make_huge_array<Cluster>(count)),
          next_(make_huge_array<Cluster>(count)),
          partners_(make_huge_array<std::uint32_t>(count)) {}

    /// Clusters until one is left and returns the root.
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

    /// For rounds with hardly any mutual partners, which occur for some inputs: joins neighbors,
    /// which bounds the number of rounds.
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
    std::size_t count_;  ///< number of clusters
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
