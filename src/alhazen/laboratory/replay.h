#pragma once
/// Replays a ray stream on an accelerator to measure hits, counts and times.
///
/// Conventions: times are processor seconds on one thread, of the queries alone, without shading. A
/// result is hashed to 64 bits that depend on every bit of its hits (t, u, v, part, ids and the
/// instances on the path); 0 is no result. If the time limit is too short for all rays, a random
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
    std::uint64_t hits = 0;     ///< of the counted rays, those with a hit
    TraversalStats tests;       ///< of the counted rays
    std::uint64_t timed = 0;    ///< rays traced for timing
    double seconds = 0;         ///< of the timed rays

    KindFigures& operator+=(const KindFigures& other);
    /// Mean per counted ray; 0 without rays.
    [[nodiscard]] double each(std::uint64_t count) const;
    [[nodiscard]] double nanoseconds() const;  ///< per timed ray
};

struct ReplayFigures {
    std::array<KindFigures, kRayKindCount> kinds;
    bool all_counted = true, all_timed = true;  ///< false: a sample was traced
    std::uint64_t disagreements = 0;            ///< results that differ from the expected ones
    std::string first_disagreement;             ///< with the ray that reproduces it
    std::array<std::uint64_t, kRayKindCount> recorded{};  ///< rays of the stream

    [[nodiscard]] KindFigures total() const;
    /// Means over the recorded rays: sampled kinds are weighted by their share of the stream.
    [[nodiscard]] double each(std::uint64_t TraversalStats::*count) const;
    [[nodiscard]] double nanoseconds() const;
};

/// A hashed result for each ray of a stream.
using Answers = std::vector<std::uint64_t>;

struct ReplayOptions {
    double seconds = 10;     ///< limit for the counts, and again for the times
    int repetitions = 3;     ///< of the timing; the fastest one counts; 0: no timing
    bool in_batches = true;  ///< true: as the renderer does; false: in pieces of 64 rays
    bool in_order = false;   ///< picture order; false: random, any part is a fair sample
    RayMask mask = 0;        ///< visibility mask that replaces the kind's; 0: the kind's
};

/// Traces all rays that the time limit allows and compares with `expected`. If `expected` is empty,
/// fills it instead, without a time limit.
[[nodiscard]] ReplayFigures replay(const RayStream& stream, const Aggregate& asked,
                                   const ReplayOptions& options, Answers& expected);

}  // namespace alhazen
