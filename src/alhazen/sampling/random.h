#pragma once
/// Random numbers that depend only on (seed, pixel, sample, dimension): the same for every thread,
/// tile and machine.
///
/// Source: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014
/// (the mixing function of SplitMix64).
/// Differs: used as a hash of the coordinates, not as a sequence.

#include <cstdint>

namespace alhazen {

/// A bijection of 64-bit words in which every input bit affects all output bits.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// Uniform in [0, 1), a multiple of 2^-53.
constexpr double unit_double(std::uint64_t bits) {
    return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// The hash of the coordinates that all numbers of a sample share.
constexpr std::uint64_t random_key(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample) {
    return mix64(mix64(mix64(seed) ^ pixel) ^ sample);
}
constexpr double random_at(std::uint64_t key, std::uint64_t dimension) {
    return unit_double(mix64(key ^ dimension));
}
/// Uniform in [0, 1), from all coordinates of a number.
constexpr double random_at(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample,
                           std::uint64_t dimension) {
    return random_at(random_key(seed, pixel, sample), dimension);
}

/// A sequence of random numbers for tests and checks.
class RandomStream {
  public:
    explicit RandomStream(std::uint64_t seed) : key_(mix64(seed)) {}
    [[nodiscard]] std::uint64_t bits() { return mix64(key_ ^ mix64(counter_++)); }
    /// Uniform in [0, 1).
    [[nodiscard]] double uniform() { return unit_double(bits()); }
    /// Uniform in [lo, hi).
    [[nodiscard]] double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
    /// Uniform in {0, ..., n - 1}; n > 0.
    [[nodiscard]] std::uint64_t below(std::uint64_t n) { return bits() % n; }

  private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

}  // namespace alhazen
