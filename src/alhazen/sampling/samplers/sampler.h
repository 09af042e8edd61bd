#pragma once
/// Samplers by name: the positions of samples in a pixel, on a lens, in time.
///
/// A sampler gives pairs of values: pair 0 is the position in the pixel, the others are for all
/// else that a sample draws. docs/design/sampling.md.
/// Conventions: values lie in [0, 1). A value depends only on (seed, pixel, sample, dimension) and
/// the size of a set, never on threads or order. Samples 0 .. count - 1 are the first set. A
/// progressive sampler continues it: each prefix of its samples is as well distributed as possible.
/// Other samplers draw each further set of `count` samples anew. Threads: all functions may be
/// called from several threads.
/// many.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "alhazen/math/vec.h"

namespace alhazen {

struct SamplePixel {
    static constexpr int kMaxSide = 1 << 16;

    int x = 0, y = 0;  ///< in 0 .. kMaxSide - 1

    [[nodiscard]] std::uint64_t id() const {
        return std::uint64_t(static_cast<std::uint32_t>(y)) << 32 | static_cast<std::uint32_t>(x);
    }
};

/// Successive samples of a pixel.
struct SampleRun {
    SamplePixel pixel;
    std::uint32_t first = 0, count = 0;
};

class Sampler {
  public:
    virtual ~Sampler() = default;
    /// Writes dimensions 2 pair and 2 pair + 1 of samples first .. first + out.size() - 1.
    /// Precondition: first + out.size() is at most 2^20 and, if the sampler is progressive, at most
    /// the count.
    virtual void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                        std::span<Vec2> out) const = 0;
    /// Writes the samples of several runs, one run after the other. Fastest if successive runs are
    /// of neighbouring pixels.
    virtual void points_of(std::span<const SampleRun> runs, std::uint32_t pair,
                           std::span<Vec2> out) const {
        for (std::size_t done = 0; const SampleRun& run : runs) {
            points(run.pixel, pair, run.first, out.subspan(done, run.count));
            done += run.count;
        }
    }

    [[nodiscard]] Vec2 at(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t s) const {
        Vec2 p;
        points(pixel, pair, s, {&p, 1});
        return p;
    }
};

/// A sampler's name, a description in one line and its properties.
struct SamplerEntry {
    const char* name;
    const char* description;
    bool progressive;
    /// Theoretical exponent of N in the standard error of N samples at an edge.
    double error_exponent;
    /// `count`: the number of samples of a set or, if the sampler is progressive, the largest
    /// number in a pixel; in 1 .. 2^20.
    std::unique_ptr<Sampler> (*make)(std::uint64_t seed, std::uint32_t count);
};

inline constexpr std::uint32_t kMaxSamples = 1u << 20;

/// The table of samplers. ADD A SAMPLER HERE (sampler_list.cpp: one line).
[[nodiscard]] std::span<const SamplerEntry> samplers();
/// The entry of a name; null for an unknown name.
[[nodiscard]] const SamplerEntry* find_sampler(const std::string& name);

}  // namespace alhazen
