#pragma once
/// Finds the number of a combination of indices, or gives it the next one: a hash table with linear
/// probing.
///
/// Complexity: O(1) expected for each call; 12 bytes and two to four slots of 4 bytes an entry.

#include <cstdint>
#include <vector>

#include "alhazen/importers/obj/obj_statements.h"

namespace alhazen {

class ObjVertexTable {
  public:
    std::uint32_t find_or_add(const ObjCorner& corner) {
        std::size_t slot = first_slot(corner);
        for (; slots_[slot] != kNone; slot = (slot + 1) & (slots_.size() - 1)) {
            if (keys_[slots_[slot]] == corner) return slots_[slot];
        }
        keys_.push_back(corner);
        const std::uint32_t index = std::uint32_t(keys_.size() - 1);
        slots_[slot] = index;
        if (2 * keys_.size() > slots_.size()) grow();
        return index;
    }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }
    [[nodiscard]] const ObjCorner& operator[](std::size_t i) const { return keys_[i]; }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] std::size_t first_slot(const ObjCorner& corner) const {
        std::uint64_t hash = 0;
        for (const std::int32_t part : {corner.position, corner.uv, corner.normal}) {
            hash = (hash ^ std::uint32_t(part)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 32;
        }
        return std::size_t(hash) & (slots_.size() - 1);
    }
    void grow() {
        slots_.assign(2 * slots_.size(), kNone);
        for (std::uint32_t i = 0; i < keys_.size(); ++i) {
            std::size_t slot = first_slot(keys_[i]);
            while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = i;
        }
    }

    std::vector<ObjCorner> keys_;
    std::vector<std::uint32_t> slots_ = std::vector<std::uint32_t>(16, kNone);  ///< 2^n of them
};

}  // namespace alhazen
