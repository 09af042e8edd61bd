#pragma once
/// Collects records of numbered paths, in parallel.
///
/// Conventions: records are sorted by the number of their path, and for one number by the order of
/// storage: the same for any number of threads. Memory: at most `most` records plus those of a
/// group of numbers.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// Throws the error for records that do not fit: `shot` of `count` paths left more than `most`.
[[noreturn]] void refuse_photons(const char* renderer, std::uint64_t shot, std::uint64_t count,
                                 std::size_t most);

template <class Record>
struct NumberedRecords {
    std::vector<Record> records;
    RayCounters counters;
    std::uint64_t powerful = 0;  ///< paths whose light gave them power
    bool complete = true;        ///< false after a stop, or if the first paths had no power
};

/// `walk_with(counters, stats)` makes an object whose `shoot(number, records)` appends the records
/// of path `number` and returns whether it had power. `renderer`: name for messages. Throws Error
/// (Resource) if more than `most` records would be stored.
template <class Record, class WalkWith>
[[nodiscard]] NumberedRecords<Record> shoot_numbers(const RenderJob& job, std::uint64_t count,
                                                    std::size_t most, const char* renderer,
                                                    const WalkWith& walk_with) {
    // Numbers of a task, and number of tasks between two appends to the store.
    constexpr std::uint64_t kTogether = 4096, kTakes = 64;
    NumberedRecords<Record> all;
    std::vector<NumberedRecords<Record>> takes(kTakes);
    ThreadLimit threads(job.control.threads);
    for (std::uint64_t first = 0; first < count; first += kTakes * kTogether) {
        const std::uint64_t numbers = std::min(kTakes * kTogether, count - first);
        const std::uint64_t groups = (numbers + kTogether - 1) / kTogether;
        threads.run([&] {
            parallel_for(groups, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    NumberedRecords<Record>& take = takes[i];
                    take = {};
                    if (job.stop_requested()) return;
                    auto walk =
                        walk_with(take.counters, job.count_tests ? &take.counters.tests : nullptr);
                    const std::uint64_t from = first + i * kTogether;
                    const std::uint64_t to = std::min(from + kTogether, first + numbers);
                    for (std::uint64_t n = from; n < to; ++n) {
                        take.powerful += walk.shoot(n, take.records) ? 1 : 0;
                    }
                }
            });
        });
        for (std::uint64_t i = 0; i < groups; ++i) {
            const NumberedRecords<Record>& take = takes[i];
            all.counters += take.counters;
            all.powerful += take.powerful;
            if (all.records.size() + take.records.size() > most) {
                refuse_photons(renderer, std::min(first + (i + 1) * kTogether, count), count, most);
            }
            all.records.insert(all.records.end(), take.records.begin(), take.records.end());
        }
        all.complete = !job.stop_requested() && all.powerful > 0;
        if (!all.complete) break;
        if (job.control.progress != nullptr) {
            job.control.progress->update("photons", first + numbers, count);
        }
    }
    return all;
}

}  // namespace alhazen
