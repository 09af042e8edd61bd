// Of the children that a ray meets, the stack takes all but the nearest, the farthest first by the
// order of the octant, on every instruction set, or those of the highest slots first; and it drops
// what lies beyond the end of a ray.

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "alhazen/simd/dispatch.h"
#include "alhazen/simd/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "unit/accel/node_stack_test.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// Must follow foreach_target.h.
#include "alhazen/accel/wide_bvh/trace/node_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// Returns the nearest; sets the number of the others, their entries and their children.
std::size_t push_on_stack(const WideNode& node, const float* entries, const float* exits,
                          std::uint32_t octant, std::size_t& count, float* pushed_entries,
                          std::uint32_t* pushed_children) {
    NodeStack<8> stack;
    const Floats entry = load_unaligned(entries);
    const auto hit = entry <= load_unaligned(exits);
    count = 0;
    const std::size_t nearest =
        stack.push_but_nearest(count, node, entry, hit, bits_of(hit), octant);
    for (std::size_t i = 0; i < count; ++i) {
        pushed_entries[i] = stack.entry[i];
        pushed_children[i] = stack.child[i];
    }
    return nearest;
}

/// Pushes the children of `bits` without entries onto `below` others; returns the height, with the
/// children of the whole stack.
std::size_t push_by_slots(const WideNode& node, std::uint32_t bits, bool at_once, std::size_t below,
                          std::uint32_t* children) {
    NodeStack<8> stack;
    std::size_t height = 0;
    for (; height < below; ++height) stack.child[height] = children[height];
    if (at_once) {
        stack.push_at_once(height, node, bits);
    } else {
        stack.push_one_by_one(height, node, bits);
    }
    for (std::size_t i = 0; i < height; ++i) children[i] = stack.child[i];
    return height;
}

/// Of a stack of `count` entries above the sentinel; returns how many are left.
std::size_t drop_from_stack(float s_max, std::size_t count, float* entries,
                            std::uint32_t* children) {
    NodeStack<8> stack;
    stack.clear();
    for (std::size_t i = 0; i < count; ++i) {
        stack.entry[1 + i] = entries[i];
        stack.child[1 + i] = children[i];
    }
    const std::size_t left = stack.drop_beyond(1 + count, s_max) - 1;
    for (std::size_t i = 0; i < left; ++i) {
        entries[i] = stack.entry[1 + i];
        children[i] = stack.child[1 + i];
    }
    return NodeRef::from_bits(stack.child[0]) == NodeRef::none() ? left : count + 1;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

ALHAZEN_KERNEL_TABLE(push_on_stack);
ALHAZEN_KERNEL_TABLE(push_by_slots);
ALHAZEN_KERNEL_TABLE(drop_from_stack);

using NodeRandom = std::mt19937;

struct PushedChildren {
    std::size_t nearest = 8, count = 0;
    std::array<float, 8> entries{};
    std::array<std::uint32_t, 8> children{};
    friend bool operator==(const PushedChildren&, const PushedChildren&) = default;
};

/// A node of eight children in any places.
WideNode random_node(NodeRandom& random) {
    WideNode node;
    for (std::uint32_t slot = 0; slot < 8; ++slot) {
        FloatBox box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = static_cast<float>(random() % 1000);
            box.hi[k] = box.lo[k] + 1.0f;
        }
        node.set_box(slot, box);
        node.child[slot] = NodeRef::node(100 + slot);
    }
    node.set_order();
    return node;
}

PushedChildren expected_of(const WideNode& node, const float (&entries)[8], std::uint32_t hit,
                           std::uint32_t octant) {
    PushedChildren expected;
    for (std::size_t slot = 0; slot < 8; ++slot) {
        if ((hit >> slot & 1) == 0) continue;
        if (expected.nearest == 8 || entries[slot] < entries[expected.nearest]) {
            expected.nearest = slot;
        }
    }
    for (std::uint32_t i = 0; i < 8; ++i) {
        const std::uint32_t slot = node.order[octant] >> 3 * i & 7;
        if ((hit >> slot & 1) == 0 || slot == expected.nearest) continue;
        expected.entries[expected.count] = entries[slot];
        expected.children[expected.count++] = node.child[slot].bits();
    }
    return expected;
}

TEST(NodeStack, TakesAllChildrenButTheNearestOnEveryInstructionSet) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    // Far enough apart that the bits of the slot decide equal ones only.
    const float choices[] = {0.0f, 0x1p-100f, 0.25f, 1.0f, 1.0f, 3.5f, 1e37f, kInfinity};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        NodeRandom random(7);
        for (int i = 0; i < 5000; ++i) {
            const WideNode node = random_node(random);
            float entries[8], exits[8];
            std::uint32_t hit = 0;
            for (std::uint32_t slot = 0; slot < 8; ++slot) {
                entries[slot] = choices[random() % 8];
                const bool met = random() % 2 == 0;
                exits[slot] = met ? kInfinity : -1.0f;
                hit |= std::uint32_t{met} << slot;
            }
            if ((hit & (hit - 1)) == 0) continue;
            const std::uint32_t octant = random() % 8;
            PushedChildren pushed;
            pushed.nearest =
                ALHAZEN_KERNEL(push_on_stack)(node, entries, exits, octant, pushed.count,
                                              pushed.entries.data(), pushed.children.data());
            ASSERT_EQ(pushed, expected_of(node, entries, hit, octant)) << target << ", node " << i;
        }
    }
}

TEST(NodeStack, TakesChildrenFromTheHighestSlotDownOnEveryInstructionSet) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        NodeRandom random(9);
        for (std::uint32_t bits = 0; bits < 256; ++bits) {
            WideNode node = random_node(random);
            // Any child, the root and leaves as well.
            for (NodeRef& child : node.child) {
                child = NodeRef::from_bits(static_cast<std::uint32_t>(random()));
            }
            node.child[random() % 8] = NodeRef::node(0);
            const std::size_t below = random() % 20;
            std::vector<std::uint32_t> stack(below);
            for (std::uint32_t& child : stack) child = static_cast<std::uint32_t>(random());
            std::vector<std::uint32_t> expected = stack;
            for (std::size_t slot = 8; slot-- > 0;) {
                if ((bits >> slot & 1) != 0) expected.push_back(node.child[slot].bits());
            }
            for (const bool at_once : {false, true}) {
                std::vector<std::uint32_t> pushed = stack;
                pushed.resize(below + 8);
                pushed.resize(
                    ALHAZEN_KERNEL(push_by_slots)(node, bits, at_once, below, pushed.data()));
                ASSERT_EQ(pushed, expected) << target << ", children " << bits << ", " << at_once;
            }
        }
    }
}

TEST(NodeStack, DropsWhatLiesBeyondTheEndInItsOrder) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        NodeRandom random(8);
        for (int i = 0; i < 3000; ++i) {
            std::vector<float> entries(random() % 40);
            std::vector<std::uint32_t> children(entries.size());
            for (std::size_t k = 0; k < entries.size(); ++k) {
                entries[k] = static_cast<float>(random() % 10);
                children[k] = static_cast<std::uint32_t>(random());
            }
            if (!entries.empty()) entries[0] = -std::numeric_limits<float>::infinity();
            const auto s_max = static_cast<float>(random() % 11);
            std::vector<float> left_entries;
            std::vector<std::uint32_t> left_children;
            for (std::size_t k = 0; k < entries.size(); ++k) {
                if (entries[k] > s_max) continue;
                left_entries.push_back(entries[k]);
                left_children.push_back(children[k]);
            }
            const std::size_t left = ALHAZEN_KERNEL(drop_from_stack)(
                s_max, entries.size(), entries.data(), children.data());
            ASSERT_EQ(left, left_entries.size()) << target << ", stack " << i;
            entries.resize(left);
            children.resize(left);
            ASSERT_EQ(entries, left_entries) << target << ", stack " << i;
            ASSERT_EQ(children, left_children) << target << ", stack " << i;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
#endif
