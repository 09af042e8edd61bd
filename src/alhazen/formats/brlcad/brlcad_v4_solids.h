#pragma once
/// Solids of version 4 stored as one record of 24 numbers.
///
/// Source: BRL-CAD, the text output of its program `g2asc`; GIFT users manual (BRL report 1802,
/// 1975) for the vectors of each solid.

#include <array>
#include <optional>

#include "alhazen/formats/brlcad/brlcad_solid.h"

namespace alhazen {

/// The solid of a record of this type; BrlcadUnsupported for unsupported types.
[[nodiscard]] BrlcadSolid brlcad_v4_solid(std::int64_t type, const std::array<double, 24>& values);

/// The mesh of an ars: `curves` closed curves of `points_per_curve` points, consecutive ones joined
/// by triangles. Triangles of zero area are dropped.
[[nodiscard]] BrlcadMesh brlcad_ars(const std::vector<Vec3>& points, std::size_t curves,
                                    std::size_t points_per_curve);

}  // namespace alhazen
