#pragma once
/// Numbers keys in the order of their first use: a hash table with linear probing; the caller
/// stores the keys in a list.
///
/// Conventions: hashes are seeded differently for each run and each table, so that no file can be
/// crafted whose keys all collide. The numbering does not depend on the seed.
/// Complexity: O(1) expected per call; two to four slots of 4 bytes per key.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "alhazen/sampling/random.h"

namespace alhazen {

class IndexTable {
  public:
    /// Reserves for about `expected` keys.
    explicit IndexTable(std::size_t expected = 0)
        : slots_(std::bit_ceil(2 * expected + 16), kNone), seed_(new_seed()) {}

    /// The hash of a key made of these words.
    [[nodiscard]] std::uint64_t hash(std::initializer_list<std::uint64_t> words) const {
        std::uint64_t hash = seed_;
        for (const std::uint64_t word : words) hash = mix64(hash ^ word);
        return hash;
    }

    /// Returns the number of the key with this hash: the number below `count` for which
    /// `is_key(number)` holds, otherwise `count`; the caller then appends the key to its list.
    /// `hash_of(number)` returns the hashes of existing keys.
    template <class IsKey, class HashOf>
    std::uint32_t find_or_add(std::uint64_t hash, std::size_t count, const IsKey& is_key,
                              const HashOf& hash_of) {
        // Grows before the new key exists: its hash cannot be queried yet.
        if (2 * (count + 1) > slots_.size()) grow(count, hash_of);
        std::size_t slot = slot_of(hash);
        for (; slots_[slot] != kNone; slot = slot_of(slot + 1)) {
            if (is_key(slots_[slot])) return slots_[slot];
        }
        slots_[slot] = std::uint32_t(count);
        return slots_[slot];
    }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] static std::uint64_t new_seed();
    [[nodiscard]] std::size_t slot_of(std::uint64_t hash) const {
        return std::size_t(hash) & (slots_.size() - 1);
    }
    template <class HashOf>
    void grow(std::size_t count, const HashOf& hash_of) {
        slots_.assign(2 * slots_.size(), kNone);
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t slot = slot_of(hash_of(std::uint32_t(i)));
            while (slots_[slot] != kNone) slot = slot_of(slot + 1);
            slots_[slot] = std::uint32_t(i);
        }
    }

    std::vector<std::uint32_t> slots_;  ///< size: a power of two
    std::uint64_t seed_;
};

}  // namespace alhazen
