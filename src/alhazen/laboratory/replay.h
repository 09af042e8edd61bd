#pragma once
/// Replays a ray stream on an accelerator: hits, counts and times.
///
/// Conventions: times are processor seconds on one thread, of the queries alone, without shading.
/// An answer is hashed to 64 bits that depend on every bit of its hits (t, u, v, part, ids and the
/// instances on the path); 0 is no answer. Where time does not suffice for all rays, a random
/// sample (fixed seed) is traced, in pieces of at most 64 neighbours.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/laboratory/ray_stream.h"

namespace alhazen {

/// Figures for the rays of one kind.
struct KindFigures {
    std::uint64_t counted = 0;  ///< rays traced with counting
    std::uint64_t hits = 0;     ///< of these, rays with a hit
    TraversalStats tests;       ///< of these
    std::uint64_t timed = 0;    ///< rays traced for timing
    double seconds = 0;         ///< for these

    KindFigures& operator+=(const KindFigures& other);
    /// Mean per counted ray; 0 without rays.
    [[nodiscard]] double each(std::uint64_t count) const;
    [[nodiscard]] double nanoseconds() const;  ///< per timed ray
};

struct ReplayFigures {
    std::array<KindFigures, kRayKindCount> kinds;
    bool all_counted = true, all_timed = true;  ///< else a sample was traced
    std::uint64_t disagreements = 0;            ///< answers that differ from the expected ones
    std::string first_disagreement;             ///< with the ray that reproduces it
    std::array<std::uint64_t, kRayKindCount> recorded{};  ///< rays of the stream

    [[nodiscard]] KindFigures total() const;
    /// Means over the recorded rays: sampled kinds are weighted by their share of the stream.
    [[nodiscard]] double each(std::uint64_t TraversalStats::*count) const;
    [[nodiscard]] double nanoseconds() const;
};

/// One number for each ray of a stream.
using Answers = std::vector<std::uint64_t>;

struct ReplayOptions {
    double seconds = 10;     ///< for the counts, and again for the times
    int repetitions = 3;     ///< of the timing, the fastest counts; 0: no timing
    bool in_batches = true;  ///< as the renderer does; else in pieces of 64 rays
    bool in_order = false;   ///< of the picture; else random, so that any part is a fair sample
    RayMask mask = 0;        ///< visibility mask instead of the kind's; 0: the kind's
};

/// Traces all rays that time allows and compares with `expected`; if `expected` is empty, it is
/// filled instead, without a time limit.
[[nodiscard]] ReplayFigures replay(const RayStream& stream, const Aggregate& asked,
                                   const ReplayOptions& options, Answers& expected);

}  // namespace alhazen
