#pragma once
/// A hash table from coordinate keys to numbers, with open addressing and growth.
///
/// Precondition: no key has all bits set.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alhazen {

class NumberTable {
  public:
    static constexpr std::uint32_t kNone = ~0u;

    /// kNone if the key is unknown.
    [[nodiscard]] std::uint32_t find(std::uint64_t key) const {
        return keys_.empty() ? kNone : values_[slot_of(key)];
    }
    /// The value of the key, after setting it to `fresh` if it has none.
    std::uint32_t find_or_add(std::uint64_t key, std::uint32_t fresh) {
        std::uint32_t& value = value_of(key);
        if (value == kNone) value = fresh;
        return value;
    }
    void set(std::uint64_t key, std::uint32_t value) { value_of(key) = value; }

  private:
    static constexpr std::uint64_t kFree = ~std::uint64_t{0};

    [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
        std::size_t slot = (key * 0x9E3779B97F4A7C15u) >> 20 & (keys_.size() - 1);
        while (keys_[slot] != kFree && keys_[slot] != key) slot = (slot + 1) & (keys_.size() - 1);
        return slot;
    }
    std::uint32_t& value_of(std::uint64_t key) {
        if (2 * (used_ + 1) > keys_.size()) grow();
        const std::size_t slot = slot_of(key);
        if (keys_[slot] == kFree) {
            keys_[slot] = key;
            ++used_;
        }
        return values_[slot];
    }
    void grow() {
        std::vector<std::uint64_t> keys(keys_.empty() ? 64 : 2 * keys_.size(), kFree);
        std::vector<std::uint32_t> values(keys.size(), kNone);
        keys_.swap(keys);
        values_.swap(values);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (keys[i] == kFree) continue;
            const std::size_t slot = slot_of(keys[i]);
            keys_[slot] = keys[i];
            values_[slot] = values[i];
        }
    }

    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> values_;
    std::size_t used_ = 0;
};

}  // namespace alhazen
