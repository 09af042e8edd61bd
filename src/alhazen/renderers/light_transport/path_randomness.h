#pragma once
/// The random numbers of paths: from the sampler of the round for the first bounces, from a hash
/// for further ones, where stratification has no visible effect.
///
/// Source of the shifts between pixels: Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018 (R2).
/// Conventions: pairs of dimensions: 0 the pixel, 1 the lens, 2 the time; from 3 + 4 b on those of
/// bounce b: direction of the BSDF, place on a light, the two choices (lobe, light), roulette.
/// Wavelengths use no pair: the hero wavelengths of a pixel's samples are a golden ratio apart, and
/// those of neighbouring pixels are shifted by a quarter of R2, since the four of a path are a
/// quarter apart.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/renderers/core/estimator.h"
#include "alhazen/renderers/core/sample_draws.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

class PathRandomness {
  public:
    enum Pair : std::uint32_t { kLens = 1, kTime = 2, kFirstBounce = 3 };
    enum BouncePair : std::uint32_t { kDirection, kLight, kChoices, kRoulette, kPairsOfBounce };
    static constexpr int kStratified = 3;  ///< bounces

    explicit PathRandomness(const RenderJob& job)
        : sampler_(job.round->sampler),
          seed_(mix64(job.round->seed)),
          spectral_(job.spectral),
          shutter_(job.round->shutter),
          hero_(random_at(seed_, kHero, 0, 0)),
          draws_(sampler_, kByHash) {}

    /// Begins a batch for `draw` and `waves` by the number in the batch. `ids` must stay valid.
    void begin(std::span<const SampleId> ids) {
        ids_ = ids;
        draws_.begin(ids);
        keys_.clear();
    }
    /// Limits further draws to the samples `left` of the batch.
    void keep(std::span<const std::uint32_t> left) { draws_.keep(left); }
    [[nodiscard]] Vec2 draw(std::uint32_t sample, int bounce, BouncePair pair) {
        const std::uint32_t p = pair_of(bounce, pair);
        return p < kByHash ? draws_.at(sample, p) : by_hash(key_of(sample), p);
    }

    /// The first number of `draw`.
    [[nodiscard]] double draw_first(std::uint32_t sample, int bounce, BouncePair pair) {
        const std::uint32_t p = pair_of(bounce, pair);
        return p < kByHash ? draws_.at(sample, p).x
                           : random_at(key_of(sample), 2 * std::uint64_t{p});
    }

    /// The numbers of a pair, [sample of the batch]; null if they are not drawn together. Valid
    /// until `begin`.
    [[nodiscard]] const Vec2* drawn(int bounce, BouncePair pair) {
        const std::uint32_t p = pair_of(bounce, pair);
        return p < kByHash ? draws_.all(p) : nullptr;
    }

    [[nodiscard]] Vec2 draw(const SampleId& id, std::uint32_t pair) const {
        if (pair < kByHash) return sampler_.at(id.pixel, pair, id.number);
        return by_hash(random_key(seed_, id.pixel.id(), id.number), pair);
    }
    [[nodiscard]] Vec2 draw(const SampleId& id, int bounce, BouncePair pair) const {
        return draw(id, pair_of(bounce, pair));
    }
    /// True if the path stops at a surface of that coverage, the `met`-th along the path.
    [[nodiscard]] bool stops(const SampleId& id, std::uint32_t met, double coverage) const {
        if (coverage >= 1.0) return true;
        return random_at(seed_, id.pixel.id(), id.number, kCoverage + met) < coverage;
    }
    /// The wavelengths of a sample of the batch; channels unless the job is spectral.
    [[nodiscard]] Wavelengths waves(std::uint32_t sample) const {
        if (!spectral_) return {};
        constexpr double kGolden = 0.6180339887498949;
        constexpr double kAcross = 0.7548776662466927 / 4, kDown = 0.5698402909980532 / 4;
        const SampleId& id = ids_[sample];
        const double u = hero_ + kAcross * id.pixel.x + kDown * id.pixel.y + kGolden * id.number;
        return Wavelengths::drawn(std::min(u - std::floor(u), 0x1.fffffffffffffp-1));
    }
    [[nodiscard]] bool is_spectral() const { return spectral_; }
    /// Numbers for the scattering in a volume, by the number of the ray segment through volumes.
    [[nodiscard]] Vec2 in_volume(const SampleId& id, std::uint32_t stretch) const {
        const std::uint64_t place = kVolume + 2 * std::uint64_t{stretch};
        return {random_at(seed_, id.pixel.id(), id.number, place),
                random_at(seed_, id.pixel.id(), id.number, place + 1)};
    }
    /// Further numbers: the `number`-th of a place (such as a bounce) of the sample.
    [[nodiscard]] double extra(const SampleId& id, std::uint32_t place,
                               std::uint32_t number) const {
        return random_at(seed_, id.pixel.id(), id.number,
                         kExtra | std::uint64_t{place} << 32 | number);
    }
    [[nodiscard]] float time(const SampleId& id) const { return shutter_.at(draw(id, kTime).x); }

  private:
    static constexpr std::uint32_t kByHash = kFirstBounce + kStratified * kPairsOfBounce;
    static constexpr std::uint64_t kCoverage = std::uint64_t{1} << 32;
    static constexpr std::uint64_t kVolume = std::uint64_t{1} << 34;
    static constexpr std::uint64_t kExtra = std::uint64_t{1} << 62;
    static constexpr std::uint64_t kHero = 0x68657230;  ///< unused by other draws

    [[nodiscard]] static std::uint32_t pair_of(int bounce, BouncePair pair) {
        return kFirstBounce + static_cast<std::uint32_t>(bounce) * kPairsOfBounce + pair;
    }

    [[nodiscard]] static Vec2 by_hash(std::uint64_t key, std::uint32_t pair) {
        return {random_at(key, 2 * std::uint64_t{pair}),
                random_at(key, 2 * std::uint64_t{pair} + 1)};
    }
    /// The hash key of a sample of the batch.
    [[nodiscard]] std::uint64_t key_of(std::uint32_t sample) {
        if (keys_.empty()) {
            for (const SampleId& id : ids_) {
                keys_.push_back(random_key(seed_, id.pixel.id(), id.number));
            }
        }
        return keys_[sample];
    }

    const Sampler& sampler_;
    std::uint64_t seed_;
    bool spectral_;
    ShutterPart shutter_;
    double hero_;  ///< of sample 0 of pixel (0, 0)
    SampleDraws draws_;
    std::span<const SampleId> ids_;
    std::vector<std::uint64_t> keys_;  ///< [sample of the batch] of its hashes; empty: not yet set
};

}  // namespace alhazen
