#pragma once
/// Exact representations of shapes as rational Bezier patches.
///
/// Source: Piegl and Tiller, "The NURBS Book", 2nd ed., Springer, 1997, sections 7.3 to 7.5
/// (circles, conics), 8.3 and 8.5 (quadrics, surfaces of revolution). Differs: exact up to the
/// rounding of sqrt(1/2) and of the axes.
/// Conventions: du x dv points outward. part is that of the shape's own hits. Neighbouring patches
/// have equal control points, bit for bit, along the boundary they share, so that the patches of a
/// closed shape close. The middle weights of quarter circles are sqrt(1/2): u and v of a piece are
/// not the shape's own texture coordinates; v of a lathe is the parameter of its profile.

#include <concepts>
#include <vector>

#include "alhazen/shapes/algebraic/tgc.h"
#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/shapes/patches/bezier_patch.h"
#include "alhazen/shapes/patches/bilinear_patch.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/patch_mesh.h"
#include "alhazen/shapes/patches/steiner_patch.h"
#include "alhazen/shapes/polygons/disc.h"
#include "alhazen/shapes/polygons/rectangle.h"
#include "alhazen/shapes/quadrics/cone.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "alhazen/shapes/quadrics/ellipsoid.h"
#include "alhazen/shapes/quadrics/elliptic_cone.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"
#include "alhazen/shapes/quadrics/hyperboloid.h"
#include "alhazen/shapes/quadrics/paraboloid.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "alhazen/shapes/quadrics/two_sheet_hyperboloid.h"
#include "alhazen/shapes/swept/lathe.h"

namespace alhazen {

// Appends the patches of a prepared, valid shape.
void append_pieces(const Sphere& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Ellipsoid& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Cylinder& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Cone& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const EllipticCylinder& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const EllipticCone& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Tgc& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Paraboloid& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Hyperboloid& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const TwoSheetHyperboloid& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Torus& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Lathe& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Disc& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const Rectangle& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const BezierPatch& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const PatchMesh& shape, std::vector<BezierPiece>& pieces);
/// Without the trimming loops.
void append_pieces(const NurbsSurface& shape, std::vector<BezierPiece>& pieces);
void append_pieces(const BilinearPatch& shape, std::vector<BezierPiece>& pieces);
/// As a biquadratic patch whose edge v = 1 is the last corner.
void append_pieces(const SteinerPatch& shape, std::vector<BezierPiece>& pieces);

/// Shapes that are rational Bezier patches.
template <class S>
concept HasPatchForm = requires(const S& shape, std::vector<BezierPiece>& pieces) {
    { append_pieces(shape, pieces) } -> std::same_as<void>;
};

}  // namespace alhazen
