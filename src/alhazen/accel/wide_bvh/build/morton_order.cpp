#include "alhazen/accel/wide_bvh/build/morton_order.h"

#include <algorithm>
#include <utility>

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::size_t kRadixChunk = 65536;
constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr int kCodeBits = 63;

struct Entry {
    std::uint64_t code;
    std::uint32_t index;
};

/// The lowest 21 bits with two zeros before each.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1FFFFF;
    x = (x | x << 32) & 0x1F00000000FFFF;
    x = (x | x << 16) & 0x1F0000FF0000FF;
    x = (x | x << 8) & 0x100F00F00F00F00F;
    x = (x | x << 4) & 0x10C30C30C30C30C3;
    return (x | x << 2) & 0x1249249249249249;
}

/// One stable pass of a radix sort: chunks are counted, then written, in parallel.
void sort_by_digit(const std::vector<Entry>& from, std::vector<Entry>& to, int shift) {
    const std::size_t chunks = (from.size() - 1) / kRadixChunk + 1;
    std::vector<std::array<std::uint32_t, kDigits>> places(chunks);
    const auto digit = [&](const Entry& e) { return e.code >> shift & (kDigits - 1); };
    parallel_for(from.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        auto& counts = places[begin / kRadixChunk];
        counts.fill(0);
        for (std::size_t i = begin; i < end; ++i) ++counts[digit(from[i])];
    });
    std::uint32_t next = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
        for (auto& place : places) next += std::exchange(place[d], next);
    }
    parallel_for(from.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        auto& place = places[begin / kRadixChunk];
        for (std::size_t i = begin; i < end; ++i) to[place[digit(from[i])]++] = from[i];
    });
}

std::vector<Entry> entries_of(const std::vector<BuildReference>& references) {
    const RangeSummary all = summarize(references);
    float lo[3], scale[3];
    for (int k = 0; k < 3; ++k) {
        lo[k] = all.centers.lo[k];
        const float extent = all.centers.hi[k] - lo[k];
        const float s = 2097151.0f / extent;
        scale[k] = extent > 0.0f && s < 1e37f ? s : 0.0f;
    }
    std::vector<Entry> entries(references.size());
    parallel_for(references.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::uint64_t code = 0;
            for (int k = 0; k < 3; ++k) {
                const float place = (references[i].center2(k) - lo[k]) * scale[k];
                code |= spread(static_cast<std::uint64_t>(std::min(place, 2097151.0f))) << (2 - k);
            }
            entries[i] = {code, static_cast<std::uint32_t>(i)};
        }
    });
    return entries;
}

}  // namespace

std::vector<std::uint64_t> sort_along_curve(std::vector<BuildReference>& references) {
    if (references.empty()) return {};
    std::vector<Entry> entries = entries_of(references);
    std::vector<Entry> other(entries.size());
    for (int shift = 0; shift < kCodeBits; shift += kDigitBits) {
        sort_by_digit(entries, other, shift);
        entries.swap(other);
    }
    std::vector<std::uint64_t> codes(entries.size());
    std::vector<BuildReference> sorted(entries.size());
    parallel_for(entries.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            codes[i] = entries[i].code;
            sorted[i] = references[entries[i].index];
        }
    });
    references = std::move(sorted);
    return codes;
}

}  // namespace alhazen
