#pragma once
/// Solids of BRL-CAD that are quadrics or quartics in a local frame.
///
/// Source: BRL-CAD, the definitions of rpc, rhc, epa, ehy, hyp and eto in the manual page of MGED's
/// command `in`.
/// Differs: each is a general quadric (or a polynomial of degree 4), clipped to a box of unit size
/// and placed by a transform.
/// Conventions: the asymptotes of a hyperbola intersect at the distance c above the apex.

#include <optional>

#include "alhazen/formats/brlcad/brlcad_shapes.h"

namespace alhazen {

/// A shape and its transform; the caller validates both.
struct BrlcadQuadric {
    Quadric shape;
    Affine solid_from_shape;
};

[[nodiscard]] BrlcadQuadric brlcad_quadric(const BrlcadConicCylinder& solid);
[[nodiscard]] BrlcadQuadric brlcad_quadric(const BrlcadConicDome& solid);
[[nodiscard]] BrlcadQuadric brlcad_quadric(const BrlcadHyperboloid& solid);

struct BrlcadQuartic {
    Algebraic shape;
    Affine solid_from_shape;
};

/// The quartic of the solid; none if the ellipse reaches the axis or has no area.
[[nodiscard]] std::optional<BrlcadQuartic> brlcad_quartic(const BrlcadEllipticTorus& solid);

}  // namespace alhazen
