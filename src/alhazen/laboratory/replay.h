#pragma once
/// Asks an accelerator the rays of a stream: what it answers, what it counts, how long it takes.
///
/// Conventions: times are seconds of processor time on one thread, of the questions alone: no
/// shading. An answer is known by a number of 64 bits that depends on every bit of its hits (t, u,
/// v, part, ids and the instances on the way); 0 is no answer.
/// Where not all rays can be asked in the time that is given, those asked are spread evenly by
/// chance, pieces of at most 64 neighbours each, with a fixed seed.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/laboratory/ray_stream.h"

namespace alhazen {

/// Of the rays of one kind.
struct KindFigures {
    std::uint64_t counted = 0;  ///< rays that were asked with counting
    std::uint64_t hits = 0;     ///< of these, those that met something
    TraversalStats tests;       ///< of these
    std::uint64_t timed = 0;    ///< rays that were asked for the time
    double seconds = 0;         ///< for these

    KindFigures& operator+=(const KindFigures& other);
    /// A figure for each counted ray; 0 without rays.
    [[nodiscard]] double each(std::uint64_t count) const;
    [[nodiscard]] double nanoseconds() const;  ///< for each timed ray
};

struct ReplayFigures {
    std::array<KindFigures, kRayKindCount> kinds;
    bool all_counted = true, all_timed = true;  ///< else a sample was
    std::uint64_t disagreements = 0;            ///< answers that are not the expected ones
    std::string first_disagreement;             ///< with the ray that repeats it
    std::array<std::uint64_t, kRayKindCount> recorded{};  ///< rays of the stream

    [[nodiscard]] KindFigures total() const;
    /// Means over the recorded rays: where samples were asked, each kind counts as often as it is
    /// in the stream.
    [[nodiscard]] double each(std::uint64_t TraversalStats::*count) const;
    [[nodiscard]] double nanoseconds() const;
};

/// One number for each ray of a stream.
using Answers = std::vector<std::uint64_t>;

struct ReplayOptions {
    double seconds = 10;     ///< for the counts, and again for the times
    int repetitions = 3;     ///< of the times, of which the least counts; 0: no times
    bool in_batches = true;  ///< as the renderer does; else pieces of 64 rays
    bool in_order = false;   ///< of the picture; else by chance, so that any part is a fair sample
    RayMask mask = 0;        ///< what rays see instead of what their kind sees; 0: nothing instead
};

/// Asks all rays that time allows and compares with `expected`; where that is empty it is filled
/// instead, whatever time that takes.
[[nodiscard]] ReplayFigures replay(const RayStream& stream, const Aggregate& asked,
                                   const ReplayOptions& options, Answers& expected);

}  // namespace alhazen
