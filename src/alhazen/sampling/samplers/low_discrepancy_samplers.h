#pragma once
/// Low-discrepancy samplers by radical inverses.
///
/// Source: Hammersley, "Monte Carlo Methods for Solving Multivariable Problems", 1960; Halton, "On
/// the Efficiency of Certain Quasi-Random Sequences of Points ...", Numerische Mathematik 2, 1960;
/// Cranley and Patterson, "Randomization of Number Theoretic Methods ...", SIAM J. Numer. Anal.
/// 13(6), 1976 (shifts); Owen, 1995 (nested scrambling); Matousek, "On the L2-Discrepancy for
/// Anchored Boxes", J. Complexity 14, 1998 (affine permutations of the digits suffice).
/// Differs: `halton` permutes each digit by a random affine map that depends on the digits above
/// it, which has the variance of Owen's scrambling; the digits beyond those of the largest index
/// are random.
/// it, which has the variance of Owen's scrambling; the digits beyond the largest index are drawn.

#include "alhazen/sampling/samplers/set_sampler.h"

namespace alhazen {

/// The points (i / count, radical inverse of i in base 2), shifted on the torus for each pixel and
/// pair.
class HammersleySampler final : public SetSampler {
  public:
    using SetSampler::SetSampler;

  private:
    [[nodiscard]] Vec2 point(std::uint64_t key, std::uint32_t i) const override;
};

/// Radical inverses in the prime bases, two for each pair, scrambled for each pixel. Pairs from
/// kPairs on are independent random numbers.
class HaltonSampler final : public Sampler {
  public:
    static constexpr std::uint32_t kPairs = 16;

    HaltonSampler(std::uint64_t seed, std::uint32_t count) : seed_(seed), count_(count) {}
    void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                std::span<Vec2> out) const override;

  private:
    std::uint64_t seed_;
    std::uint32_t count_;
};

/// Independent random numbers.
class IndependentSampler final : public Sampler {
  public:
    IndependentSampler(std::uint64_t seed, std::uint32_t /*count*/) : seed_(seed) {}
    void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                std::span<Vec2> out) const override;

  private:
    std::uint64_t seed_;
};

}  // namespace alhazen
