#pragma once
/// The solids of version 4 that are one record of 24 numbers.
///
/// Source: BRL-CAD, the text that its program `g2asc` writes; GIFT users manual (BRL report 1802,
/// 1975) for the vectors of each solid. Differs: nothing.

#include <array>
#include <optional>

#include "alhazen/formats/brlcad/brlcad_solid.h"

namespace alhazen {

/// The solid of a record of this type; one of no type that is read is BrlcadUnsupported.
[[nodiscard]] BrlcadSolid brlcad_v4_solid(std::int64_t type, const std::array<double, 24>& values);

/// A mesh of the points of an ars: `curves` closed curves of `points_per_curve` points, each joined
/// to the next by triangles; those of no area are left out.
[[nodiscard]] BrlcadMesh brlcad_ars(const std::vector<Vec3>& points, std::size_t curves,
                                    std::size_t points_per_curve);

}  // namespace alhazen
