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
/// Number of leading bits of a code that are sorted by digits.
constexpr int kKeyBits = 32;

/// The leading bits of a code, and below them the index of its reference.
using Entry = std::uint64_t;

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
void sort_by_digit(std::span<const Entry> from, Entry* to, int shift) {
    const std::size_t chunks = (from.size() - 1) / kRadixChunk + 1;
    std::vector<std::array<std::uint32_t, kDigits>> places(chunks);
    const auto digit = [&](Entry e) { return e >> shift & (kDigits - 1); };
    parallel_for(from.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const counts = places[begin / kRadixChunk].data();
        const Entry* const entries = from.data();
        for (std::size_t i = begin; i < end; ++i) ++counts[digit(entries[i])];
    });
    std::uint32_t next = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
        for (auto& place : places) next += std::exchange(place[d], next);
    }
    parallel_for(from.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const place = places[begin / kRadixChunk].data();
        const Entry* const entries = from.data();
        for (std::size_t i = begin; i < end; ++i) to[place[digit(entries[i])]++] = entries[i];
    });
}

/// Computes the codes of all references, in their order.
void find_codes(std::span<const BuildReference> references, std::uint64_t* codes, Entry* entries) {
    const RangeSummary all = summarize(references);
    Float4 lo{}, scale{};
    for (int k = 0; k < 3; ++k) {
        lo[k] = all.centers.lo[k];
        const float extent = all.centers.hi[k] - lo[k];
        const float s = 2097151.0f / extent;
        scale[k] = extent > 0.0f && s < 1e37f ? s : 0.0f;
    }
    const Float4 most{2097151.0f, 2097151.0f, 2097151.0f, 2097151.0f};
    parallel_for(references.size(), kRadixChunk, [&](std::size_t begin, std::size_t end) {
        using Int4 = std::int32_t __attribute__((vector_size(16)));
        const BuildReference* const r = references.data();
        for (std::size_t i = begin; i < end; ++i) {
            const Float4 place = lesser((Box4(r[i]).center2() - lo) * scale, most);
            const Int4 cell = __builtin_convertvector(place, Int4);
            const std::uint64_t code = spread(static_cast<std::uint32_t>(cell[0])) << 2 |
                                       spread(static_cast<std::uint32_t>(cell[1])) << 1 |
                                       spread(static_cast<std::uint32_t>(cell[2]));
            codes[i] = code;
            entries[i] = code >> (kCodeBits - kKeyBits) << kKeyBits | i;
        }
    });
}

/// Start indices of the runs of entries with the same key that begin in each chunk, and the end.
std::vector<std::size_t> starts_of_runs(const Entry* entries, std::size_t size) {
    std::vector<std::size_t> starts;
    for (std::size_t begin = 0; begin < size; begin += kRadixChunk) {
        std::size_t i = std::max(begin, starts.empty() ? 0 : starts.back());
        while (i > 0 && i < size && entries[i] >> kKeyBits == entries[i - 1] >> kKeyBits) ++i;
        starts.push_back(i);
    }
    starts.push_back(size);
    return starts;
}

/// Sorts a long run of entries with the same key by the rest of their codes, digit by digit.
void sort_long_run(Entry* first, std::size_t size, const std::uint64_t* codes) {
    constexpr std::uint64_t kRest = (std::uint64_t{1} << (kCodeBits - kKeyBits)) - 1;
    static_assert(kCodeBits - kKeyBits <= 3 * kDigitBits);
    const auto other = make_huge_array<Entry>(size);
    parallel_for(size, kRadixChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto number = static_cast<std::uint32_t>(first[i]);
            other[i] = (codes[number] & kRest) << kKeyBits | number;
        }
    });
    sort_by_digit({other.get(), size}, first, kKeyBits);
    sort_by_digit({first, size}, other.get(), kKeyBits + kDigitBits);
    sort_by_digit({other.get(), size}, first, kKeyBits + 2 * kDigitBits);
}

/// Sorts each run of entries with the same key by the rest of their codes.
void sort_runs(Entry* first, const Entry* end, const std::uint64_t* codes) {
    const auto number = [](Entry e) { return static_cast<std::uint32_t>(e); };
    while (first < end) {
        Entry* last = first + 1;
        while (last < end && *last >> kKeyBits == *first >> kKeyBits) ++last;
        const auto size = static_cast<std::size_t>(last - first);
        if (size > kRadixChunk) {
            sort_long_run(first, size, codes);
        } else if (size > 1) {
            std::sort(first, last, [&](Entry a, Entry b) {
                const std::uint64_t ca = codes[number(a)], cb = codes[number(b)];
                return ca != cb ? ca < cb : a < b;
            });
        }
        first = last;
    }
}

}  // namespace

void sort_along_curve(std::span<const BuildReference> references, std::span<BuildReference> sorted,
                      std::span<std::uint64_t> codes) {
    if (references.empty()) return;
    const std::size_t size = references.size();
    const auto unsorted_codes = make_huge_array<std::uint64_t>(size);
    auto entries = make_huge_array<Entry>(size), other = make_huge_array<Entry>(size);
    find_codes(references, unsorted_codes.get(), entries.get());
    for (int shift = kKeyBits; shift < 2 * kKeyBits; shift += kDigitBits) {
        sort_by_digit({entries.get(), size}, other.get(), shift);
        entries.swap(other);
    }
    const std::vector<std::size_t> starts = starts_of_runs(entries.get(), size);
    parallel_for(starts.size() - 1, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            sort_runs(entries.get() + starts[i], entries.get() + starts[i + 1],
                      unsorted_codes.get());
        }
    });
    parallel_for(size, kRadixChunk, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto number = static_cast<std::uint32_t>(entries[i]);
            codes.data()[i] = unsorted_codes[number];
            sorted.data()[i] = references.data()[number];
        }
    });
}

}  // namespace alhazen
