#pragma once
/// Points of the first two dimensions of Sobol's sequence, each dimension scrambled by its own tree
/// (nested_scramble.h), and shuffled numbers of samples, computed in lanes of 64 bits: eight at a
/// time with AVX-512, points four at a time with AVX2.
///
/// Conventions: the bits are the same with and without lanes.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/sampling/random.h"

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

/// The flip of a bit of the number of a sample in its pixel, by a hash of the bits above it.
[[nodiscard]] constexpr std::uint32_t flip_of_sample(std::uint32_t sample, int bit,
                                                     std::uint64_t key) {
    const std::uint64_t above = std::uint64_t{sample >> bit >> 1} | std::uint64_t(bit + 1) << 32;
    return static_cast<std::uint32_t>(mix64(key ^ above) >> 63) << bit;
}

/// Samples of several pixels.
struct PixelSamples {
    static constexpr std::size_t kMost = 128;
    std::array<std::uint64_t, kMost> first;   ///< index in the sequence of sample 0 of the pixel
    std::array<std::uint64_t, kMost> key;     ///< of the shuffle of the pixel
    std::array<std::uint64_t, kMost> number;  ///< of the sample in its pixel
};

/// Writes the indices in the sequence of the first `count` samples: `first` plus the number with
/// its lowest `bits` flipped by `flip_of_sample`. Reads and writes whole lanes: eight samples.
using ShuffledIndices = void (*)(const PixelSamples& samples, std::size_t count, int bits,
                                 std::uint64_t* out);

/// The function in lanes; null where it is not faster than flips for one sample after the other.
[[nodiscard]] ShuffledIndices shuffled_indices_in_lanes();

}  // namespace alhazen
