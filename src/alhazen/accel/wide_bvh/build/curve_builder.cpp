#include "alhazen/accel/wide_bvh/build/curve_builder.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <span>
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

/// Writes the lower halves of the first `count` entries in ascending order, by their ranks. Reads
/// kCurveLeafSize entries.
void sort_few(const std::uint64_t* entries, std::uint32_t* to, std::uint32_t count) {
    static_assert(kCurveLeafSize == 8);
    constexpr int k = std::endian::native == std::endian::little ? 0 : 1;  // the lower half
    Int4 pairs[4];
    std::memcpy(pairs, entries, sizeof(pairs));
    const Int4 low = __builtin_shufflevector(pairs[0], pairs[1], k, k + 2, k + 4, k + 6);
    const Int4 high = __builtin_shufflevector(pairs[2], pairs[3], k, k + 2, k + 4, k + 6);
    Int4 rank_low{}, rank_high{};
    for (std::uint32_t i = 0; i < count; ++i) {
        const Int4 one = Int4{} + static_cast<std::int32_t>(entries[i]);
        rank_low -= one < low;
        rank_high -= one < high;
    }
    std::uint32_t ranks[kCurveLeafSize];
    std::memcpy(ranks, &rank_low, sizeof(rank_low));
    std::memcpy(ranks + 4, &rank_high, sizeof(rank_high));
    for (std::uint32_t i = 0; i < count; ++i) {
        to[ranks[i]] = static_cast<std::uint32_t>(entries[i]);
    }
}

/// Finds the leaves of a part of the curve. `kDivided`: some cells are divided anew; in the others
/// places are entries of the order, whose lower halves do not matter.
template <bool kDivided>
class LeafSearch {
  public:
    LeafSearch(const CurveOrder& order, std::size_t size, const CurvePrimitives& primitives,
               const LeafKinds& kinds, std::uint32_t* indices)
        : order_(order),
          entries_(order.entries()),
          size_(size),
          primitives_(primitives),
          kinds_(kinds),
          common_(primitives.common_kind()),
          indices_(indices) {}

    /// Writes leaves with the numbers of their blocks within the part. Returns the end of these.
    CurveLeaf* find(std::size_t begin, std::size_t end, CurveLeaf* to, BlockCounts& blocks) const {
        const bool one_block = common_ != kLeafKinds && kinds_[common_].width() >= kCurveLeafSize;
        std::uint64_t before = ~std::uint64_t{0};
        std::uint32_t next = size_of_subtree(begin, end, before);
        for (std::size_t i = begin; i < end;) {
            const std::uint64_t limit = bit_above(i, kMostJoined, before);
            std::uint32_t count = next;
            for (; i + count < end; count += next) {
                const std::size_t after = i + count;
                before = place(after - 1) ^ place(after);
                next = size_of_subtree(after, end, before);
                if (count + next > kCurveLeafSize || before >= limit) break;
            }
            write_indices(i, count);
            if (one_block) {
                *to++ = {place(i) & -kUnit, static_cast<std::uint32_t>(i), count, common_,
                         static_cast<std::uint32_t>(blocks[common_]++)};
            } else {
                to = divide(i, count, to, blocks);
            }
            i += count;
        }
        return to;
    }

  private:
    /// Neighbors that each fit into a block share one if they lie in a subtree of at most so many
    /// primitives: the blocks are fuller, and hardly larger.
    static constexpr std::size_t kMostJoined = 32;
    /// The least difference of places.
    static constexpr std::uint64_t kUnit = kDivided ? 1 : std::uint64_t{1} << 32;

    [[nodiscard]] std::uint64_t place(std::size_t i) const {
        return kDivided ? order_.place(i) : entries_[i];
    }

    /// The lowest bit such that the subtree of places that differ from that of the i-th point below
    /// it only begins with this point, or has more than `most` points. `before`: the difference to
    /// the place before.
    [[nodiscard]] std::uint64_t bit_above(std::size_t i, std::size_t most,
                                          std::uint64_t before) const {
        if (i + most >= size_) return std::bit_floor(before | kUnit);
        return std::bit_floor(std::min(before, place(i) ^ place(i + most)) | kUnit);
    }

    /// The number of points in the largest subtree of the curve that begins with the i-th point and
    /// fits into a block; a block of points at the same place.
    [[nodiscard]] std::uint32_t size_of_subtree(std::size_t i, std::size_t end,
                                                std::uint64_t before) const {
        const std::uint64_t first = place(i);
        const auto most = static_cast<std::uint32_t>(std::min(kCurveLeafSize, end - i));
        std::uint64_t limit = before;
        if (i + kCurveLeafSize < size_) {
            const std::uint64_t across = first ^ place(i + kCurveLeafSize);
            if (across < kUnit) return most;
            limit = std::min(before, across);
        }
        limit = std::bit_floor(limit | kUnit);
        std::uint32_t count = 1;
        while (count < most && (first ^ place(i + count)) < limit) ++count;
        return count;
    }

    void write_indices(std::size_t first, std::uint32_t count) const {
        if (first + kCurveLeafSize <= size_) {
            return sort_few(entries_ + first, indices_ + first, count);
        }
        std::uint64_t last[kCurveLeafSize]{};
        std::copy_n(entries_ + first, count, last);
        sort_few(last, indices_ + first, count);
    }

    /// Divides a leaf by kinds and into blocks.
    CurveLeaf* divide(std::size_t first, std::uint32_t count, CurveLeaf* to,
                      BlockCounts& blocks) const {
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
            *to++ = {place(first) & -kUnit, static_cast<std::uint32_t>(first) + i, last - i, kind,
                     static_cast<std::uint32_t>(blocks[kind]++)};
            i = last;
        }
        return to;
    }

    const CurveOrder& order_;
    const std::uint64_t* entries_;
    std::size_t size_;
    const CurvePrimitives& primitives_;
    LeafKinds kinds_;
    std::uint32_t common_;
    std::uint32_t* indices_;
};

/// The leaves of the parts of a curve, in one array: pages of small arrays are cleared one by one.
class LeafLists {
  public:
    LeafLists(std::size_t size, std::size_t parts)
        : all_(make_huge_array<CurveLeaf>(size)), parts_(parts), blocks_(parts) {}

    [[nodiscard]] std::size_t parts() const { return parts_.size(); }
    [[nodiscard]] std::span<CurveLeaf> leaves(std::size_t part) { return parts_[part]; }
    /// Numbers of blocks.
    [[nodiscard]] BlockCounts& blocks(std::size_t part) { return blocks_[part]; }

    template <bool kDivided>
    void find(const LeafSearch<kDivided>& search, std::size_t size) {
        parallel_for(size, kChunk, [&](std::size_t begin, std::size_t end) {
            CurveLeaf found[kChunk];
            const std::size_t part = begin / kChunk;
            const std::span<CurveLeaf> here(found,
                                            search.find(begin, end, found, blocks_[part]));
            CurveLeaf* const to = all_.get() + used_.fetch_add(here.size());
            std::copy(here.begin(), here.end(), to);
            parts_[part] = {to, here.size()};
        });
    }

  private:
    HugeArray<CurveLeaf> all_;
    std::atomic<std::size_t> used_{0};
    std::vector<std::span<CurveLeaf>> parts_;
    std::vector<BlockCounts> blocks_;
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
    LeafLists lists(size, parts);
    {
        const auto centers = [&](std::size_t begin, std::size_t end, Float4* to) {
            primitives.centers(static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                               to);
        };
        const CurveOrder order({size, centers}, room);
        if (order.divided()) {
            lists.find(LeafSearch<true>(order, size, primitives, kinds, indices), size);
        } else {
            lists.find(LeafSearch<false>(order, size, primitives, kinds, indices), size);
        }
    }
    BlockCounts all_blocks{};
    std::vector<std::uint32_t> starts(parts);
    FilledLeaves filled;
    for (std::size_t part = 0; part < parts; ++part) {
        starts[part] = filled.count;
        filled.count += static_cast<std::uint32_t>(lists.leaves(part).size());
        for (std::size_t k = 0; k < kLeafKinds; ++k) {
            all_blocks[k] += std::exchange(lists.blocks(part)[k], all_blocks[k]);
        }
    }
    room.rewind(kept);
    primitives.resize(all_blocks);
    filled.references = room.take<BuildReference>(filled.count);
    filled.places = room.take<std::uint64_t>(filled.count);
    filled.areas = room.take<float>(filled.count);
    parallel_for(parts, 1, [&](std::size_t part, std::size_t) {
        const std::span<CurveLeaf> here = lists.leaves(part);
        for (CurveLeaf& leaf : here) {
            leaf.offset += static_cast<std::uint32_t>(lists.blocks(part)[leaf.kind]);
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
        if (end - begin < kTaskLeaves && all_differ(begin, end)) {
            return grow_along(begin, end, index);
        }
        if (end - begin == 1) return write_leaf(begin, index);
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
        return join(left, right, begin, end, index, right_index);
    }

    Grown write_leaf(std::uint32_t leaf, std::uint32_t index) {
        const BuildReference& reference = leaves_.references[leaf];
        const Box4 box(reference);
        set_node(nodes_[index], box, leaf, leaf + 1, 0, reference.kind);
        return {box, reference.kind};
    }
    Grown join(Grown left, const Grown& right, std::uint32_t begin, std::uint32_t end,
               std::uint32_t index, std::uint32_t right_index) {
        left.box.include(right.box);
        if (left.kind != right.kind) left.kind = kLeafKinds;
        set_node(nodes_[index], left.box, begin, end, right_index, left.kind);
        return left;
    }

    [[nodiscard]] bool all_differ(std::uint32_t begin, std::uint32_t end) const {
        const std::uint64_t* const first = leaves_.places + begin;
        const std::uint64_t* const last = leaves_.places + end;
        return std::adjacent_find(first, last) == last;
    }

    /// The same tree without a search for divisions, by one pass from the last leaf to the first.
    /// Subtrees wait for their left neighbors. The highest bits in which neighbors differ increase
    /// from the last subtree that waits to the first. A subtree lies on the left side of as many
    /// nodes as subtrees wait behind it, and has as many nodes before it beside those of the leaves
    /// before it.
    Grown grow_along(std::uint32_t begin, std::uint32_t end, std::uint32_t root) {
        struct Waiting {
            Grown tree;
            std::uint64_t before;  ///< difference to the place before
            std::uint32_t index, end;
        };
        std::array<Waiting, 64> waiting;
        std::uint32_t count = 0;
        for (std::uint32_t leaf = end - 1;; --leaf) {
            const std::uint32_t first = root + 2 * (leaf - begin);
            std::uint32_t last = leaf + 1, index = first + count;
            Grown tree = write_leaf(leaf, index);
            const std::uint64_t before = leaf == begin
                                             ? ~std::uint64_t{0}
                                             : leaves_.places[leaf - 1] ^ leaves_.places[leaf];
            // The first leaf joins all: two places may differ in every bit.
            while (count > 0 && (leaf == begin || waiting[count - 1].before < before)) {
                const Waiting& right = waiting[--count];
                last = right.end;
                index = first + count;
                tree = join(tree, right.tree, leaf, last, index, right.index);
            }
            if (leaf == begin) return tree;
            waiting[count++] = {tree, before, index, last};
        }
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
