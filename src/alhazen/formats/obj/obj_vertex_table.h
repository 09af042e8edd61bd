#pragma once
/// Numbers combinations of indices in the order of first use.
///
/// Complexity: as IndexTable, plus 12 bytes per entry.

#include <cstdint>
#include <vector>

#include "alhazen/formats/mesh/index_table.h"
#include "alhazen/formats/obj/obj_statements.h"

namespace alhazen {

class ObjVertexTable {
  public:
    std::uint32_t find_or_add(const ObjCorner& corner) {
        const std::uint32_t index = table_.find_or_add(
            hash(corner), keys_.size(), [&](std::uint32_t i) { return keys_[i] == corner; },
            [&](std::uint32_t i) { return hash(keys_[i]); });
        if (index == keys_.size()) keys_.push_back(corner);
        return index;
    }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }
    [[nodiscard]] const ObjCorner& operator[](std::size_t i) const { return keys_[i]; }

  private:
    [[nodiscard]] std::uint64_t hash(const ObjCorner& corner) const {
        return table_.hash(
            {std::uint32_t(corner.position) | std::uint64_t{std::uint32_t(corner.uv)} << 32,
             std::uint32_t(corner.normal)});
    }

    std::vector<ObjCorner> keys_;
    IndexTable table_;
};

}  // namespace alhazen
