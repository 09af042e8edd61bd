#pragma once
/// The closed list of analytic shapes. ADD A SHAPE HERE: one include, one entry.
///
/// The position in the list is the shape's type index; primitives of a lower type have lower ids.

#include <variant>

#include "alhazen/shapes/algebraic/algebraic.h"
#include "alhazen/shapes/algebraic/superellipsoid.h"
#include "alhazen/shapes/algebraic/tgc.h"
#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/shapes/blobs/blob.h"
#include "alhazen/shapes/meshes/height_field.h"
#include "alhazen/shapes/patches/bezier_patch.h"
#include "alhazen/shapes/patches/bilinear_patch.h"
#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"
#include "alhazen/shapes/patches/patch_mesh.h"
#include "alhazen/shapes/patches/steiner_patch.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "alhazen/shapes/polygons/disc.h"
#include "alhazen/shapes/polygons/half_space.h"
#include "alhazen/shapes/polygons/plane.h"
#include "alhazen/shapes/polygons/polygon.h"
#include "alhazen/shapes/polygons/polyhedron.h"
#include "alhazen/shapes/polygons/rectangle.h"
#include "alhazen/shapes/quadrics/cone.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "alhazen/shapes/quadrics/ellipsoid.h"
#include "alhazen/shapes/quadrics/elliptic_cone.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"
#include "alhazen/shapes/quadrics/hyperboloid.h"
#include "alhazen/shapes/quadrics/paraboloid.h"
#include "alhazen/shapes/quadrics/quadric.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "alhazen/shapes/quadrics/two_sheet_hyperboloid.h"
#include "alhazen/shapes/swept/lathe.h"
#include "alhazen/shapes/swept/prism.h"

namespace alhazen {

template <Shape... S>
struct ShapeTypes {
    using Variant = std::variant<S...>;
    template <template <class> class Container>
    using Columns = std::tuple<Container<S>...>;
    static constexpr std::size_t kCount = sizeof...(S);
};

using AnalyticShapes =
    ShapeTypes<Sphere, Plane, Disc, Rectangle, BoxShape, Cylinder, Cone, Polygon, HalfSpace,
               Polyhedron, Ellipsoid, EllipticCylinder, EllipticCone, Tgc, Torus, Paraboloid,
               Hyperboloid, TwoSheetHyperboloid, Quadric, Algebraic, Superellipsoid, Prism, Lathe,
               Blob, HeightField, BezierPatch, PatchMesh, NurbsSurface, BilinearPatch,
               SteinerPatch>;

/// Any analytic shape by value: the variant, with copy, move and destruction compiled only once.
class AnyShape : public AnalyticShapes::Variant {
  public:
    using AnalyticShapes::Variant::Variant;
    AnyShape();
    AnyShape(const AnyShape&);
    AnyShape(AnyShape&&) noexcept;
    AnyShape& operator=(const AnyShape&);
    AnyShape& operator=(AnyShape&&) noexcept;
    ~AnyShape();
};

}  // namespace alhazen
