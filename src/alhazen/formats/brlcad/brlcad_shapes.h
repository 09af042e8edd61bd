#pragma once
/// The exact shapes that solids of BRL-CAD are made of.
///
/// Source: BRL-CAD, the definitions of its solids in the manual page of MGED's command `in`.
/// Differs: faces of an arb8 that are not quite plane are treated as in `polyhedron.h`; a plate of
/// a bot is a surface.

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

/// The union of the pieces is the solid.
struct BrlcadPieces {
    std::vector<BrlcadPiece> pieces;
    bool closed = true;   ///< it bounds a volume
    std::string refused;  ///< why there are none
};

[[nodiscard]] BrlcadPieces brlcad_pieces(const BrlcadSolid& solid);

}  // namespace alhazen
