#include <gtest/gtest.h>
#ifdef __SSE2__
#include <immintrin.h>
#endif

#include <algorithm>
#include <cfenv>
#include <limits>
#include <random>
#include <string>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"
#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/accel/wide_bvh/build/collapse.h"
#include "alhazen/accel/wide_bvh/build/curve_builder.h"
#include "alhazen/accel/wide_bvh/build/reinsertion.h"
#include "alhazen/accel/wide_bvh/build/sah_cost.h"
#include "alhazen/accel/wide_bvh/build/spatial_split.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/simd/targets.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr LeafKinds kKinds{LeafKind{3, 1.5f}, LeafKind{3, 1.5f}, LeafKind{0, 2.0f}};

/// Records leaves instead of packing them.
class Leaves final : public LeafSink {
  public:
    struct Leaf {
        std::vector<std::uint32_t> ids;
        FloatBox box;
        bool one_kind = true;
    };

    void resize(const std::array<std::size_t, kLeafKinds>& blocks) override {
        for (std::size_t kind = 0; kind < kLeafKinds; ++kind) leaves[kind].resize(blocks[kind]);
    }
    float pack(std::uint32_t kind, std::size_t offset,
               std::span<const BuildReference> references) override {
        Leaf& leaf = leaves[kind].at(offset);
        for (const BuildReference& r : references) {
            leaf.ids.push_back(r.id);
            leaf.box.include(r.box());
            leaf.one_kind = leaf.one_kind && r.kind == kind;
        }
        return 0;
    }

    /// [kind][offset]
    std::array<std::vector<Leaf>, kLeafKinds> leaves;
};

bool contains(const FloatBox& outer, const FloatBox& inner) {
    for (int k = 0; k < 3; ++k) {
        if (!(outer.lo[k] <= inner.lo[k] && inner.hi[k] <= outer.hi[k])) return false;
    }
    return true;
}

/// Splits the box of a reference of kind 0.
class BoxSplitter final : public ReferenceSplitter {
  public:
    [[nodiscard]] bool can_split(std::uint32_t kind) const override { return kind == 0; }
    void split(const BuildReference& reference, int axis, float plane, FloatBox& below,
               FloatBox& above) const override {
        below = above = reference.box();
        below.hi[axis] = above.lo[axis] = plane;
    }
};

/// References for the builder along a curve.
class ReferencesOnCurve final : public CurvePrimitives {
  public:
    ReferencesOnCurve(std::span<const BuildReference> references, Leaves& leaves)
        : references_(references), leaves_(leaves), common_(kLeafKinds) {
        const auto same = [&](const BuildReference& r) { return r.kind == references[0].kind; };
        if (std::all_of(references.begin(), references.end(), same) && !references.empty()) {
            common_ = references[0].kind;
        }
    }

    [[nodiscard]] std::uint32_t size() const override {
        return static_cast<std::uint32_t>(references_.size());
    }
    [[nodiscard]] std::uint32_t common_kind() const override { return common_; }
    [[nodiscard]] std::uint32_t kind(std::uint32_t index) const override {
        return references_[index].kind;
    }
    void centers(std::uint32_t begin, std::uint32_t end, Float4* to) const override {
        for (std::uint32_t i = begin; i < end; ++i) {
            const BuildReference& r = references_[i];
            to[i - begin] = Float4{r.center2(0), r.center2(1), r.center2(2), 0};
        }
    }
    void resize(const std::array<std::size_t, kLeafKinds>& blocks) override {
        leaves_.resize(blocks);
    }
    void fill(std::span<const CurveLeaf> leaves, const std::uint32_t* indices, std::uint32_t first,
              BuildReference* boxes, float* areas) const override {
        for (const CurveLeaf& leaf : leaves) {
            std::vector<BuildReference> here;
            const std::span its(indices + leaf.first, leaf.count);
            EXPECT_TRUE(std::is_sorted(its.begin(), its.end()));
            EXPECT_LE(leaf.count, kKinds[leaf.kind].width());
            for (const std::uint32_t index : its) here.push_back(references_[index]);
            *areas++ = leaves_.pack(leaf.kind, leaf.offset, here);
            *boxes++ = {leaves_.leaves[leaf.kind][leaf.offset].box, first++, leaf.kind};
        }
    }

  private:
    std::span<const BuildReference> references_;
    Leaves& leaves_;
    std::uint32_t common_;
};

BinaryBvh build_as(BuildQuality quality, std::vector<BuildReference>& references) {
    if (quality == BuildQuality::Default) return build_binary(references, kKinds);
    DraftBvh draft = draft_of(build_with_spatial_splits(references, kKinds, BoxSplitter()), kKinds);
    EXPECT_GE(reinsert(draft), 0.0);
    return linearize(draft, references);
}

/// Builds a tree, checks that it holds every primitive once (at least once with spatial splits)
/// within its boxes, and returns it.
WideBvh build_and_check(BuildQuality quality, std::vector<BuildReference> references,
                        std::string name) {
    name += std::string(", ") + name_of(quality);
    const std::size_t count = references.size();
    FloatBox all;
    for (const BuildReference& r : references) all.include(r.box());
    Leaves leaves;
    WideBvh tree;
    if (quality == BuildQuality::Fast) {
        ReferencesOnCurve primitives(references, leaves);
        tree = build_along_curve(primitives, kKinds);
    } else {
        const BinaryBvh binary = build_as(quality, references);
        tree = collapse(binary, references, kKinds, leaves);
    }
    EXPECT_LE(tree.depth, kMaxWideDepth) << name;
    EXPECT_EQ(tree.empty, count == 0) << name;
    std::vector<int> seen(count);
    std::size_t wrong_boxes = 0, wrong_leaves = 0;
    // A leaf is recorded as one, or block by block.
    const auto check_leaf = [&](NodeRef ref, const FloatBox& box) {
        std::uint32_t blocks = 0;
        for (std::uint32_t i = 0; i < ref.count(); ++i) {
            const Leaves::Leaf& part = leaves.leaves[ref.kind()].at(ref.offset() + i);
            blocks += kKinds[ref.kind()].blocks(static_cast<std::uint32_t>(part.ids.size()));
            wrong_leaves += !part.one_kind;
            if (part.ids.empty()) continue;
            wrong_boxes += !contains(box, part.box);
            for (const std::uint32_t id : part.ids) ++seen[id];
        }
        wrong_leaves += ref.count() != blocks;
    };
    if (!tree.empty && tree.root.is_leaf()) check_leaf(tree.root, all);
    for (const WideNode& node : tree.nodes) {
        for (std::size_t i = 0; i < WideNode::kWidth; ++i) {
            const FloatBox box = node.box(i);
            if (i >= node.child_count()) {
                EXPECT_EQ(box, FloatBox{}) << name << ": a free slot can be hit";
            } else if (node.child[i].is_leaf()) {
                check_leaf(node.child[i], box);
            } else {
                const WideNode& child = tree.nodes[node.child[i].index()];
                for (std::size_t j = 0; j < child.child_count(); ++j) {
                    wrong_boxes += !contains(box, child.box(j));
                }
            }
        }
    }
    EXPECT_EQ(wrong_boxes, 0u) << name;
    EXPECT_EQ(wrong_leaves, 0u) << name;
    if (quality == BuildQuality::High) {
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 0), 0) << name;
    } else {
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<long>(count)) << name;
    }
    return tree;
}

/// Returns the greatest depth over all qualities.
int build_and_check(const std::vector<BuildReference>& references, const std::string& name) {
    int depth = 0;
    for (const BuildQualityEntry& entry : build_quality_table()) {
        depth = std::max(depth, build_and_check(entry.quality, references, name).depth);
    }
    return depth;
}

BuildReference reference(std::size_t id, float x, float y, float z, float size,
                         std::uint32_t kind = 0) {
    const float p[3] = {x, y, z};
    FloatBox box;
    for (int k = 0; k < 3; ++k) {
        box.lo[k] = p[k] - size;
        box.hi[k] = p[k] + size;
    }
    return {box, static_cast<std::uint32_t>(id), kind};
}

float uniform(std::mt19937_64& random) {
    return static_cast<float>(random() >> 40) * 0x1p-24f * 2 - 1;
}

/// The places of parts of a tree depend on the order in which threads end.
void expect_same_tree(const BinaryBvh& a, std::uint32_t at, const BinaryBvh& b, std::uint32_t to) {
    const BinaryNode &one = a.nodes[at], &other = b.nodes[to];
    ASSERT_EQ(one.box, other.box);
    ASSERT_EQ(one.begin, other.begin);
    ASSERT_EQ(one.end, other.end);
    ASSERT_EQ(one.kind, other.kind);
    ASSERT_EQ(one.is_leaf(), other.is_leaf());
    if (one.is_leaf()) return;
    expect_same_tree(a, at + 1, b, to + 1);
    expect_same_tree(a, one.right, b, other.right);
}

TEST(WideBvhBuild, HoldsEveryPrimitiveOnceWithinItsBoxes) {
    std::mt19937_64 random(1);
    for (const std::size_t count : {0, 1, 2, 3, 8, 9, 12, 13, 64, 65, 1000, 20000}) {
        std::vector<BuildReference> references;
        for (std::size_t i = 0; i < count; ++i) {
            const float x = uniform(random), y = uniform(random), z = uniform(random);
            references.push_back(reference(i, x, y, z, 0.01f * std::abs(uniform(random)),
                                           static_cast<std::uint32_t>(random() % 3)));
        }
        build_and_check(references, std::to_string(count) + " of three kinds");
        for (BuildReference& r : references) r.kind = 0;
        build_and_check(references, std::to_string(count) + " of one kind");
    }
}

#ifdef __SSE2__
/// The floating-point mode that other libraries set while they trace rays.
TEST(WideBvhBuild, HoldsEveryPrimitiveWhereDenormalNumbersAreZero) {
    struct DenormalsAreZero {
        unsigned int before = _mm_getcsr();
        DenormalsAreZero() { _mm_setcsr(before | 0x8040); }
        ~DenormalsAreZero() { _mm_setcsr(before); }
    };
    std::mt19937_64 random(8);
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < 3000; ++i) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        references.push_back(reference(i, x, y, z, 0.01f));
    }
    const DenormalsAreZero mode;
    build_and_check(references, "denormals are zero");
}
#endif

#ifndef __clang__  // computes both sides of conditions
TEST(WideBvhBuild, MakesNoInvalidNumbers) {
    std::mt19937_64 random(7);
    for (const std::size_t count : {2, 3, 5, 9, 13, 40, 200}) {
        for (const int flat : {0, 1, 2, 3}) {
            std::vector<BuildReference> references;
            for (std::size_t i = 0; i < count; ++i) {
                float p[3] = {uniform(random), uniform(random), uniform(random)};
                if (flat < 3) p[flat] = 0.25f;
                references.push_back(reference(i, p[0], p[1], p[2], 0.01f));
            }
            for (const BuildQualityEntry& entry : build_quality_table()) {
                std::feclearexcept(FE_INVALID);
                build_and_check(entry.quality, references, "flat");
                EXPECT_FALSE(std::fetestexcept(FE_INVALID)) << entry.name << ", " << count;
            }
        }
    }
}
#endif

TEST(WideBvhBuild, TheTreeDoesNotDependOnTheInstructionSet) {
    std::mt19937_64 random(9);
    for (const std::size_t count : {2, 12, 13, 130, 1030, 70000}) {
        std::vector<BuildReference> references;
        for (std::size_t i = 0; i < count; ++i) {
            const float x = uniform(random), y = uniform(random), z = uniform(random);
            references.push_back(reference(i, x, y, 0.1f * z, 0.01f * std::abs(uniform(random))));
        }
        std::vector<BuildReference> first;
        BinaryBvh tree;
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride forced(target);
            std::vector<BuildReference> ordered = references;
            const bool one_thread = !first.empty();
            BinaryBvh other;
            ThreadLimit(one_thread ? 1 : 0).run([&] { other = build_binary(ordered, kKinds); });
            if (!one_thread) {
                first = std::move(ordered);
                tree = std::move(other);
                continue;
            }
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(ordered[i].id, first[i].id) << target << ", " << count << ", " << i;
            }
            expect_same_tree(tree, 0, other, 0);
        }
    }
}

TEST(WideBvhBuild, ManyIdenticalBoxesGiveAShallowTree) {
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < 300000; ++i) references.push_back(reference(i, 0, 0, 0, 0.5f));
    EXPECT_LE(build_and_check(references, "identical"), 20);
}

TEST(WideBvhBuild, ManyPointsOnALineGiveAShallowTree) {
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < 300000; ++i) {
        references.push_back(reference(i, static_cast<float>(i) * 1e-6f, 0, 0, 0));
    }
    EXPECT_LE(build_and_check(references, "line"), 20);
}

TEST(WideBvhBuild, AMillionGiveAShallowTreeByDefault) {
    std::vector<BuildReference> identical, line;
    for (std::size_t i = 0; i < 1000000; ++i) {
        identical.push_back(reference(i, 0, 0, 0, 0.5f));
        line.push_back(reference(i, static_cast<float>(i) * 1e-6f, 0, 0, 0));
    }
    const BuildQuality quality = BuildQuality::Default;
    EXPECT_LE(build_and_check(quality, std::move(identical), "identical").depth, 20);
    EXPECT_LE(build_and_check(quality, std::move(line), "line").depth, 16);
}

TEST(WideBvhBuild, NestedScalesAndGeometricSpacingStayWithinTheDepth) {
    std::vector<BuildReference> nested, spaced;
    for (std::size_t i = 0; i < 20000; ++i) {
        const float scale = std::ldexp(1.0f, -static_cast<int>(i % 120));
        nested.push_back(reference(i, 0, 0, 0, scale));
        spaced.push_back(reference(i, scale, scale, 0, 0.25f * scale, i % 3 == 0 ? 1 : 0));
    }
    build_and_check(nested, "nested");
    build_and_check(spaced, "spaced");
}

TEST(WideBvhBuild, AChainAsLongAsItsLeavesIsBalanced) {
    std::vector<BuildReference> references;
    DraftBvh draft;
    constexpr std::uint32_t kCount = 50000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        references.push_back(reference(i, static_cast<float>(i), 0, 0, 0.5f));
        draft.nodes.push_back({references.back().box(), 0, 0, i, i + 1});
    }
    draft.root = 0;
    for (std::uint32_t i = 1; i < kCount; ++i) {
        DraftNode node{draft.nodes[draft.root].box, draft.root, i, 0, 0};
        node.box.include(draft.nodes[i].box);
        draft.nodes.push_back(node);
        draft.root = static_cast<std::uint32_t>(draft.nodes.size() - 1);
    }
    const BinaryBvh tree = linearize(draft, references);
    ASSERT_EQ(references.size(), kCount);
    Leaves leaves;
    EXPECT_LE(collapse(tree, references, kKinds, leaves).depth, 64);
    for (std::uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(references[i].id, i);
}

TEST(WideBvhBuild, TheExpectedCostIsFarBelowThatOfHalving) {
    std::mt19937_64 random(2);
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < 20000; ++i) {
        // Clusters of very different size, a bad case for halving.
        const float scale = i % 4 == 0 ? 1.0f : 0.01f;
        const float x = scale * uniform(random), y = scale * uniform(random);
        references.push_back(reference(i, x, y, scale * uniform(random), 0.003f * scale));
    }
    const WideBvh tree = build_and_check(BuildQuality::Default, references, "clusters");
    float cost = 0;
    for (const WideNode& node : tree.nodes) {
        for (std::size_t i = 0; i < node.child_count(); ++i) cost += node.box(i).weight();
    }
    FloatBox all;
    for (const BuildReference& r : references) all.include(r.box());
    // Measured: 21.
    EXPECT_LT(cost / all.weight(), 30.0f);
}

/// Boxes on a coarse lattice: many ties.
std::vector<BuildReference> lattice_references(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < count; ++i) {
        const auto coordinate = [&] { return static_cast<float>(random() % 7) * 0.25f - 0.75f; };
        const float x = coordinate(), y = coordinate(), z = coordinate();
        references.push_back(reference(i, x, y, z, 0.125f * static_cast<float>(random() % 3),
                                       static_cast<std::uint32_t>(random() % 2)));
    }
    return references;
}

/// The least cost of a subtree as at most `budget` wide subtrees, by trying all.
double least_cost(const BinaryBvh& binary, std::uint32_t index, std::uint32_t budget,
                  std::uint32_t width) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const BinaryNode& node = binary.nodes[index];
    const auto area = static_cast<double>(node.box.weight());
    double as_leaf = kNever;
    if (node.kind != kLeafKinds) {
        const LeafKind& kind = kKinds[node.kind];
        const std::uint32_t blocks = kind.blocks(node.size());
        if (blocks <= NodeRef::kMaxBlocks) as_leaf = area * static_cast<double>(kind.cost) * blocks;
    }
    if (node.is_leaf()) return as_leaf;
    const auto spread = [&](std::uint32_t most) {
        double least = kNever;
        for (std::uint32_t left = 1; left < most; ++left) {
            least = std::min(least, least_cost(binary, index + 1, left, width) +
                                        least_cost(binary, node.right, most - left, width));
        }
        return least;
    };
    if (budget > 1) return std::min(least_cost(binary, index, 1, width), spread(budget));
    return std::min(as_leaf, area + spread(width));
}

TEST(WideBvhBuild, CollapseFindsTheLeastCost) {
    for (const std::uint32_t width : {4u, 8u}) {
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            std::vector<BuildReference> references = lattice_references(width == 4 ? 18 : 14, seed);
            // Leaves of one primitive: deeper trees.
            for (BuildReference& r : references) r.kind = 2;
            const BinaryBvh binary = build_binary(references, kKinds);
            Leaves leaves;
            const WideBvh tree = collapse(binary, references, kKinds, leaves, width);
            ASSERT_FALSE(tree.root.is_leaf());
            const double least =
                least_cost(binary, 0, 1, width) / static_cast<double>(binary.nodes[0].box.weight());
            EXPECT_NEAR(sah_cost(tree, kKinds), least, 1e-5 * least) << width << ", " << seed;
        }
    }
}

TEST(WideBvhBuild, NodesKnowTheOrderOfTheirBoxes) {
    for (const std::uint32_t width : {4u, 8u, 16u}) {
        std::vector<BuildReference> references = lattice_references(500, width);
        const BinaryBvh binary = build_binary(references, kKinds);
        Leaves leaves;
        const WideBvh tree = collapse(binary, references, kKinds, leaves, width);
        with_nodes(tree, [&](const auto& nodes) {
            ASSERT_GT(nodes.size(), 1u);
            for (const auto& node : nodes) {
                auto same = node;
                same.set_order();
                EXPECT_TRUE(std::equal(node.order, node.order + 8, same.order)) << width;
            }
        });
    }
}

TEST(WideBvhBuild, NodesThatAreNotInUseAreFew) {
    std::mt19937_64 random(5);
    std::vector<BuildReference> references;
    for (std::size_t i = 0; i < 100000; ++i) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        references.push_back(reference(i, x, y, z, 0.001f));
    }
    const BinaryBvh binary = build_binary(references, kKinds);
    // Leaves have up to four.
    EXPECT_LT(binary.index_count, references.size());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
