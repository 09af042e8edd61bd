#pragma once
/// Shapes as emitters. ADD AN EMITTING SHAPE HERE: an overload in emitters_of_shape.cpp. Light of
/// shapes without one is found only by rays that hit them.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// The number of emitters of a primitive if its material emits: one for each part of its hits, or
/// one for all parts; 0 for instances and shapes without emitters.
[[nodiscard]] std::uint32_t emitters_of_shape(const PrimitiveTable& table, PrimitiveId id);

/// Appends the emitters of a primitive, before `make_ready` and without radiance.
void append_emitters_of_shape(const PrimitiveTable& table, PrimitiveId id,
                              const Affine& world_from_table, std::vector<Emitter>& emitters);

/// The rectangle whose halves are two triangles of one mesh, up to rounding; none if they are not.
/// `radiance` and `two_sided` are not set.
[[nodiscard]] std::optional<Emitter> rectangle_of_halves(const PrimitiveTable& table,
                                                         PrimitiveId first, PrimitiveId second);

}  // namespace alhazen
