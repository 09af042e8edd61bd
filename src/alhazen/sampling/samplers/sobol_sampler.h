#pragma once
/// One scrambled Sobol sequence for the whole picture, distributed to the pixels along a shuffled
/// space-filling curve: the samples of neighbouring pixels complement each other, and errors are
/// distributed as blue noise.
///
/// Source: Sobol', 1967; Owen, 1995 (sobol.h, nested_scramble.h); Ahmed and Wonka, "Screen-Space
/// Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels", ACM TOG
/// 39(6), 2020; Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020 (shuffled order,
/// padding of pairs).
/// Differs: the indices of samples are scrambled in base two, not four, so that each first 2^k
/// samples of a pixel are a net; the tables have 64 digits, enough for pictures of 65536 pixels a
/// side. Pixels are shuffled differently in every pair.
/// Conventions: those of Sampler. A pixel has the indices from 2^m z on, where 2^m is the smallest
/// power of two that is not less than the count, and z the position of the pixel on the curve.

#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

class SobolSampler final : public Sampler {
  public:
    SobolSampler(std::uint64_t seed, std::uint32_t count);
    void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                std::span<Vec2> out) const override;
    void points_of(std::span<const SampleRun> runs, std::uint32_t pair,
                   std::span<Vec2> out) const override;

  private:
    class CurveWalk;
    [[nodiscard]] static CurveWalk& walk_of(std::uint64_t key, std::uint32_t pair);
    std::uint64_t key_;
    int sample_bits_;
};

}  // namespace alhazen
