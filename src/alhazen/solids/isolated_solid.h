#pragma once
/// One solid taken out of its scene, or what several share: lines cross it without asking anything
/// else of the scene.
///
/// Conventions: world space; a line is a ray from t = -inf to +inf whatever its limits say.
/// Complexity and threads: const functions may be called from many threads, each with its own
/// LineSpans.

#include <memory>
#include <vector>

#include "alhazen/math/interval.h"
#include "alhazen/solids/solid_list.h"

namespace alhazen {

/// The parts of a line inside of a solid.
struct LineSpans {
    std::vector<Interval> spans;  ///< ascending, each of some length
    /// Sum of |cosine of the angle between line and normal| over the crossings.
    double cosines = 0;
    bool consistent = true;  ///< false: the crossings did not come in pairs, and there are no spans

    // ---- scratch
    std::vector<Hit> hits;
    std::vector<Interval> others;
};

/// What a line can be measured in.
class Measurable {
  public:
    virtual ~Measurable() = default;
    [[nodiscard]] virtual Box3 box() const = 0;
    /// Range of dot(axis, p), rounded outward.
    [[nodiscard]] virtual Interval extent(const Vec3& axis) const = 0;
    /// `want_cosines`: also the normals are asked for.
    virtual void cross(const Ray& line, bool want_cosines, LineSpans& found) const = 0;
};

class IsolatedSolid final : public Measurable {
  public:
    /// Precondition: `id` is a solid of the list. A mesh that shares its tree with other things
    /// gets one of its own.
    IsolatedSolid(const SolidList& solids, SolidId id);

    [[nodiscard]] Box3 box() const override { return box_; }
    [[nodiscard]] Interval extent(const Vec3& axis) const override;
    void cross(const Ray& line, bool want_cosines, LineSpans& found) const override;

    /// A crossing: the point on the surface with the bound of its error, and the outward normal.
    struct SurfacePoint {
        double t = 0;
        Vec3 point, normal, error;
    };
    /// Appends all crossings of the ray between its limits.
    void crossings(const Ray& ray, std::vector<SurfacePoint>& found) const;

    [[nodiscard]] const SolidPlace& place() const { return place_; }
    /// What holds the solid alone, in its own frame.
    [[nodiscard]] const Aggregate& aggregate() const { return *aggregate_; }
    /// The frame of `aggregate`.
    [[nodiscard]] const Placement& placement() const { return world_; }

  private:
    SolidPlace place_;
    std::shared_ptr<const Aggregate> aggregate_;
    bool has_walls_ = false;  ///< between media inside of it
    const SolidAggregate* csg_ = nullptr;
    Placement world_;
    Box3 box_;
};

/// What two solids share.
class Overlap final : public Measurable {
  public:
    /// Both must outlive it.
    Overlap(const IsolatedSolid& a, const IsolatedSolid& b) : a_(a), b_(b) {}

    [[nodiscard]] Box3 box() const override;
    [[nodiscard]] Interval extent(const Vec3& axis) const override;
    /// Has no cosines: its surface is not asked for.
    void cross(const Ray& line, bool want_cosines, LineSpans& found) const override;

  private:
    const IsolatedSolid& a_;
    const IsolatedSolid& b_;
};

}  // namespace alhazen
