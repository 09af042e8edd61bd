#include "alhazen/accel/wide_bvh/build/collapse_choice.h"

#include <algorithm>
#include <limits>

#include "alhazen/simd/dispatch.h"
#include "alhazen/simd/registers.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/accel/wide_bvh/build/collapse_choice.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// The choice between a leaf and a wide node of the least cost.
HWY_INLINE ChoiceOf<8> choice_of(float as_leaf, float inner, int inner_left) {
    ChoiceOf<8> choice;
    choice.as_leaf = as_leaf <= inner && as_leaf < kNever;
    choice.inner_left = static_cast<std::uint8_t>(inner_left);
    return choice;
}

// Lane j stands for at most j + 1 subtrees of both children. Their costs do not increase with j, as
// those of the children do not: the least one so far is that of the lane before, or of one subtree.
// Numbers of the left child are offered in ascending order, so the last one is the greatest.

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));

constexpr Float8 kNone{kNever, kNever, kNever, kNever, kNever, kNever, kNever, kNever};

struct Spread {
    Float8 cost = kNone;
    Int8 left{1, 1, 1, 1, 1, 1, 1, 1};

    HWY_INLINE void offer(float left_cost, Float8 right_cost, int left_count) {
        const Float8 sum = (Float8{} + left_cost) + right_cost;
        const Int8 better = sum < cost;
        left = (Int8)_mm256_max_epi16((__m256i)left, (__m256i)(better & left_count));
        cost = _mm256_min_ps(sum, cost);
    }
};

ChoiceOf<8> choose_eight_of_target(const float* l, const float* right, float area, float as_leaf,
                                   float* costs) {
    Float8 r;
    std::memcpy(&r, right, sizeof(r));
    Spread spread;
    spread.offer(l[0], __builtin_shufflevector(kNone, r, 0, 8, 9, 10, 11, 12, 13, 14), 1);
    spread.offer(l[1], __builtin_shufflevector(kNone, r, 0, 1, 8, 9, 10, 11, 12, 13), 2);
    spread.offer(l[2], __builtin_shufflevector(kNone, r, 0, 1, 2, 8, 9, 10, 11, 12), 3);
    spread.offer(l[3], __builtin_shufflevector(kNone, r, 0, 1, 2, 3, 8, 9, 10, 11), 4);
    spread.offer(l[4], __builtin_shufflevector(kNone, r, 0, 1, 2, 3, 4, 8, 9, 10), 5);
    spread.offer(l[5], __builtin_shufflevector(kNone, r, 0, 1, 2, 3, 4, 5, 8, 9), 6);
    spread.offer(l[6], __builtin_shufflevector(kNone, r, 0, 1, 2, 3, 4, 5, 6, 8), 7);
    const float inner = area + spread.cost[7];
    ChoiceOf<8> choice = choice_of(as_leaf, inner, spread.left[7]);
    const Float8 one = Float8{} + std::min(as_leaf, inner);
    const Float8 before =
        __builtin_shufflevector(kNone, spread.cost, 0, 8, 9, 10, 11, 12, 13, 14);
    const Int8 chosen = spread.left & (spread.cost < one) & (spread.cost < before);
    const Float8 least = _mm256_min_ps(spread.cost, one);
    std::memcpy(costs, &least, sizeof(least));
    const __m128i words = _mm_packs_epi32(_mm256_castsi256_si128((__m256i)chosen),
                                          _mm256_extracti128_si256((__m256i)chosen, 1));
    const __m128i bytes = _mm_packus_epi16(words, words);
    std::memcpy(choice.lefts.data(), &bytes, 8);
    return choice;
}

#else


struct Spread {
    Float4 cost{kNever, kNever, kNever, kNever};
    Int4 left{1, 1, 1, 1}, chosen;

    HWY_INLINE void offer(float left_cost, Float4 right_cost, int left_count) {
        const Float4 sum = left_cost + right_cost;
        const Int4 better = sum < cost;
#ifdef __SSE2__
        left = (Int4)_mm_max_epi16((__m128i)left, (__m128i)(better & left_count));
#else
        left = (better & left_count) | (~better & left);
#endif
        cost = lesser(sum, cost);
    }
    /// Stores the least costs; `chosen` is the left number where it is better than those `before`,
    /// of one subtree less, and than one subtree, else 0.
    HWY_INLINE void choose(Float4 before, Float4 one, float* costs) {
        chosen = left & (cost < one) & (cost < before);
        const Float4 least = lesser(cost, one);
        std::memcpy(costs, &least, sizeof(least));
    }
};

ChoiceOf<8> choose_eight_of_target(const float* l, const float* right, float area, float as_leaf,
                                   float* costs) {
    const Float4 none{kNever, kNever, kNever, kNever};
    Float4 r0, r1;
    std::memcpy(&r0, right, sizeof(r0));
    std::memcpy(&r1, right + 4, sizeof(r1));
    // The right child's costs for 1 to 3 subtrees less than lanes 0 to 3 have.
    const Float4 less1 = __builtin_shufflevector(none, r0, 0, 4, 5, 6);
    const Float4 less2 = __builtin_shufflevector(none, r0, 0, 1, 4, 5);
    const Float4 less3 = __builtin_shufflevector(none, r0, 0, 1, 2, 4);
    Spread low, high;
    low.offer(l[0], less1, 1);
    low.offer(l[1], less2, 2);
    low.offer(l[2], less3, 3);
    high.offer(l[0], __builtin_shufflevector(r0, r1, 3, 4, 5, 6), 1);
    high.offer(l[1], __builtin_shufflevector(r0, r1, 2, 3, 4, 5), 2);
    high.offer(l[2], __builtin_shufflevector(r0, r1, 1, 2, 3, 4), 3);
    high.offer(l[3], r0, 4);
    high.offer(l[4], less1, 5);
    high.offer(l[5], less2, 6);
    high.offer(l[6], less3, 7);
    const float inner = area + high.cost[3];
    ChoiceOf<8> choice = choice_of(as_leaf, inner, high.left[3]);
    const float one = std::min(as_leaf, inner);
    const Float4 ones{one, one, one, one};
    low.choose(__builtin_shufflevector(none, low.cost, 0, 4, 5, 6), ones, costs);
    high.choose(__builtin_shufflevector(low.cost, high.cost, 3, 4, 5, 6), ones, costs + 4);
#ifdef __SSE2__
    const __m128i words = _mm_packs_epi32((__m128i)low.chosen, (__m128i)high.chosen);
    const __m128i bytes = _mm_packus_epi16(words, words);
    std::memcpy(choice.lefts.data(), &bytes, 8);
#else
    for (int i = 0; i < 4; ++i) {
        choice.lefts[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(low.chosen[i]);
        choice.lefts[static_cast<std::size_t>(i) + 4] = static_cast<std::uint8_t>(high.chosen[i]);
    }
#endif
    return choice;
}

#endif

}  // namespace

ChooseEight chosen_choose_eight() {
    return &choose_eight_of_target;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(chosen_choose_eight);

ChooseEight choose_eight() {
    return ALHAZEN_KERNEL(chosen_choose_eight)();
}

}  // namespace alhazen
#endif
