#pragma once
/// Points of the first two dimensions of Sobol's sequence, each dimension scrambled by a tree of
/// its own (nested_scramble.h): in lanes of 64 bits where the processor has AVX-512 (eight at a
/// time) or AVX2 (four).
///
/// Conventions: the same bits with and without lanes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Two samples of a pixel, or of neighbours, share no more digits.
inline constexpr int kSobolScrambledDigits = 24;

struct ScrambleTrees {
    std::uint64_t x, y;
};

/// Writes as many points as there are numbers in the sequence.
void scrambled_points(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                      Vec2* out);

/// The same without lanes.
void scrambled_points_one_by_one(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                                 Vec2* out);

using ScrambledPoints = void (*)(const ScrambleTrees&, std::span<const std::uint64_t>, Vec2*);

/// All that run on this processor, the fastest last.
[[nodiscard]] std::vector<ScrambledPoints> variants_of_scrambled_points();

}  // namespace alhazen
