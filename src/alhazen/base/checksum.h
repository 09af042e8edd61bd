#pragma once
/// A 64-bit checksum of bytes: detects damage and mistakes, gives no protection against an
/// adversary.
///
/// Source: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014
/// (the final mixing).
/// Differs: words are distributed over four independent sums, so that no multiplication waits for
/// the previous one.
/// Conventions: every step is invertible, so that a change within one aligned word always changes
/// the sum. The sum depends on how the bytes are divided into calls, and on the byte order of the
/// machine.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace alhazen {

class Checksum {
  public:
    void add(std::span<const std::byte> bytes) {
        const std::byte* p = bytes.data();
        std::size_t left = bytes.size();
        for (; left >= 32; left -= 32, p += 32) {
            std::uint64_t words[4];
            std::memcpy(words, p, 32);
            for (int i = 0; i < 4; ++i) sums_[i] = step(sums_[i], words[i]);
        }
        std::uint64_t rest[4]{};
        if (left > 0) std::memcpy(rest, p, left);
        for (int i = 0; i < 4; ++i) sums_[i] = step(sums_[i], rest[i]);
        add(std::uint64_t{bytes.size()});
    }
    /// The bytes of plain values without gaps between their members.
    template <class T>
    void add(std::span<const T> values) {
        add(std::as_bytes(values));
    }
    void add(std::uint64_t word) { sums_[0] = step(sums_[0], word); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

    [[nodiscard]] std::uint64_t value() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t s : sums_) sum = mixed(sum ^ s);
        return sum;
    }

  private:
    static std::uint64_t step(std::uint64_t sum, std::uint64_t word) {
        // The shift spreads a change of the top bit; without it one bit of a later word could undo
        // it.
        const std::uint64_t product = (sum ^ word) * 0x9E3779B97F4A7C15u;
        return product ^ product >> 32;
    }
    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
        z = (z ^ z >> 27) * 0x94D049BB133111EBu;
        return z ^ z >> 31;
    }

    std::uint64_t sums_[4]{0x243F6A8885A308D3u, 0x13198A2E03707344u, 0xA4093822299F31D0u,
                           0x082EFA98EC4E6C89u};  // digits of pi: none of them zero
};

}  // namespace alhazen
