#include "alhazen/sampling/samplers/sobol_sampler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>

#include "alhazen/sampling/random.h"
#include "alhazen/sampling/samplers/sobol_points.h"

namespace alhazen {

namespace {

/// All 24 permutations of the four quadrants, two bits for each quadrant.
constexpr std::array<std::uint8_t, 24> kOrders = [] {
    std::array<std::uint8_t, 24> orders{};
    std::size_t n = 0;
    for (unsigned a = 0; a < 4; ++a) {
        for (unsigned b = 0; b < 4; ++b) {
            for (unsigned c = 0; c < 4; ++c) {
                if (a == b || a == c || b == c) continue;
                const unsigned d = 6 - a - b - c;
                orders[n++] = static_cast<std::uint8_t>(a | b << 2 | c << 4 | d << 6);
            }
        }
    }
    return orders;
}();

/// Indices of samples, each bit flipped by a hash of the bits above it: each first 2^k indices stay
/// an aligned block. For successive indices only the flips of changed bits are hashed again.
class ShuffledNumbers {
  public:
    ShuffledNumbers(std::uint32_t first, int bits, std::uint64_t key) : key_(key), next_(first) {
        for (int bit = 0; bit < bits; ++bit) flips_ |= flip_of_sample(first, bit, key);
        bits_ = bits;
    }
    [[nodiscard]] std::uint32_t next() {
        const std::uint32_t shuffled = next_ ^ flips_;
        ++next_;
        // The bits below the lowest bit that became 1.
        for (int bit = std::min(std::countr_zero(next_), bits_) - 1; bit >= 0; --bit) {
            flips_ = (flips_ & ~(1u << bit)) | flip_of_sample(next_, bit, key_);
        }
        return shuffled;
    }

  private:
    std::uint64_t key_;
    std::uint32_t next_, flips_ = 0;
    int bits_ = 0;
};

}  // namespace

SobolSampler::SobolSampler(std::uint64_t seed, std::uint32_t count)
    : key_(mix64(seed)), sample_bits_(std::bit_width(count - 1)) {}

/// Positions of pixels on the curve: for a pixel near the previous one, computes only the digits
/// that differ.
class SobolSampler::CurveWalk {
  public:
    explicit CurveWalk(std::uint64_t key = 0) : key_(key) {}
    [[nodiscard]] std::uint64_t key() const { return key_; }

    [[nodiscard]] std::uint32_t place(const SamplePixel& pixel) {
        const auto x = static_cast<std::uint32_t>(pixel.x), y = static_cast<std::uint32_t>(pixel.y);
        const int known = std::bit_width((x ^ x_) | (y ^ y_));
        const int from = began_ ? std::min(known, kBits) : kBits;
        place_ >>= 2 * from;
        above_ >>= 2 * from;
        for (int bit = from - 1; bit >= 0; --bit) {
            const unsigned quadrant = ((x >> bit) & 1u) | ((y >> bit) & 1u) << 1;
            const std::uint64_t order = (mix64(key_ ^ above_) >> 32) % kOrders.size();
            place_ = place_ << 2 | ((unsigned{kOrders[order]} >> (2 * quadrant)) & 3u);
            above_ = above_ << 2 | quadrant;
        }
        x_ = x;
        y_ = y;
        began_ = true;
        return static_cast<std::uint32_t>(place_);
    }

  private:
    static constexpr int kBits = 16;

    std::uint64_t key_;
    std::uint64_t place_ = 0;
    /// The quadrants of the previous pixel, behind a 1 that encodes their number.
    std::uint64_t above_ = std::uint64_t{1} << (2 * kBits);
    std::uint32_t x_ = 0, y_ = 0;
    bool began_ = false;
};

/// This thread's walk of a pair: renderers ask for the points of a pair pixel by pixel, and most
/// pixels are near the previous one.
SobolSampler::CurveWalk& SobolSampler::walk_of(std::uint64_t key, std::uint32_t pair) {
    constexpr std::size_t kWalks = 256;
    // Made at first use: the loader would clear it for every thread.
    thread_local const auto walks = std::make_unique<std::array<CurveWalk, kWalks>>();
    CurveWalk& walk = (*walks)[pair % kWalks];
    if (walk.key() != key) walk = CurveWalk(key);
    return walk;
}

void SobolSampler::points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                          std::span<Vec2> out) const {
    const SampleRun run{pixel, first, static_cast<std::uint32_t>(out.size())};
    points_of({&run, 1}, pair, out);
}

void SobolSampler::points_of(std::span<const SampleRun> runs, std::uint32_t pair,
                             std::span<Vec2> out) const {
    const std::uint64_t key = mix64(key_ ^ pair);
    const ScrambleTrees trees{mix64(key + 1), mix64(key + 2)};
    CurveWalk& walk = walk_of(key, pair);
    const int bits = pair > 0 ? sample_bits_ : 0;
    const auto key_of = [&](const SampleRun& run) { return mix64(key ^ mix64(run.pixel.id())); };
    const auto first_of = [&](const SampleRun& run) {
        return std::uint64_t{walk.place(run.pixel)} << sample_bits_;
    };
    std::array<std::uint64_t, PixelSamples::kMost> indices;  // in the sequence
    std::size_t waiting = 0;
    Vec2* next = out.data();
    const auto write = [&] {
        scrambled_points(trees, std::span(indices).first(waiting), next);
        next += waiting;
        waiting = 0;
    };
    constexpr std::size_t kFewest = 4;  // in lanes
    const ShuffledIndices shuffle = shuffled_indices_in_lanes();
    if (shuffle != nullptr && out.size() >= kFewest) {
        PixelSamples samples;
        const auto shuffle_all = [&] {
            // The rest of the last lanes.
            for (std::size_t i = waiting; i % 8 != 0; ++i) {
                samples.first[i] = samples.key[i] = samples.number[i] = 0;
            }
            shuffle(samples, waiting, bits, indices.data());
            write();
        };
        for (const SampleRun& run : runs) {
            const std::uint64_t first = first_of(run), pixel_key = key_of(run);
            for (std::uint32_t k = 0; k < run.count; ++k) {
                samples.first[waiting] = first;
                samples.key[waiting] = pixel_key;
                samples.number[waiting] = run.first + k;
                if (++waiting == PixelSamples::kMost) shuffle_all();
            }
        }
        return shuffle_all();
    }
    for (const SampleRun& run : runs) {
        const std::uint64_t first = first_of(run);
        ShuffledNumbers shuffled(run.first, bits, key_of(run));
        for (std::uint32_t k = 0; k < run.count; ++k) {
            indices[waiting++] = first | shuffled.next();
            if (waiting == indices.size()) write();
        }
    }
    write();
}

}  // namespace alhazen
