#pragma once
/// Converts the solids of BRL-CAD to exact shapes.
///
/// Source: BRL-CAD, the definitions of its solids in the manual page of MGED's command `in`.
/// Differs: slightly non-planar faces of an arb8 are handled as in `polyhedron.h`; a plate-mode bot
/// is a surface.

#include <string>
#include <variant>
#include <vector>

#include "alhazen/formats/brlcad/brlcad_solid.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct BrlcadPiece {
    std::variant<AnyShape, std::shared_ptr<TriangleMesh>> what;
    Affine solid_from_piece;
};

/// Pieces whose union is the solid.
struct BrlcadPieces {
    std::vector<BrlcadPiece> pieces;
    bool closed = true;   ///< true if the solid bounds a volume
    std::string refused;  ///< reason if there are no pieces
    std::string doubt;    ///< what contradicts the solid's definition; empty: nothing
};

[[nodiscard]] BrlcadPieces brlcad_pieces(const BrlcadSolid& solid);

/// Length of one pattern (0 to 1 in BRL-CAD's texture coordinates) in the texture coordinates of
/// the solid's shape: the largest face of an arb8, 5 m for a half space, else 1.
[[nodiscard]] Vec2 brlcad_pattern_unit(const BrlcadSolid& solid);

}  // namespace alhazen
