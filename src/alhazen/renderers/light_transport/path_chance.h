#pragma once
/// The random numbers of paths: from the sampler of the round for the first bounces, from a hash
/// for those behind, where stratification no longer shows.
///
/// Source of the shifts between pixels: Roberts, "The Unreasonable Effectiveness of Quasirandom
/// Sequences", 2018 (R2).
/// Conventions: pairs of dimensions: 0 the pixel, 1 the lens, 2 the time; from 3 + 4 b on those of
/// bounce b: direction of the BSDF, place on a light, the two choices (lobe, light), roulette.
/// Wavelengths are of no pair: the heroes of a pixel's samples lie a golden ratio apart, and those
/// of neighbours are shifted by a quarter of R2, for the four of a path are a quarter apart.

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

class PathChance {
  public:
    enum Pair : std::uint32_t { kLens = 1, kTime = 2, kFirstBounce = 3 };
    enum BouncePair : std::uint32_t { kDirection, kLight, kChoices, kLuck, kPairsOfBounce };
    static constexpr int kStratified = 3;  ///< bounces

    explicit PathChance(const RenderJob& job)
        : sampler_(job.round->sampler),
          seed_(mix64(job.round->seed)),
          spectral_(job.spectral),
          shutter_(job.round->shutter),
          hero_(random_at(seed_, kHero, 0, 0)),
          draws_(sampler_, kByHash) {}

    /// `ids`: of the samples from now on, for `draw` and `waves` by their number in the
    /// batch.
    void begin(std::span<const SampleId> ids) {
        ids_ = ids;
        draws_.begin(ids);
        keys_.clear();
    }
    /// `left`: the samples of the batch that ask `draw` from now on.
    void keep(std::span<const std::uint32_t> left) { draws_.keep(left); }
    [[nodiscard]] Vec2 draw(std::uint32_t sample, int bounce, BouncePair pair) {
        const std::uint32_t p = pair_of(bounce, pair);
        return p < kByHash ? draws_.at(sample, p) : by_hash(key_of(sample), p);
    }

    [[nodiscard]] Vec2 draw(const SampleId& id, std::uint32_t pair) const {
        if (pair < kByHash) return sampler_.at(id.pixel, pair, id.number);
        return by_hash(random_key(seed_, id.pixel.id(), id.number), pair);
    }
    [[nodiscard]] Vec2 draw(const SampleId& id, int bounce, BouncePair pair) const {
        return draw(id, pair_of(bounce, pair));
    }
    /// Whether the path stops at a surface that is there by `coverage`, the `met`-th on its way.
    [[nodiscard]] bool stops(const SampleId& id, std::uint32_t met, double coverage) const {
        if (coverage >= 1.0) return true;
        return random_at(seed_, id.pixel.id(), id.number, kCoverage + met) < coverage;
    }
    /// Of a sample of the batch: channels, or wavelengths where the job asks for them.
    [[nodiscard]] Wavelengths waves(std::uint32_t sample) const {
        if (!spectral_) return {};
        constexpr double kGolden = 0.6180339887498949;
        constexpr double kAcross = 0.7548776662466927 / 4, kDown = 0.5698402909980532 / 4;
        const SampleId& id = ids_[sample];
        const double u = hero_ + kAcross * id.pixel.x + kDown * id.pixel.y + kGolden * id.number;
        return Wavelengths::drawn(std::min(u - std::floor(u), 0x1.fffffffffffffp-1));
    }
    [[nodiscard]] bool is_spectral() const { return spectral_; }
    /// Where a path scatters inside a volume, by the number of its stretch.
    [[nodiscard]] Vec2 in_volume(const SampleId& id, std::uint32_t stretch) const {
        const std::uint64_t place = kVolume + 2 * std::uint64_t{stretch};
        return {random_at(seed_, id.pixel.id(), id.number, place),
                random_at(seed_, id.pixel.id(), id.number, place + 1)};
    }
    /// Numbers of what draws many: the `number`-th of a place (a bounce, say) of the sample.
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
    static constexpr std::uint64_t kHero = 0x68657230;  ///< of nothing else that is drawn

    [[nodiscard]] static std::uint32_t pair_of(int bounce, BouncePair pair) {
        return kFirstBounce + static_cast<std::uint32_t>(bounce) * kPairsOfBounce + pair;
    }

    [[nodiscard]] static Vec2 by_hash(std::uint64_t key, std::uint32_t pair) {
        return {random_at(key, 2 * std::uint64_t{pair}),
                random_at(key, 2 * std::uint64_t{pair} + 1)};
    }
    /// Of a sample of the batch.
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
    double hero_;  ///< that of sample 0 of pixel (0, 0)
    SampleDraws draws_;
    std::span<const SampleId> ids_;
    std::vector<std::uint64_t> keys_;  ///< [sample of the batch] of its hashes; empty: none asked
};

}  // namespace alhazen
