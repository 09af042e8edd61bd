#pragma once
/// The closed list of analytic shapes. ADD A SHAPE HERE: one include, one entry.
///
/// The position in the list is the shape's type index; primitives of a lower type have lower ids.

#include <variant>

#include "alhazen/shapes/algebraic.h"
#include "alhazen/shapes/blob.h"
#include "alhazen/shapes/box_shape.h"
#include "alhazen/shapes/cone.h"
#include "alhazen/shapes/cylinder.h"
#include "alhazen/shapes/disc.h"
#include "alhazen/shapes/ellipsoid.h"
#include "alhazen/shapes/elliptic_cone.h"
#include "alhazen/shapes/elliptic_cylinder.h"
#include "alhazen/shapes/half_space.h"
#include "alhazen/shapes/height_field.h"
#include "alhazen/shapes/hyperboloid.h"
#include "alhazen/shapes/lathe.h"
#include "alhazen/shapes/paraboloid.h"
#include "alhazen/shapes/plane.h"
#include "alhazen/shapes/polygon.h"
#include "alhazen/shapes/polyhedron.h"
#include "alhazen/shapes/prism.h"
#include "alhazen/shapes/quadric.h"
#include "alhazen/shapes/rectangle.h"
#include "alhazen/shapes/sphere.h"
#include "alhazen/shapes/superellipsoid.h"
#include "alhazen/shapes/tgc.h"
#include "alhazen/shapes/torus.h"
#include "alhazen/shapes/two_sheet_hyperboloid.h"

namespace alhazen {

template <Shape... S>
struct ShapeTypes {
    using Variant = std::variant<S...>;
    template <template <class> class Container>
    using Columns = std::tuple<Container<S>...>;
    static constexpr std::size_t kCount = sizeof...(S);
};

using AnalyticShapes = ShapeTypes<Sphere, Plane, Disc, Rectangle, BoxShape, Cylinder, Cone, Polygon,
                                  HalfSpace, Polyhedron, Ellipsoid, EllipticCylinder, EllipticCone,
                                  Tgc, Torus, Paraboloid, Hyperboloid, TwoSheetHyperboloid, Quadric,
                                  Algebraic, Superellipsoid, Prism, Lathe, Blob, HeightField>;

/// Any one analytic shape by value: the variant, but copied, moved and destroyed by functions that
/// are compiled once, not in every file that has parts.
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
