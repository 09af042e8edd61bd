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
#include "alhazen/accel/wide_bvh/build/clustering.h"
#include "alhazen/accel/wide_bvh/build/collapse.h"
#include "alhazen/accel/wide_bvh/build/morton_order.h"
#include "alhazen/accel/wide_bvh/build/reinsertion.h"
#include "alhazen/accel/wide_bvh/build/sah_cost.h"
#include "alhazen/accel/wide_bvh/build/spatial_split.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"

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

BinaryBvh build_as(BuildQuality quality, std::vector<BuildReference>& references) {
    if (quality == BuildQuality::Fast) return build_by_clustering(references, kKinds);
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
    Leaves leaves;
    const BinaryBvh binary = build_as(quality, references);
    WideBvh tree = collapse(binary, references, kKinds, leaves);
    EXPECT_LE(tree.depth, kMaxWideDepth) << name;
    EXPECT_EQ(tree.empty, count == 0) << name;
    std::vector<int> seen(count);
    std::size_t wrong_boxes = 0, wrong_leaves = 0;
    const auto check_leaf = [&](NodeRef ref, const FloatBox& box) {
        const Leaves::Leaf& leaf = leaves.leaves[ref.kind()][ref.offset()];
        const auto size = static_cast<std::uint32_t>(leaf.ids.size());
        wrong_leaves += !leaf.one_kind || ref.count() != kKinds[ref.kind()].blocks(size);
        wrong_boxes += !contains(box, leaf.box);
        for (const std::uint32_t id : leaf.ids) ++seen[id];
    };
    if (!tree.empty && tree.root.is_leaf()) check_leaf(tree.root, binary.nodes[0].box);
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

TEST(MortonOrder, SortsByAllBitsAndKeepsTheOrderOfEqualCodes) {
    std::mt19937_64 random(6);
    std::vector<BuildReference> references;
    // Most lie in a corner so small that the first half of their codes is the same.
    for (std::size_t i = 0; i < 150000; ++i) {
        const float scale = i % 10 == 0 ? 1.0f : 0x1p-12f;
        const auto coordinate = [&] { return scale * static_cast<float>(random() % 64) / 64.0f; };
        const float x = coordinate(), y = coordinate(), z = coordinate();
        references.push_back(reference(i, x, y, z, 0));
    }
    std::vector<BuildReference> sorted(references.size());
    std::vector<std::uint64_t> codes(references.size());
    sort_along_curve(references, sorted, codes);
    float lo[3], hi[3];
    for (int k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax_element(
            references.begin(), references.end(),
            [k](const auto& a, const auto& b) { return a.center2(k) < b.center2(k); });
        lo[k] = least->center2(k);
        hi[k] = most->center2(k);
    }
    std::vector<bool> seen(references.size());
    std::size_t alike = 0, same = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const BuildReference& r = sorted[i];
        ASSERT_FALSE(seen[r.id]);
        seen[r.id] = true;
        std::uint64_t code = 0;
        for (int k = 0; k < 3; ++k) {
            const float place = (r.center2(k) - lo[k]) * (2097151.0f / (hi[k] - lo[k]));
            const auto number = static_cast<std::uint64_t>(std::min(place, 2097151.0f));
            for (int bit = 0; bit < 21; ++bit) code |= (number >> bit & 1) << (3 * bit + 2 - k);
        }
        ASSERT_EQ(codes[i], code);
        if (i == 0) continue;
        ASSERT_LE(codes[i - 1], codes[i]);
        alike += codes[i - 1] != codes[i] && codes[i - 1] >> 31 == codes[i] >> 31;
        if (codes[i - 1] != codes[i]) continue;
        ++same;
        ASSERT_LT(sorted[i - 1].id, r.id);
    }
    EXPECT_GT(alike, 1000u);
    EXPECT_GT(same, 1000u);
}

TEST(LocalFrame, PutsAnySceneIntoTheUnitCubeAndRoundsOutward) {
    std::mt19937_64 random(3);
    for (const double size : {1e-140, 1e-6, 1.0, 3e7, 1e140}) {
        for (const double shift : {0.0, 1.0, -1e6}) {
            const Box3 all{{shift * size, -size, 2 * size}, {shift * size + size, size, 3 * size}};
            const LocalFrame frame(all);
            EXPECT_TRUE(contains(FloatBox{{-1, -1, -1}, {1, 1, 1}}, frame.local(all)));
            for (int i = 0; i < 1000; ++i) {
                const double t = static_cast<double>(uniform(random));
                const Vec3 p = all.lo + 0.5 * (1 + t) * (all.hi - all.lo);
                const Vec3 q = frame.local(p);
                const FloatBox point = frame.local(Box3{p, p});
                for (int k = 0; k < 3; ++k) {
                    EXPECT_LE(static_cast<double>(point.lo[k]), q[k]);
                    EXPECT_GE(static_cast<double>(point.hi[k]), q[k]);
                    EXPECT_LE(point.hi[k] - point.lo[k], 0x1p-23f);
                }
            }
        }
    }
}

TEST(LocalFrame, RoundsInTheDirectionAskedForByLessThanOneStep) {
    std::mt19937_64 random(4);
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 200000; ++i) {
        const double x = std::ldexp(static_cast<double>(uniform(random)) + 1e-9,
                                    static_cast<int>(random() % 340) - 170);
        const float down = round_down(x), up = round_up(x);
        ASSERT_TRUE(static_cast<double>(down) <= x && x <= static_cast<double>(up)) << x;
        ASSERT_TRUE(up == down || std::nextafter(down, kInf) == up) << x;
    }
    EXPECT_EQ(round_down(0.0), 0.0f);
    EXPECT_LT(round_down(-1e-300), 0.0f);
    EXPECT_EQ(round_up(1e300), kInf);
    EXPECT_EQ(round_down(1e300), std::numeric_limits<float>::max());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
