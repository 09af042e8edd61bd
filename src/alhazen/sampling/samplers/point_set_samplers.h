#pragma once
/// Samplers with a minimum distance between samples, from a few stored sets (point_sets.h). Each
/// pixel uses one set, shifted on the torus.
///
/// Conventions: those of Sampler. Sets have at most kMostPoints points; larger counts combine
/// several sets.

#include <array>
#include <vector>

#include "alhazen/sampling/samplers/set_sampler.h"

namespace alhazen {

inline constexpr std::uint32_t kStoredSets = 8;
inline constexpr std::uint32_t kMostPoints = 1024;

/// Poisson discs, in sets of exactly the requested size.
class PoissonDiscSampler final : public SetSampler {
  public:
    PoissonDiscSampler(std::uint64_t seed, std::uint32_t count);

  private:
    [[nodiscard]] Vec2 point(std::uint64_t key, std::uint32_t i) const override;
    std::array<std::vector<Vec2>, kStoredSets> sets_;
};

/// Best candidates: each prefix of a pixel's samples is blue noise. Pairs beyond the number of
/// stored sets reuse them in shuffled order.
class BlueNoiseSampler final : public Sampler {
  public:
    BlueNoiseSampler(std::uint64_t seed, std::uint32_t count);
    void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                std::span<Vec2> out) const override;

  private:
    std::uint64_t key_;
    std::array<std::vector<Vec2>, kStoredSets> sets_;
};

}  // namespace alhazen
