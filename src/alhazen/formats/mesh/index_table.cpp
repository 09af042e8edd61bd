#include "alhazen/formats/mesh/index_table.h"

#include <atomic>
#include <chrono>
#include <random>

namespace alhazen {

namespace {

std::uint64_t seed_of_process() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    std::uint64_t seed = mix64(std::uint64_t(now));
    try {
        std::random_device device;
        for (int i = 0; i < 2; ++i) seed = mix64(seed ^ device());
    } catch (const std::exception&) {
        // No random device: the clock alone is the seed.
    }
    return seed;
}

}  // namespace

std::uint64_t IndexTable::new_seed() {
    static const std::uint64_t seed = seed_of_process();
    static std::atomic<std::uint64_t> tables{0};
    return mix64(seed ^ mix64(tables++));
}

}  // namespace alhazen
