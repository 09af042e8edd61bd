#include "alhazen/imaging/codecs/deflate_stream.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

/// Bytes that may be read behind the stream.
constexpr std::size_t kReadAhead = 8;

class BitReader {
  public:
    explicit BitReader(const std::uint8_t* bytes) : bytes_(bytes) {}

    [[nodiscard]] std::size_t position() const { return position_; }
    /// The next 57 bits, the first one lowest, and some more.
    [[nodiscard]] std::uint64_t next() const {
        const std::uint8_t* const from = bytes_ + position_ / 8;
        std::uint64_t bits = 0;
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(&bits, from, 8);
        } else {
            for (unsigned i = 0; i < 8; ++i) bits |= std::uint64_t{from[i]} << (8 * i);
        }
        return bits >> (position_ % 8);
    }
    void skip(std::size_t bits) { position_ += bits; }
    void skip_to_byte() { position_ = (position_ + 7) / 8 * 8; }
    /// `bits` is at most 16.
    unsigned take(unsigned bits) {
        const unsigned value = unsigned(next()) & ((1u << bits) - 1);
        position_ += bits;
        return value;
    }

  private:
    const std::uint8_t* bytes_;
    std::size_t position_ = 0;
};

/// A Huffman code, as entries by the bits that follow.
class CodeTable {
  public:
    /// `entry(symbol, length)`: that of a code of `length` bits.
    template <class Entry>
    void make(std::span<const std::uint8_t> lengths, const Entry& entry) {
        std::array<unsigned, kMostBits + 1> counts{};
        for (const std::uint8_t length : lengths) ++counts[length];
        counts[0] = 0;
        std::array<unsigned, kMostBits + 1> next{};
        unsigned most = 0;
        for (unsigned length = 1; length <= kMostBits; ++length) {
            next[length] = (next[length - 1] + counts[length - 1]) << 1;
            if (counts[length] > 0) most = length;
        }
        entries_.assign(std::size_t{1} << most, 0);
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
            const unsigned length = lengths[symbol];
            if (length == 0) continue;
            const unsigned code = next[length]++;
            std::size_t at = 0;  // codes begin with their highest bit
            for (unsigned bit = 0; bit < length; ++bit) {
                at |= std::size_t{(code >> bit) & 1} << (length - 1 - bit);
            }
            for (; at < entries_.size(); at += std::size_t{1} << length) {
                entries_[at] = std::uint16_t(entry(unsigned(symbol), length));
            }
        }
    }
    [[nodiscard]] unsigned at(std::uint64_t bits) const {
        return entries_[std::size_t(bits) & (entries_.size() - 1)];
    }

  private:
    static constexpr unsigned kMostBits = 15;
    std::vector<std::uint16_t> entries_;
};

/// Entries of literals and lengths: the bits of a code with those that belong to it, and flags.
constexpr unsigned kBits = 63, kLength = 64, kEnd = 128;

unsigned literal_entry(unsigned symbol, unsigned bits) {
    if (symbol < 256) return bits;
    if (symbol == 256) return bits | kEnd;
    const bool has_more = symbol >= 265 && symbol < 285;
    return (bits + (has_more ? (symbol - 261) / 4 : 0)) | kLength;
}

unsigned distance_entry(unsigned symbol, unsigned bits) {
    return bits + (symbol < 4 ? 0 : symbol / 2 - 1);
}

/// Follows the blocks of a stream without decompressing them.
class BlockWalk {
  public:
    explicit BlockWalk(const std::uint8_t* bytes) : bits_(bytes) {}

    /// Goes to the end of the final block, and returns the bit at which it begins.
    std::size_t final_block() {
        for (;;) {
            const std::size_t begin = bits_.position();
            const bool is_final = bits_.take(1) == 1;
            pass_block(bits_.take(2));
            if (is_final) return begin;
        }
    }
    [[nodiscard]] std::size_t position() const { return bits_.position(); }

  private:
    using Lengths = std::array<std::uint8_t, 320>;  ///< of the codes of both tables

    void pass_block(unsigned kind) {
        constexpr unsigned kStored = 0, kFixed = 1;
        if (kind == kStored) {
            bits_.skip_to_byte();
            const unsigned bytes = bits_.take(16);
            bits_.skip(16 + 8 * std::size_t{bytes});
            return;
        }
        if (kind == kFixed) {
            Lengths lengths;
            lengths.fill(8);
            std::fill_n(lengths.begin() + 144, 256 - 144, std::uint8_t{9});
            std::fill_n(lengths.begin() + 256, 280 - 256, std::uint8_t{7});
            std::fill_n(lengths.begin() + 288, 32, std::uint8_t{5});
            set_tables(lengths, 288, 32);
        } else {
            read_tables();
        }
        pass_codes();
    }

    void set_tables(const Lengths& lengths, std::size_t literals, std::size_t distances) {
        const std::span<const std::uint8_t> all(lengths);
        literals_.make(all.first(literals), literal_entry);
        distances_.make(all.subspan(literals, distances), distance_entry);
    }

    void read_tables() {
        static constexpr std::array<std::uint8_t, 19> kOrder{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                             11, 4,  12, 3, 13, 2, 14, 1, 15};
        const std::size_t literals = 257 + bits_.take(5), distances = 1 + bits_.take(5);
        const std::size_t codes = 4 + bits_.take(4);
        std::array<std::uint8_t, kOrder.size()> of_lengths{};
        for (std::size_t i = 0; i < codes; ++i) of_lengths[kOrder[i]] = std::uint8_t(bits_.take(3));
        lengths_.make(of_lengths,
                      [](unsigned symbol, unsigned bits) { return symbol * 16 + bits; });
        Lengths lengths{};
        std::size_t at = 0;
        const auto repeat = [&](std::uint8_t length, unsigned times) {
            times = unsigned(std::min<std::size_t>(times, lengths.size() - at));
            std::fill_n(lengths.begin() + std::ptrdiff_t(at), times, length);
            at += times;
        };
        while (at < literals + distances) {
            const unsigned entry = lengths_.at(bits_.next()), symbol = entry / 16;
            bits_.skip(entry % 16);
            if (symbol < 16) {
                repeat(std::uint8_t(symbol), 1);
            } else if (symbol == 16) {
                repeat(at > 0 ? lengths[at - 1] : std::uint8_t{0}, 3 + bits_.take(2));
            } else {
                repeat(0, symbol == 17 ? 3 + bits_.take(3) : 11 + bits_.take(7));
            }
        }
        set_tables(lengths, literals, distances);
    }

    void pass_codes() {
        BitReader bits = bits_;  // a local one stays in registers
        for (;;) {
            std::uint64_t next = bits.next();
            unsigned entry = literals_.at(next);
            // Two more codes are among the 57 bits: each has at most 15.
            for (int i = 0; i < 2 && entry < kLength; ++i) {
                bits.skip(entry);
                next >>= entry;
                entry = literals_.at(next);
            }
            bits.skip(entry & kBits);
            if ((entry & kEnd) != 0) break;
            if ((entry & kLength) != 0) bits.skip(distances_.at(bits.next()));
        }
        bits_ = bits;
    }

    BitReader bits_;
    CodeTable lengths_, literals_, distances_;
};

}  // namespace

void leave_open(std::vector<std::uint8_t>& stream) {
    const std::size_t size = stream.size();
    stream.resize(size + kReadAhead, 0);
    BlockWalk walk(stream.data());
    const std::size_t last = walk.final_block(), end = walk.position();
    if ((end + 7) / 8 != size) {
        throw Error(ErrorKind::Render, "a deflate stream does not end in its last byte");
    }
    stream[last / 8] = std::uint8_t(stream[last / 8] & ~(1u << (last % 8)));
    // The three bits before the stored block's length are zeros, like those up to the next byte.
    constexpr unsigned kHeader = 3;
    stream.resize((end + kHeader + 7) / 8);
    stream.insert(stream.end(), {0x00, 0x00, 0xff, 0xff});
}

}  // namespace alhazen
