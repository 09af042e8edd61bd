#pragma once
/// What every evaluator of a solid starts from: its leaves as primitives of a table, its expression
/// in both forms, and all crossings of a line with one leaf.
///
/// Conventions: a leaf's crossings come from the one test of `PrimitiveTable` on the whole line,
/// whatever the range of the ray, so their t are the same bits in every evaluator. Between two
/// crossings in a row a line is inside and outside in turn.
///
/// Crossings of several leaves closer than `tau` are one: the solid is what it is before the first
/// and after the last of them. So faces that coincide leave neither slivers nor inner walls, and
/// what is thinner than tau along the ray is not there (regularised sets; Requicha and Voelcker,
/// "Boolean Operations in Solid Modeling", Proc. IEEE 73(1), 1985). The crossing that is reported
/// is that of the leaf with the lowest number whose own change, and that of all nodes above it,
/// makes the change of the solid.

#include <limits>
#include <vector>

#include "alhazen/csg/csg_tree.h"
#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// A crossing of a line with a leaf.
struct CsgCrossing {
    double t, u, v;
    /// As in ShapeHit; for an instance the position of its hit in the list of such.
    std::uint32_t part;
    std::uint32_t leaf;
};

/// A ray as evaluators take it.
struct CsgRay {
    Ray line;             ///< for all t
    double t_min, t_max;  ///< of the ray
    double pad;           ///< bound of how far from the line a computed crossing can be
    double tau;           ///< crossings closer than this are one
    RayMask mask;         ///< a leaf that it does not see is as if it were empty
};

class CsgSolid {
  public:
    /// `table` must be finished. Throws Error (Resource) for too many leaves.
    CsgSolid(PrimitiveTable table, CsgExpression expression);

    [[nodiscard]] const PrimitiveTable& table() const { return table_; }
    [[nodiscard]] const CsgExpression& expression() const { return expression_; }
    [[nodiscard]] const CsgTree& tree() const { return tree_; }
    [[nodiscard]] std::uint32_t leaf_count() const {
        return static_cast<std::uint32_t>(expression_.leaves.size());
    }
    [[nodiscard]] Box3 leaf_box(std::uint32_t leaf) const {
        return table_.box(static_cast<std::size_t>(expression_.leaves[leaf]));
    }
    [[nodiscard]] CsgRay prepare(const Ray& ray, RayMask mask = kAllRays) const;
    // ---- what `prepare` makes tau of: kTolerance (size + distance of the origin from the center)
    /// What the tests of primitives may be wrong by, as a part of the distances in play.
    static constexpr double kTolerance = 0x1p-38;
    [[nodiscard]] const Vec3& center() const { return center_; }
    [[nodiscard]] double size() const { return half_ + offset_; }
    /// Distance within which surfaces count as coincident, seen from as far as the solid is large.
    [[nodiscard]] double tolerance() const { return kTolerance * (2.0 * half_ + offset_); }

    /// What fills a leaf: the number of a material that lets light through, or one of these.
    static constexpr std::uint32_t kNoMedium = 0xFFFFFFFFu;
    static constexpr std::uint32_t kOpaque = 0xFFFFFFFEu;
    static constexpr std::uint32_t kMixture = 0xFFFFFFFDu;  ///< a shared solid of several media
    /// True when operands are filled by different media and some let light through: then the wall
    /// between two media is a transition too, from one and into the other.
    [[nodiscard]] bool has_media() const { return has_media_; }
    /// Of a leaf; CsgTree::kNone, for no leaf, is kNoMedium.
    [[nodiscard]] std::uint32_t medium(std::uint32_t leaf) const {
        return leaf == CsgTree::kNone ? kNoMedium : media_[leaf];
    }
    /// The one medium of the whole solid, or kMixture.
    [[nodiscard]] std::uint32_t only_medium() const { return only_medium_; }
    /// The material of a leaf; of a shared solid that of its first leaf.
    [[nodiscard]] MaterialId material(std::uint32_t leaf) const { return materials_[leaf]; }

    /// Appends all crossings of the line with the leaf, ascending; those of instances also to
    /// `hits`. True when the line begins inside.
    bool cross(std::uint32_t leaf, const CsgRay& ray, std::vector<CsgCrossing>& crossings,
               std::vector<Hit>& hits, TraversalStats* stats) const;
    /// The hit that a crossing is.
    void fill(const CsgCrossing& crossing, const std::vector<Hit>& hits, Hit& hit) const;

    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    /// The pad is larger than tau: what lies within tau of a bound is seen from inside it.
    static constexpr double kPadPerTolerance = 4.0;

    void find_media();
    /// max_component of what is no NaN, without a call.
    [[nodiscard]] static double largest(const Vec3& v) {
        const double xy = v.x > v.y ? v.x : v.y;
        return xy > v.z ? xy : v.z;
    }

    PrimitiveTable table_;
    CsgExpression expression_;
    CsgTree tree_;
    std::vector<MaterialId> materials_;  ///< [leaf]
    std::vector<std::uint32_t> media_;   ///< [leaf]
    std::uint32_t only_medium_ = kOpaque;
    bool has_media_ = false;
    bool unbounded_ = false;                     ///< some leaf is
    std::vector<const SolidAggregate*> solids_;  ///< [instance of the table] null for a mesh
    Vec3 center_;
    double half_ = 1.0;    ///< half the size of the solid
    double offset_ = 0.0;  ///< what the distance of its center from the origin adds
};

inline CsgRay CsgSolid::prepare(const Ray& ray, RayMask mask) const {
    const double distance = largest(abs(ray.origin - center_));
    const double tolerance = kTolerance * (half_ + offset_ + distance);
    return {.line = {ray.origin, ray.direction, -kInfinity, kInfinity},
            .t_min = ray.t_min,
            .t_max = ray.t_max,
            .pad = kPadPerTolerance * tolerance,
            .tau = tolerance / largest(abs(ray.direction)),
            .mask = mask};
}

}  // namespace alhazen
