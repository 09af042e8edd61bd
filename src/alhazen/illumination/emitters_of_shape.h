#pragma once
/// Shapes as emitters. ADD AN EMITTING SHAPE HERE: an overload in emitters_of_shape.cpp. Shapes
/// without one are found by chance alone.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Emitters of a primitive that is no instance, were its material to shine: [part of its hits], or
/// one for all its parts.
[[nodiscard]] std::uint32_t emitters_of_shape(const PrimitiveTable& table, PrimitiveId id);

/// Appends them, not ready (`make_ready`) and without radiance.
void append_emitters_of_shape(const PrimitiveTable& table, PrimitiveId id,
                              const Affine& world_from_table, std::vector<Emitter>& emitters);

/// The rectangle of which two triangles of one mesh are the halves, to rounding; none where they
/// are not. Radiance and sides are not set.
[[nodiscard]] std::optional<Emitter> rectangle_of_halves(const PrimitiveTable& table,
                                                         PrimitiveId first, PrimitiveId second);

}  // namespace alhazen
