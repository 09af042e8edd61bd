#pragma once
/// Samplers that draw sets of a fixed size.
///
/// Conventions: those of Sampler. The order of a set's points is shuffled in every pair but the
/// first, so that pairs are independent.

#include "alhazen/sampling/permutation.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

/// Two uniform numbers for sample `i` of the set that `key` selects.
[[nodiscard]] inline Vec2 uniform_pair(std::uint64_t key, std::uint32_t i) {
    const std::uint64_t h = mix64(key ^ (i + 1));
    return {unit_double(h), unit_double(mix64(h))};
}

class SetSampler : public Sampler {
  public:
    SetSampler(std::uint64_t seed, std::uint32_t count) : key_(mix64(seed)), count_(count) {}

    void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                std::span<Vec2> out) const final {
        for (std::uint32_t k = 0; k < out.size(); ++k) {
            const std::uint32_t s = first + k;
            const std::uint64_t key = key_of(pixel, pair, s / count_);
            const std::uint32_t i = s % count_;
            out[k] = point(key, pair == 0 ? i : permuted(i, count_, mix64(key)));
        }
    }

  protected:
    /// Point `i` of the set that `key` selects.
    [[nodiscard]] virtual Vec2 point(std::uint64_t key, std::uint32_t i) const = 0;
    [[nodiscard]] std::uint32_t count() const { return count_; }

  private:
    [[nodiscard]] std::uint64_t key_of(const SamplePixel& pixel, std::uint32_t pair,
                                       std::uint32_t set) const {
        return mix64(mix64(key_ ^ pixel.id()) ^ (std::uint64_t{set} << 32 | pair));
    }

    std::uint64_t key_;
    std::uint32_t count_;
};

}  // namespace alhazen
