#pragma once
/// Points of the first two dimensions of Sobol's sequence, each dimension scrambled by its own tree
/// (nested_scramble.h), computed in lanes of 64 bits: eight at a time with AVX-512, four with AVX2.
///
/// Conventions: the bits are the same with and without lanes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The largest number of digits that two samples of a pixel, or of neighbouring pixels, share.
inline constexpr int kSobolScrambledDigits = 24;

struct ScrambleTrees {
    std::uint64_t x, y;
};

/// Writes one point for each of `numbers`, indices in the sequence.
void scrambled_points(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                      Vec2* out);

/// Writes the same points without lanes.
void scrambled_points_one_by_one(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                                 Vec2* out);

using ScrambledPoints = void (*)(const ScrambleTrees&, std::span<const std::uint64_t>, Vec2*);

/// All variants that this processor can run, the fastest last.
[[nodiscard]] std::vector<ScrambledPoints> variants_of_scrambled_points();

}  // namespace alhazen
