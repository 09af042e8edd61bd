#include "measure.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "alhazen/sampling/random.h"

namespace alhazen::bench {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

namespace {

/// The numbers of the tracers in the order of a round; see `measure`. `last`: the group of the last
/// call of the round before, or empty.
std::vector<std::size_t> draw_order(const std::vector<Contender>& tracers, const std::string& last,
                                    RandomStream& random) {
    std::vector<std::size_t> left(tracers.size()), order, others;
    std::iota(left.begin(), left.end(), std::size_t{0});
    while (!left.empty()) {
        others.clear();
        for (const std::size_t i : left) {
            if (tracers[i].group != (order.empty() ? last : tracers[order.back()].group)) {
                others.push_back(i);
            }
        }
        const std::vector<std::size_t>& from = others.empty() ? left : others;
        const std::size_t next = from[random.below(from.size())];
        order.push_back(next);
        std::erase(left, next);
    }
    return order;
}

/// Runs a tracer of another group, if there is one.
void trace_another(const std::vector<Contender>& tracers, const std::string& group,
                   RandomStream& random) {
    std::vector<const Contender*> others;
    for (const Contender& t : tracers) {
        if (t.group != group) others.push_back(&t);
    }
    if (others.empty()) return;
    const Contender& other = *others[random.below(others.size())];
    if (other.prepare) other.prepare();
    other.trace();
}

/// FNV-1a of the name, the same on every machine.
std::uint64_t seed_of(const std::string& set) {
    std::uint64_t seed = 0xCBF29CE484222325u;
    for (const char c : set) seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
    return seed;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double q) {
        const double place = q * static_cast<double>(values.size() - 1);
        const auto i = static_cast<std::size_t>(place);
        const double next = values[std::min(i + 1, values.size() - 1)];
        return std::lerp(values[i], next, place - static_cast<double>(i));
    };
    return {values.front(), quantile(0.25), quantile(0.5), quantile(0.75), values.back()};
}

std::vector<Measured> measure(const std::string& set, const std::vector<Contender>& tracers,
                              std::size_t rays, int rounds) {
    std::vector<Measured> results;
    for (const Contender& t : tracers) results.push_back({t.group, t.name, {}, 0});
    RandomStream random(seed_of(set));
    std::string last;
    for (int round = 0; round <= rounds; ++round) {
        for (const std::size_t i : draw_order(tracers, last, random)) {
            if (tracers[i].group == last) trace_another(tracers, last, random);
            last = tracers[i].group;
            if (tracers[i].prepare) tracers[i].prepare();
            const double begin = processor_seconds();
            tracers[i].trace();
            const double seconds = processor_seconds() - begin;
            if (round > 0) {
                results[i].rates.push_back(1e-6 * static_cast<double>(rays) / seconds);
            } else {
                results[i].hits = tracers[i].count_hits();
            }
        }
    }
    return results;
}

const Measured* best_of(const std::vector<Measured>& list, const std::string& group) {
    const Measured* best = nullptr;
    for (const Measured& m : list) {
        const auto hits = static_cast<double>(m.hits);
        const auto expected = static_cast<double>(list.front().hits);
        if (m.group != group || std::abs(hits - expected) > 0.005 * expected) continue;
        if (best == nullptr || m.spread().median > best->spread().median) best = &m;
    }
    return best;
}

const Measured* find(const std::vector<Measured>& list, const std::string& group,
                     const std::string& name) {
    const auto place = std::find_if(list.begin(), list.end(), [&](const Measured& m) {
        return m.group == group && m.name == name;
    });
    return place == list.end() ? nullptr : &*place;
}

Spread ratio_by_round(const Measured& a, const Measured& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.rates.size(), b.rates.size()); ++i) {
        ratios.push_back(a.rates[i] / b.rates[i]);
    }
    return spread_of(std::move(ratios));
}

}  // namespace alhazen::bench
