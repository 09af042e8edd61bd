#pragma once
/// Spans of a ray inside the solids of a scene, and the solids that contain a point.
///
/// Source: Roth, "Ray Casting for Modeling Solids", CGIP 18, 1982 (spans).
/// Differs: covers a whole scene, solid by solid; solids may overlap.
/// Conventions: all crossings of the whole line, from t = -inf to +inf, are found and paired: the
/// order of the crossings decides which enter and which leave, not the normals. A tangent (two
/// crossings closer than their error bounds) neither begins nor ends a span. The surface of a solid
/// belongs to it.
/// Complexity and threads: a span query is one all-hits query and a sort. Const functions may be
/// called from many threads.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/solids/solid_list.h"

namespace alhazen {

/// The beginning or end of a span.
struct SpanEnd {
    double t = 0;
    /// False: the ray begins or ends here, inside the solid; `hit` is then undefined.
    bool is_crossing = false;
    Hit hit;
};

/// A part of the ray inside a solid: entry.t < exit.t, or both have left the range of double for a
/// very short or long direction (geometry/ray_scale.h).
struct SolidSpan {
    SolidId solid{};
    SpanEnd entry, exit;
};

/// The surface at the end of a span.
struct SpanSurface {
    Vec3 point;
    Vec3 normal;  ///< unit, outward; zero where the ray begins or ends
    Vec3 error;   ///< bound of the point's error; zero where the ray begins or ends
    MaterialId material{0};
};

/// The spans of one ray in order of entry, and scratch memory.
struct SpanList {
    std::vector<SolidSpan> spans;
    /// Solids whose crossings cannot be paired on the line; they have no spans.
    std::vector<SolidId> inconsistent;

    // ---- Scratch.
    std::vector<Hit> hits;
    struct Crossing {
        SolidId solid;
        std::uint32_t hit;
    };
    std::vector<Crossing> crossings;
    std::vector<SolidId> inside_at_start, inside_at_end;  ///< at the ends of the line, sorted
    bool end_is_known = false;
};

/// The spans of a batch, ray after ray.
struct SpanLists {
    std::vector<SolidSpan> spans;
    std::vector<std::size_t> ends;   ///< [ray] end of its spans
    std::uint64_t inconsistent = 0;  ///< pairs of a ray and a solid without spans

    [[nodiscard]] std::span<const SolidSpan> of(std::size_t ray) const {
        const std::size_t begin = ray == 0 ? 0 : ends[ray - 1];
        return std::span(spans).subspan(begin, ends[ray] - begin);
    }
};

/// A solid that contains a point.
struct Containment {
    SolidId solid{};
    /// True if the point lies on the solid's surface, within its error bound.
    bool on_surface = false;
    friend bool operator==(const Containment&, const Containment&) = default;
};

/// Length of a ray inside solids, in scene units.
struct Thickness {
    struct OfSolid {
        SolidId solid{};
        double length = 0;
    };
    double inside_any = 0;          ///< overlaps counted once
    std::vector<OfSolid> of_solid;  ///< by number; only solids that the ray intersects
};

class SolidQueries {
  public:
    explicit SolidQueries(std::shared_ptr<const Aggregate> scene) : solids_(std::move(scene)) {}

    [[nodiscard]] const SolidList& solids() const { return solids_; }

    /// Replaces the list by the spans of the ray in [t_min, t_max]. A span that contains an end of
    /// the ray is clipped there and marked. An invalid ray has none. Directions may have any length
    /// in the range of double (geometry/ray_scale.h).
    void spans(const Ray& ray, SpanList& list) const;
    /// Point, normal and material at the ends of a span of this ray. The normal points against the
    /// ray at the entry and along it at the exit.
    [[nodiscard]] SpanSurface entry_surface(const Ray& ray, const SolidSpan& span) const;
    [[nodiscard]] SpanSurface exit_surface(const Ray& ray, const SolidSpan& span) const;
    /// The lengths of the ray inside solids. Does not throw; an invalid ray has zero thickness.
    [[nodiscard]] Thickness thickness(const Ray& ray, SpanList& scratch) const;

    /// The solids that contain the point, by number. Four lines through it, near the diagonals of a
    /// cube, count the crossings on either side. If they disagree (a grazing ray, a damaged mesh),
    /// the majority of up to twelve lines decides. On a face, edge or corner of an axis-parallel
    /// box, and on any smooth surface, `on_surface` is certain; on a sharp edge of another solid
    /// the point may also be reported as outside. A non-finite point is in no solid.
    [[nodiscard]] std::vector<Containment> inside(const Vec3& point) const;

    // ---- Batches, over all threads.
    void spans(std::span<const Ray> rays, SpanLists& lists) const;
    [[nodiscard]] std::vector<std::vector<Containment>> inside(std::span<const Vec3> points) const;
    [[nodiscard]] std::vector<Thickness> thickness(std::span<const Ray> rays) const;

  private:
    [[nodiscard]] SpanSurface surface(const Ray& ray, const SpanEnd& end, double side) const;

    SolidList solids_;
};

}  // namespace alhazen
