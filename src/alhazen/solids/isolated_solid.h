#pragma once
/// A solid of a scene, or the intersection of several, that lines cross without the rest of the
/// scene.
///
/// Conventions: world space; a line runs from t = -inf to +inf, regardless of the limits of its
/// ray.
/// Threads: const functions may be called from many threads, each with its own LineSpans.

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "alhazen/math/interval.h"
#include "alhazen/solids/solid_list.h"

namespace alhazen {

/// The parts of a line inside a solid.
struct LineSpans {
    std::vector<Interval> spans;  ///< ascending, each of positive length
    /// Sum of |cosine of the angle between line and normal| over the crossings.
    double cosines = 0;
    bool consistent = true;  ///< false: crossings are not paired; there are no spans

    // ---- Scratch.
    std::vector<Hit> hits;
    std::vector<Interval> others;
};

/// The interface of bodies that lines measure.
class Measurable {
  public:
    virtual ~Measurable() = default;
    [[nodiscard]] virtual Box3 box() const = 0;
    /// Range of dot(axis, p), rounded outward.
    [[nodiscard]] virtual Interval extent(const Vec3& axis) const = 0;
    /// Appends the ranges of dot(axis, p) of parts that together contain the surface, in the same
    /// order for every axis. Default: the whole.
    virtual void part_extents(const Vec3& axis, std::vector<Interval>& parts) const {
        parts.push_back(extent(axis));
    }
    /// Bound of the numbers that crossings are computed from; it scales the rounding error of
    /// surface points. Default: the largest coordinate of the box.
    [[nodiscard]] virtual double magnitude() const;
    /// Finds the spans of a line. `want_cosines`: also computes `cosines`.
    virtual void cross(const Ray& line, bool want_cosines, LineSpans& found) const = 0;
};

class IsolatedSolid final : public Measurable {
  public:
    /// Precondition: `id` is a solid of the list. A mesh that shares its tree with other primitives
    /// gets its own tree.
    IsolatedSolid(const SolidList& solids, SolidId id);

    [[nodiscard]] Box3 box() const override { return box_; }
    [[nodiscard]] Interval extent(const Vec3& axis) const override;
    /// The primitives; for a CSG object its positive leaves, within their S-bounds (csg_tree.h).
    void part_extents(const Vec3& axis, std::vector<Interval>& parts) const override;
    /// A leaf.
    struct SurfacePart {
        std::array<Vec3, 3> axes;  ///< perpendicular unit vectors along which it is thin or long
        Box3 own;                  ///< its ranges along `axes`
        Box3 box;                  ///< within its S-bound
    };
    /// Parts that together contain the surface: the leaves of a CSG object, also subtracted ones
    /// and those of solids that it instances; other solids are one part.
    [[nodiscard]] std::vector<SurfacePart> surface_parts() const;
    /// Includes the frame of the solid, for a CSG object its parts, and the reach of patches.
    [[nodiscard]] double magnitude() const override;
    void cross(const Ray& line, bool want_cosines, LineSpans& found) const override;

    /// A crossing: the point on the surface, the bound of its error, the outward normal, and for a
    /// CSG object the material there.
    struct SurfacePoint {
        double t = 0;
        Vec3 point, normal, error;
        MaterialId material{0};
    };
    /// Appends all crossings of the ray between its limits. `hits`: also the hits, in the frame of
    /// `aggregate`.
    void crossings(const Ray& ray, std::vector<SurfacePoint>& found,
                   std::vector<Hit>* hits = nullptr) const;

    /// Appends the hits of those crossings alone, in less time.
    void hits(const Ray& ray, std::vector<Hit>& found) const;

    /// Texture coordinates of the surface of a hit, at the point that the surface has for a given
    /// one, and the derivatives of that point.
    struct Coordinates {
        Vec2 uv;
        Vec3 point, dpdu, dpdv;
    };
    /// `near`: a point near the surface; `hit`: any hit of that surface, whose parameters count
    /// where the shape does not project the point.
    [[nodiscard]] Coordinates coordinates(const Vec3& near, const Hit& hit) const;

    [[nodiscard]] const SolidPlace& place() const { return place_; }
    /// The aggregate of the solid alone, in its own frame.
    [[nodiscard]] const Aggregate& aggregate() const { return *aggregate_; }
    /// The frame of `aggregate`.
    [[nodiscard]] const Placement& placement() const { return world_; }

  private:
    SolidPlace place_;
    std::shared_ptr<const Aggregate> aggregate_;
    bool has_walls_ = false;  ///< surfaces between media inside the solid exist
    const SolidAggregate* csg_ = nullptr;
    Placement world_;
    Box3 box_;
};

/// The intersection of two solids.
class Overlap final : public Measurable {
  public:
    /// Both solids must outlive the object.
    Overlap(const IsolatedSolid& a, const IsolatedSolid& b);

    /// Around all pairs of parts whose boxes overlap.
    [[nodiscard]] Box3 box() const override { return box_; }
    [[nodiscard]] Interval extent(const Vec3& axis) const override;
    /// The pairs of parts whose boxes overlap; of many parts, only the whole.
    void part_extents(const Vec3& axis, std::vector<Interval>& parts) const override;
    [[nodiscard]] double magnitude() const override;
    /// Computes no cosines: the area of an intersection is not measured.
    void cross(const Ray& line, bool want_cosines, LineSpans& found) const override;

  private:
    const IsolatedSolid& a_;
    const IsolatedSolid& b_;
    /// Parts by their place in `part_extents` of both solids; empty: the whole.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
    Box3 box_;
};

}  // namespace alhazen
