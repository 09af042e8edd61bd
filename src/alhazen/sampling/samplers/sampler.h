#pragma once
/// Samplers by name: where in a pixel, on a lens, in time the samples of a picture lie.
///
/// A sampler gives pairs of values: pair 0 is the place in the pixel, the others are for whatever
/// else a sample draws. docs/design/sampling.md.
/// Conventions: values in [0, 1). A value depends on (seed, pixel, sample, dimension) and the size
/// of a set alone, so on no thread and no order. Samples 0 .. count - 1 are the first set. Those of
/// a progressive sampler go on: each beginning of its samples is as good a set as can be. Of the
/// others each set of `count` samples is drawn anew. Threads: all functions may be called from
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

    int x = 0, y = 0;  ///< 0 .. kMaxSide - 1

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
    /// Writes dimensions 2 pair and 2 pair + 1 of the samples from `first` on.
    /// Precondition: first + out.size() is at most 2^20, and the count where the sampler is
    /// progressive.
    virtual void points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                        std::span<Vec2> out) const = 0;
    /// The same of many pixels, one run behind the other. Fastest where successive runs are of
    /// neighbouring pixels.
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

/// A sampler by name, and what it does in one line.
struct SamplerEntry {
    const char* name;
    const char* description;
    bool progressive;
    /// Exponent of N with which the standard error of N samples falls at an edge, in theory.
    double error_exponent;
    /// `count`: samples of a set, or of a pixel at most where it is progressive; 1 .. 2^20.
    std::unique_ptr<Sampler> (*make)(std::uint64_t seed, std::uint32_t count);
};

inline constexpr std::uint32_t kMaxSamples = 1u << 20;

/// The table of samplers. ADD A SAMPLER HERE (sampler_list.cpp: one line).
[[nodiscard]] std::span<const SamplerEntry> samplers();
/// Null for an unknown name.
[[nodiscard]] const SamplerEntry* find_sampler(const std::string& name);

}  // namespace alhazen
