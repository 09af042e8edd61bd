#pragma once
/// Common parts of the methods: the patches whose boxes a line meets, and their numerators in the
/// two planes through the line.
///
/// Source: Kajiya, "Ray Tracing Parametric Patches", SIGGRAPH 1982 (a ray as two planes).
/// Conventions: internal to the methods.

#include "alhazen/geometry/box.h"
#include "alhazen/shapes/patches/methods/patch_method.h"
#include "alhazen/shapes/patches/patch_borders.h"

namespace alhazen {

/// The query of a method: the line with its planes and its range, and the list of crossings.
class PatchQuestion {
  public:
    PatchQuestion(const Ray& ray, std::vector<PatchCrossing>& out, PatchMethodCounts& counts);

    const Ray& ray;
    PatchMethodCounts& counts;
    PatchLine line;

    /// Reports the point of a patch at (u, v), unless it lies outside of the ray's range.
    void report(const BezierNet& net, std::uint32_t patch, double u, double v);

  private:
    std::vector<PatchCrossing>& out_;
};

class EachPatchMethod : public PatchMethod {
  public:
    explicit EachPatchMethod(std::span<const BezierNet> nets);
    void crossings(const Ray& ray, std::vector<PatchCrossing>& out,
                   PatchMethodCounts& counts) override;

  protected:
    virtual void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) = 0;
    [[nodiscard]] std::span<const BezierNet> nets() const { return nets_; }
    [[nodiscard]] const Box3& box() const { return box_; }

  private:
    std::vector<BezierNet> nets_;
    std::vector<Box3> boxes_;
    Box3 box_;
};

/// True if the line of a ray meets a box grown by `margin`.
[[nodiscard]] bool line_meets(const Box3& box, double margin, const Ray& ray);

/// The two numerators at (u, v), and their derivatives by u and v.
struct PlaneValue {
    PlanePoint f, f_u, f_v;
};
[[nodiscard]] PlaneValue plane_value(const PlaneNet& net, double u, double v);
/// The part over [u0, u1] x [v0, v1], as a net over the unit square.
[[nodiscard]] PlaneNet part_of(const PlaneNet& net, const PatchCell& cell);
/// The least and largest of x and y over the control points.
struct PlaneRange {
    double lo_x, hi_x, lo_y, hi_y;
    [[nodiscard]] bool has_origin(double margin) const {
        return lo_x <= margin && hi_x >= -margin && lo_y <= margin && hi_y >= -margin;
    }
    [[nodiscard]] double size() const;
};
[[nodiscard]] PlaneRange range_of(const PlaneNet& net);

/// True, and appended to `roots`, if no root lies within `same` of (u, v) in both parameters.
[[nodiscard]] bool is_new_root(std::vector<std::pair<double, double>>& roots, double u, double v,
                               double same);

std::unique_ptr<PatchMethod> make_subdivision(std::span<const BezierNet> nets);
std::unique_ptr<PatchMethod> make_kajiya(std::span<const BezierNet> nets);
std::unique_ptr<PatchMethod> make_toth(std::span<const BezierNet> nets);
std::unique_ptr<PatchMethod> make_joy_bhetanabhotla(std::span<const BezierNet> nets);
std::unique_ptr<PatchMethod> make_bezier_clipping(std::span<const BezierNet> nets);
std::unique_ptr<PatchMethod> make_certified_newton(std::span<const BezierNet> nets);

}  // namespace alhazen
