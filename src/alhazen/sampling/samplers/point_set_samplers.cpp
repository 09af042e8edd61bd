#include "alhazen/sampling/samplers/point_set_samplers.h"

#include <algorithm>
#include <bit>

#include "alhazen/sampling/samplers/point_sets.h"

namespace alhazen {

namespace {

/// `p` moved by `by` on the torus.
Vec2 torus_shifted(const Vec2& p, const Vec2& by) {
    const auto once_around = [](double x) { return x < 1.0 ? x : x - 1.0; };
    return {once_around(p.x + by.x), once_around(p.y + by.y)};
}

}  // namespace

PoissonDiscSampler::PoissonDiscSampler(std::uint64_t seed, std::uint32_t count)
    : SetSampler(seed, std::min(count, kMostPoints)) {
    for (std::uint32_t k = 0; k < kStoredSets; ++k) {
        sets_[k] = poisson_disc_set(mix64(mix64(seed) + k), std::min(count, kMostPoints)).points;
    }
}

Vec2 PoissonDiscSampler::point(std::uint64_t key, std::uint32_t i) const {
    return torus_shifted(sets_[key % kStoredSets][i], uniform_pair(key, 0));
}

BlueNoiseSampler::BlueNoiseSampler(std::uint64_t seed, std::uint32_t count) : key_(mix64(seed)) {
    const std::uint32_t points = std::min(std::bit_ceil(count), kMostPoints);
    for (std::uint32_t k = 0; k < kStoredSets; ++k) {
        sets_[k] = best_candidate_set(mix64(key_ + k), points);
    }
}

void BlueNoiseSampler::points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                              std::span<Vec2> out) const {
    const auto size = static_cast<std::uint32_t>(sets_[0].size());
    const std::uint64_t of_pixel = mix64(key_ ^ pixel.id());
    for (std::uint32_t k = 0; k < out.size(); ++k) {
        const std::uint32_t s = first + k, turn = s / size;
        const std::uint64_t key = mix64(of_pixel ^ (std::uint64_t{turn} << 32 | pair));
        std::uint32_t i = s % size;
        if (pair >= kStoredSets) i = permuted(i, size, key);
        // The pairs of a pixel use different sets, so that their orders are independent.
        out[k] = torus_shifted(sets_[(mix64(of_pixel ^ turn) + pair) % kStoredSets][i],
                               uniform_pair(key, 0));
    }
}

}  // namespace alhazen
