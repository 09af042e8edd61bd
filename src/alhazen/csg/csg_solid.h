#pragma once
/// The data of a solid that all evaluators share: its leaves as primitives of a table, its
/// expression in both forms, and all crossings of a line with one leaf.
///
/// Conventions: a leaf's crossings come from the ray test of `PrimitiveTable` on the whole line,
/// independent of the range of the ray, so their t are bit-identical in every evaluator. Between
/// successive crossings a line is alternately inside and outside.
///
/// Crossings of several leaves closer than `tau` count as one transition: from the state before the
/// first to the state after the last of them. Coincident faces therefore leave neither slivers nor
/// inner surfaces, and parts thinner than tau along the ray vanish (regularised sets; Requicha and
/// Voelcker, "Boolean Operations in Solid Modeling", Proc. IEEE 73(1), 1985). The reported crossing
/// is that of the lowest-numbered leaf whose own change, with that of all nodes above it, makes the
/// change of the solid.

#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "alhazen/csg/csg_tree.h"
#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// A crossing of a line with a leaf.
struct CsgCrossing {
    double t, u, v;
    /// ShapeHit::part; for an instance, the index of its hit in the list of hits.
    std::uint32_t part;
    std::uint32_t leaf;
};

/// A ray prepared for evaluators.
struct CsgRay {
    Ray line;             ///< t unbounded
    double t_min, t_max;  ///< limits of the ray
    double pad;           ///< bound of the distance of a computed crossing from the line
    double tau;           ///< crossings closer than this count as one
    RayMask mask;         ///< leaves that it does not see count as empty
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
    /// tau is kTolerance (size + distance of the origin from the center). kTolerance is the error
    /// bound of the primitives' tests relative to the distances involved.
    static constexpr double kTolerance = 0x1p-38;
    [[nodiscard]] const Vec3& center() const { return center_; }
    [[nodiscard]] double size() const { return half_ + offset_; }
    /// Distance within which surfaces count as coincident for origins at a distance of the solid's
    /// size.
    [[nodiscard]] double tolerance() const { return kTolerance * (2.0 * half_ + offset_); }

    /// The medium of a leaf: the number of a transparent material, or one of these constants.
    static constexpr std::uint32_t kNoMedium = 0xFFFFFFFFu;
    static constexpr std::uint32_t kOpaque = 0xFFFFFFFEu;
    static constexpr std::uint32_t kMixture = 0xFFFFFFFDu;  ///< an instanced solid of several media
    [[nodiscard]] bool is_transparent(MaterialId material) const {
        return table_.material_opacity[static_cast<std::size_t>(material)] == Opacity::Transparent;
    }
    /// True if light enters volumes of the material.
    [[nodiscard]] bool is_clear(MaterialId material) const {
        const std::vector<bool>& clear = expression_.clear;
        return clear.empty() ? is_transparent(material) : clear[static_cast<std::size_t>(material)];
    }
    /// True if operands have different media, some of them transparent. A boundary between two
    /// media is then also a transition, out of one and into the other.
    [[nodiscard]] bool has_media() const { return has_media_; }
    /// The medium of a leaf; kNoMedium for CsgTree::kNone.
    [[nodiscard]] std::uint32_t medium(std::uint32_t leaf) const {
        return leaf == CsgTree::kNone ? kNoMedium : media_[leaf];
    }
    /// The only medium of the solid, or kMixture.
    [[nodiscard]] std::uint32_t only_medium() const { return only_medium_; }
    /// True if the leaf is subtracted from a solid of one clear medium and has a surface of another
    /// clear material: that surface bounds a volume of `only_medium`.
    [[nodiscard]] bool cuts_walls(std::uint32_t leaf) const { return cuts_[leaf]; }
    /// The materials of those surfaces.
    [[nodiscard]] const std::set<MaterialId>& wall_materials() const { return wall_materials_; }
    /// The material of a leaf; for an instanced solid that of its first leaf.
    [[nodiscard]] MaterialId material(std::uint32_t leaf) const { return materials_[leaf]; }

    /// Appends all crossings of the line with the leaf, ascending; those of instances also to
    /// `hits`. Returns true if the line starts inside.
    bool cross(std::uint32_t leaf, const CsgRay& ray, std::vector<CsgCrossing>& crossings,
               std::vector<Hit>& hits, TraversalStats* stats) const;
    /// Converts a crossing to a hit.
    void fill(const CsgCrossing& crossing, const std::vector<Hit>& hits, Hit& hit) const;

    [[nodiscard]] std::size_t memory_bytes() const;

  private:
    /// The pad is this multiple of tau: points within tau of a bound are inside the padded bound.
    static constexpr double kPadPerTolerance = 4.0;

    void find_media();
    void find_walls();
    void find_remembered();
    /// All crossings of the line with a shape.
    void intersect(std::uint32_t leaf, const Ray& line, ShapeHits& found) const;
    /// max_component, inline. Precondition: no NaN.
    [[nodiscard]] static double largest(const Vec3& v) {
        const double xy = v.x > v.y ? v.x : v.y;
        return xy > v.z ? xy : v.z;
    }

    PrimitiveTable table_;
    CsgExpression expression_;
    CsgTree tree_;
    std::vector<MaterialId> materials_;  ///< [leaf]
    std::vector<std::uint32_t> media_;   ///< [leaf]
    std::vector<bool> cuts_;             ///< [leaf] cuts_walls
    std::set<MaterialId> wall_materials_;
    std::vector<bool> remembered_;  ///< [leaf] true if CrossingMemo keeps its crossings
    std::uint64_t number_;          ///< from CrossingMemo::number_of_solid
    std::uint32_t only_medium_ = kOpaque;
    bool has_media_ = false;
    bool unbounded_ = false;                     ///< some leaf is unbounded
    std::vector<const SolidAggregate*> solids_;  ///< [instance of the table] null for a mesh
    Vec3 center_;
    double half_ = 1.0;    ///< half the size of the solid
    double offset_ = 0.0;  ///< term for the distance of the center from the origin
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
