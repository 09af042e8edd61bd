#include "alhazen/accel/wide_bvh/build/curve_builder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>
#include <vector>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/accel/wide_bvh/build/morton_order.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::size_t kChunk = 4096;  // primitives in a task
/// Subtrees of at least this many leaves are separate tasks.
constexpr std::uint32_t kTaskLeaves = 1024;

/// Room for what follows the order of the primitives, in bytes for each: leaves mostly have six.
constexpr std::size_t kLaterBytes = 22;

using BlockCounts = std::array<std::size_t, kLeafKinds>;

/// Writes `count` indices in ascending order, by their ranks. The others are 0.
void sort_few(const std::uint32_t (&indices)[kCurveLeafSize], std::uint32_t* to,
              std::uint32_t count) {
    static_assert(kCurveLeafSize == 8);
    Int4 low, high, rank_low{}, rank_high{};
    std::memcpy(&low, indices, sizeof(low));
    std::memcpy(&high, indices + 4, sizeof(high));
    for (std::uint32_t i = 0; i < count; ++i) {
        const Int4 one = Int4{} + static_cast<std::int32_t>(indices[i]);
        rank_low -= one < low;
        rank_high -= one < high;
    }
    std::uint32_t ranks[kCurveLeafSize];
    std::memcpy(ranks, &rank_low, sizeof(rank_low));
    std::memcpy(ranks + 4, &rank_high, sizeof(rank_high));
    for (std::uint32_t i = 0; i < count; ++i) to[ranks[i]] = indices[i];
}

/// The leaves of a part of the curve.
class LeafSearch {
  public:
    LeafSearch(const CurveOrder& order, std::size_t size, const CurvePrimitives& primitives,
               const LeafKinds& kinds, std::uint32_t* indices)
        : order_(order),
          size_(size),
          primitives_(primitives),
          kinds_(kinds),
          common_(primitives.common_kind()),
          indices_(indices) {}

    /// Appends leaves with the numbers of their blocks within the part.
    void find(std::size_t begin, std::size_t end, std::vector<CurveLeaf>& leaves,
              BlockCounts& blocks) const {
        leaves.reserve((end - begin) / 4);
        std::uint64_t before = ~std::uint64_t{0};
        std::uint32_t next = size_of_subtree(begin, end, before);
        for (std::size_t i = begin; i < end;) {
            const std::uint64_t limit = bit_above(i, kMostJoined, before);
            std::uint32_t count = next;
            for (; i + count < end; count += next) {
                const std::size_t after = i + count;
                before = order_.place(after - 1) ^ order_.place(after);
                next = size_of_subtree(after, end, before);
                if (count + next > kCurveLeafSize || before >= limit) break;
            }
            std::uint32_t numbers[kCurveLeafSize]{};
            for (std::uint32_t k = 0; k < count; ++k) numbers[k] = order_.index(i + k);
            sort_few(numbers, indices_ + i, count);
            add(i, count, leaves, blocks);
            i += count;
        }
    }

  private:
    /// Neighbors that each fit into a block share one if they lie in a subtree of at most so many
    /// primitives: the blocks are fuller, and hardly larger.
    static constexpr std::size_t kMostJoined = 32;

    /// The lowest bit such that the subtree of places that differ from that of the i-th point below
    /// it only begins with this point, or has more than `most` points. `before`: the difference to
    /// the place before.
    [[nodiscard]] std::uint64_t bit_above(std::size_t i, std::size_t most,
                                          std::uint64_t before) const {
        if (i + most >= size_) return std::bit_floor(before | 1);
        return std::bit_floor(std::min(before, order_.place(i) ^ order_.place(i + most)) | 1);
    }

    /// The number of points in the largest subtree of the curve that begins with the i-th point and
    /// fits into a block; a block of points at the same place.
    [[nodiscard]] std::uint32_t size_of_subtree(std::size_t i, std::size_t end,
                                                std::uint64_t before) const {
        const std::uint64_t place = order_.place(i);
        const auto most = static_cast<std::uint32_t>(std::min(kCurveLeafSize, end - i));
        if (i + kCurveLeafSize < size_ && place == order_.place(i + kCurveLeafSize)) return most;
        const std::uint64_t limit = bit_above(i, kCurveLeafSize, before);
        std::uint32_t count = 1;
        while (count < most && (place ^ order_.place(i + count)) < limit) ++count;
        return count;
    }

    void add(std::size_t first, std::uint32_t count, std::vector<CurveLeaf>& leaves,
             BlockCounts& blocks) const {
        const std::uint64_t place = order_.place(first);
        std::uint32_t* const indices = indices_ + first;
        if (common_ == kLeafKinds) {
            std::stable_sort(indices, indices + count, [&](std::uint32_t a, std::uint32_t b) {
                return primitives_.kind(a) < primitives_.kind(b);
            });
        }
        for (std::uint32_t i = 0; i < count;) {
            const std::uint32_t kind =
                common_ == kLeafKinds ? primitives_.kind(indices[i]) : common_;
            const std::uint32_t most = std::min(count, i + kinds_[kind].width());
            std::uint32_t last = i + 1;
            while (last < most &&
                   (common_ != kLeafKinds || primitives_.kind(indices[last]) == kind)) {
                ++last;
            }
            leaves.push_back({place, static_cast<std::uint32_t>(first) + i, last - i, kind,
                              static_cast<std::uint32_t>(blocks[kind]++)});
            i = last;
        }
    }

    const CurveOrder& order_;
    std::size_t size_;
    const CurvePrimitives& primitives_;
    LeafKinds kinds_;
    std::uint32_t common_;
    std::uint32_t* indices_;
};

/// All leaves: boxes and kinds as references, numbered as the leaves are, the areas of their
/// surfaces, and their places.
struct FilledLeaves {
    std::uint32_t count = 0;
    BuildReference* references = nullptr;
    std::uint64_t* places = nullptr;
    float* areas = nullptr;
};

FilledLeaves fill_leaves(CurvePrimitives& primitives, const LeafKinds& kinds, HugeRoom& room) {
    const std::uint32_t size = primitives.size();
    std::uint32_t* const indices = room.take<std::uint32_t>(size);
    const std::size_t kept = room.used();
    const std::size_t parts = (size - 1) / kChunk + 1;
    std::vector<std::vector<CurveLeaf>> leaves(parts);
    std::vector<BlockCounts> blocks(parts);
    {
        const auto centers = [&](std::size_t begin, std::size_t end, Float4* to) {
            primitives.centers(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                               to);
        };
        const CurveOrder order({size, centers}, room);
        const LeafSearch search(order, size, primitives, kinds, indices);
        parallel_for(size, kChunk, [&](std::size_t begin, std::size_t end) {
            search.find(begin, end, leaves[begin / kChunk], blocks[begin / kChunk]);
        });
    }
    BlockCounts all_blocks{};
    std::vector<std::uint32_t> starts(parts);
    FilledLeaves filled;
    for (std::size_t part = 0; part < parts; ++part) {
        starts[part] = filled.count;
        filled.count += static_cast<std::uint32_t>(leaves[part].size());
        for (std::size_t k = 0; k < kLeafKinds; ++k) {
            all_blocks[k] += std::exchange(blocks[part][k], all_blocks[k]);
        }
    }
    room.rewind(kept);
    primitives.resize(all_blocks);
    filled.references = room.take<BuildReference>(filled.count);
    filled.places = room.take<std::uint64_t>(filled.count);
    filled.areas = room.take<float>(filled.count);
    parallel_for(parts, 1, [&](std::size_t part, std::size_t) {
        std::vector<CurveLeaf>& here = leaves[part];
        for (CurveLeaf& leaf : here) {
            leaf.offset += static_cast<std::uint32_t>(blocks[part][leaf.kind]);
        }
        const std::uint32_t first = starts[part];
        primitives.fill(here, indices, first, filled.references + first, filled.areas + first);
        std::transform(here.begin(), here.end(), filled.places + first,
                       [](const CurveLeaf& leaf) { return leaf.place; });
    });
    return filled;
}

/// A binary tree over leaves along the curve. A subtree of n leaves has 2 n - 1 nodes.
class CurveTree {
  public:
    CurveTree(const FilledLeaves& leaves, BinaryNode* nodes) : leaves_(leaves), nodes_(nodes) {}

    void build() { (void)grow(0, leaves_.count, 0); }

  private:
    struct Grown {
        Box4 box;
        std::uint32_t kind = kLeafKinds;
    };

    Grown grow(std::uint32_t begin, std::uint32_t end, std::uint32_t index) {
        BinaryNode& node = nodes_[index];
        if (end - begin == 1) {
            const BuildReference& reference = leaves_.references[begin];
            node = {reference.box(), begin, end, 0, reference.kind};
            return {Box4(reference), reference.kind};
        }
        const std::uint32_t middle = divide(begin, end);
        const std::uint32_t right_index = index + 2 * (middle - begin);
        Grown left, right;
        if (end - begin < kTaskLeaves) {
            left = grow(begin, middle, index + 1);
            right = grow(middle, end, right_index);
        } else {
            parallel_invoke([&] { left = grow(begin, middle, index + 1); },
                            [&] { right = grow(middle, end, right_index); });
        }
        left.box.include(right.box);
        if (left.kind != right.kind) left.kind = kLeafKinds;
        node = {left.box.box(), begin, end, right_index, left.kind};
        return left;
    }

    /// Divides where the highest bit changes in which places differ, or in the middle if they are
    /// all equal.
    [[nodiscard]] std::uint32_t divide(std::uint32_t begin, std::uint32_t end) const {
        const std::uint64_t* const places = leaves_.places;
        const std::uint64_t differ = places[begin] ^ places[end - 1];
        if (differ == 0) return begin + (end - begin) / 2;
        const std::uint64_t mask = std::bit_floor(differ);
        const auto first_set =
            std::partition_point(places + begin, places + end,
                                 [mask](std::uint64_t place) { return (place & mask) == 0; });
        return static_cast<std::uint32_t>(first_set - places);
    }

    const FilledLeaves& leaves_;
    BinaryNode* nodes_;
};

/// A tree of nodes that another owner frees.
struct BorrowedTree {
    BorrowedTree(BinaryNode* nodes, std::size_t count)
        : binary{HugeArray<BinaryNode>(nodes), static_cast<std::uint32_t>(count), false} {}
    BorrowedTree(const BorrowedTree&) = delete;
    BorrowedTree& operator=(const BorrowedTree&) = delete;
    ~BorrowedTree() { (void)binary.nodes.release(); }

    BinaryBvh binary;
};

/// The blocks are filled already, in the order of the curve, which is that of the tree.
class FilledSink final : public LeafSink {
  public:
    explicit FilledSink(const FilledLeaves& leaves) : leaves_(leaves) {}

    void resize(const BlockCounts&) override {}
    float pack(std::uint32_t, std::size_t, std::span<const BuildReference> references) override {
        float area = 0;
        for (const BuildReference& r : references) area += leaves_.areas[r.id];
        return area;
    }

  private:
    const FilledLeaves& leaves_;
};

}  // namespace

WideBvh build_along_curve(CurvePrimitives& primitives, const LeafKinds& kinds,
                          std::uint32_t width) {
    if (primitives.size() == 0) return {};
    const std::size_t size = primitives.size();
    HugeRoom room(HugeRoom::bytes_for<std::uint32_t>(size) +
                  std::max(CurveOrder::room_bytes(size), kLaterBytes * size));
    const FilledLeaves leaves = fill_leaves(primitives, kinds, room);
    const std::size_t nodes = 2 * std::size_t{leaves.count} - 1;
    BorrowedTree tree(room.take<BinaryNode>(nodes), nodes);
    CurveTree(leaves, tree.binary.nodes.get()).build();
    // A reference is a block.
    LeafKinds blocks = kinds;
    for (LeafKind& kind : blocks) kind.width_log2 = 0;
    FilledSink sink(leaves);
    return collapse(tree.binary, {leaves.references, leaves.count}, blocks, sink, width);
}

}  // namespace alhazen
