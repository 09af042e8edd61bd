#pragma once
/// Exact solids as faces: planes, spheres, sides of cylinders and cones, and how they combine.
///
/// Source: Requicha and Voelcker, "Boolean Operations in Solid Modeling: Boundary Evaluation and
/// Merging Algorithms", Proceedings of the IEEE 73, 1985 (neighbourhoods of points on faces decide
/// what is boundary).
/// Differs: around a curve the neighbourhood is a wheel of sectors between the planes that touch
/// the faces through it, so that faces on each other and more than two faces in a curve need no
/// cases. Conventions: world space; a leaf is a convex shape, the common part of the insides of its
/// faces. Complexity: O(faces) for a point.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct SolidFace {
    enum class Kind : std::uint8_t { Plane, Sphere, Side };
    Kind kind = Kind::Plane;
    std::uint32_t leaf = 0;
    /// In the space of the leaf: a point of the plane; the centre; the middle of the base.
    Vec3 at;
    Vec3 axis;            ///< unit: the normal of a plane, the axis of a side
    double radius = 0;    ///< of a sphere; of the side at `at`
    double widening = 0;  ///< of the side, for each unit along the axis
    double height = 0;    ///< of the side

    /// Negative inside; a distance near the face.
    [[nodiscard]] double value(const Vec3& p) const;
    /// Outwards.
    [[nodiscard]] Vec3 gradient(const Vec3& p) const;
};

struct SolidLeaf {
    Affine world, inverse;
    Box3 box;
    double size = 0;                   ///< in its own space
    std::uint32_t first = 0, end = 0;  ///< faces
};

/// What is around a point of a curve.
struct SolidWheel {
    bool surface = false;  ///< the solid ends here
    bool edge = false;     ///< and not smoothly
    Vec3 out, other_out;   ///< unit, out of the faces that meet; of a smooth one both are equal
};

class FacedSolid {
  public:
    /// Nothing where a part has no such faces, or there are more than 400 parts.
    [[nodiscard]] static std::optional<FacedSolid> of(const SceneDescription& description,
                                                      std::size_t object, const Affine& world);

    [[nodiscard]] const std::vector<SolidFace>& faces() const { return faces_; }
    [[nodiscard]] const SolidLeaf& leaf(const SolidFace& face) const { return leaves_[face.leaf]; }
    /// Around the point `p` of a curve along `tangent` that lies in `face`.
    [[nodiscard]] SolidWheel wheel(const Vec3& p, const Vec3& tangent, const SolidFace& face) const;
    /// Outwards, in world space, unit.
    [[nodiscard]] Vec3 normal(const SolidFace& face, const Vec3& p) const;

  private:
    struct Node {
        Combine combine = Combine::Union;
        std::int32_t leaf = -1;
        std::vector<std::uint32_t> children;
    };
    [[nodiscard]] bool add_object(const SceneDescription& d, std::size_t object,
                                  const Affine& world, std::uint32_t& node);
    [[nodiscard]] bool add_leaf(const AnyShape& shape, const Affine& world);
    [[nodiscard]] bool inside(std::uint32_t node, const std::vector<bool>& in_leaf) const;

    std::vector<SolidFace> faces_;
    std::vector<SolidLeaf> leaves_;
    std::vector<Node> nodes_;
    std::uint32_t root_ = 0;
};

}  // namespace alhazen
