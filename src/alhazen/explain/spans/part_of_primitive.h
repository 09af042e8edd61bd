#pragma once
/// The part of the scene file that a primitive of a table comes from.

#include <cstdint>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Number of the part, as in Surface::part; for an instance, of the part that placed it.
[[nodiscard]] std::uint32_t part_of_primitive(const PrimitiveTable& table, PrimitiveId id);

}  // namespace alhazen
