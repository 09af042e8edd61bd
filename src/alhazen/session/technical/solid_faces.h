#pragma once
/// Exact solids as faces (planes, spheres, sides of cylinders and cones) and a CSG tree.
///
/// Source: Requicha and Voelcker, "Boolean Operations in Solid Modeling: Boundary Evaluation and
/// Merging Algorithms", Proceedings of the IEEE 73, 1985 (neighbourhoods of points on faces decide
/// what is boundary).
/// Differs: the neighbourhood of a point of a curve is a set of sectors around the curve, bounded
/// by the tangent planes of the faces through the point. Coincident faces and curves of more than
/// two faces need no special cases.
/// Conventions: world space; a leaf is a convex shape, the intersection of the insides of its
/// faces.
/// Complexity: O(faces) per point.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct SolidFace {
    enum class Kind : std::uint8_t { Plane, Sphere, Side };
    Kind kind = Kind::Plane;
    std::uint32_t leaf = 0;
    /// In leaf space: a point of the plane; the centre; the middle of the base.
    Vec3 at;
    Vec3 axis;            ///< unit: the normal of a plane, the axis of a side
    double radius = 0;    ///< of a sphere; of a side at `at`
    double widening = 0;  ///< of a side: increase of the radius per unit of axis
    double height = 0;    ///< of a side

    /// Negative inside; near the face, the distance to it.
    [[nodiscard]] double value(const Vec3& p) const;
    /// The outward gradient of `value`.
    [[nodiscard]] Vec3 gradient(const Vec3& p) const;
};

struct SolidLeaf {
    Affine world, inverse;
    Box3 box;
    double size = 0;                   ///< of its box in leaf space
    std::uint32_t first = 0, end = 0;  ///< range of its faces
};

/// The neighbourhood of a point of a curve.
struct SolidWheel {
    bool surface = false;  ///< the point is on the boundary of the solid
    bool edge = false;     ///< the boundary has an edge at the point
    Vec3 out, other_out;   ///< unit outward normals of the faces that meet; equal if smooth
};

class FacedSolid {
  public:
    /// None if a part has no such faces, or if there are more than 400 parts.
    [[nodiscard]] static std::optional<FacedSolid> of(const SceneDescription& description,
                                                      std::size_t object, const Affine& world);
    /// The union of parts, which are placed in world space.
    [[nodiscard]] static std::optional<FacedSolid> of(const SceneDescription& description,
                                                      std::span<const Part> parts);

    [[nodiscard]] const std::vector<SolidFace>& faces() const { return faces_; }
    [[nodiscard]] const SolidLeaf& leaf(const SolidFace& face) const { return leaves_[face.leaf]; }
    [[nodiscard]] std::size_t leaf_count() const { return leaves_.size(); }
    /// The box of all leaves.
    [[nodiscard]] Box3 box() const;
    /// The neighbourhood of `p` on a curve along `tangent` in `face`.
    [[nodiscard]] SolidWheel wheel(const Vec3& p, const Vec3& tangent, const SolidFace& face) const;
    /// Likewise, of a curve that need not lie in a face.
    [[nodiscard]] SolidWheel wheel(const Vec3& p, const Vec3& tangent) const;
    /// The unit outward normal in world space.
    [[nodiscard]] Vec3 normal(const SolidFace& face, const Vec3& p) const;

  private:
    struct Node {
        Combine combine = Combine::Union;
        std::int32_t leaf = -1;
        std::vector<std::uint32_t> children;
    };
    using Flags = std::vector<std::uint8_t>;  ///< bytes: they are read far more often than made
    [[nodiscard]] bool add_object(const SceneDescription& d, std::size_t object,
                                  const Affine& world, std::uint32_t& node);
    [[nodiscard]] bool add_parts(const SceneDescription& d, Combine combine,
                                 std::span<const Part> parts, const Affine& world,
                                 std::uint32_t& node);
    /// Angles of sectors count around `along` from `x`, perpendicular to it.
    [[nodiscard]] SolidWheel wheel_around(const Vec3& p, const Vec3& along, const Vec3& x) const;
    [[nodiscard]] bool add_leaf(const AnyShape& shape, const Affine& world);
    [[nodiscard]] bool inside(std::uint32_t node, const Flags& in_leaf) const;

    std::vector<SolidFace> faces_;
    std::vector<SolidLeaf> leaves_;
    std::vector<Node> nodes_;
    std::uint32_t root_ = 0;
};

}  // namespace alhazen
