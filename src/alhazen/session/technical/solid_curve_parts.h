#pragma once
/// The parts of a curve of a solid that are edges or outlines.
///
/// Source: solid_faces.h (neighbourhoods of points). Conventions: the neighbourhoods of 256 points
/// of a curve are classified; between two that differ, bisection finds the change. Closed curves
/// begin at a change. Equal parts of several curves are kept once.

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "alhazen/session/technical/feature_curves.h"
#include "alhazen/session/technical/solid_faces.h"

namespace alhazen {

/// A curve in which two faces may meet, or which may be the outline of a face.
struct SolidCurve {
    const SolidFace* face = nullptr;  ///< one of the faces that contain it
    bool outline = false;
    bool has_form = false;  ///< true: `form` gives the points; false: `traced`
    bool round = false;
    CurveForm form;
    std::function<std::optional<Vec3>(double)> traced;
    double from = 0, to = 1;

    [[nodiscard]] std::optional<Vec3> at(double t) const {
        if (!has_form) return traced(t);
        if (!round) return form.origin + t * form.u;
        return form.origin + std::cos(t) * form.u + std::sin(t) * form.v;
    }
};

class SolidCurveParts {
  public:
    static constexpr int kSamples = 256;

    SolidCurveParts(const FacedSolid& solid, const BeamApex& eye) : solid_(solid), eye_(eye) {}

    /// Adds the parts of a curve.
    void add(const SolidCurve& given);
    /// Adds the parts of a line inside a slightly enlarged box.
    void add_within(SolidCurve line, const Box3& box);
    [[nodiscard]] std::vector<FeatureCurve> take() { return std::move(curves_); }

  private:
    struct Here {
        int state = 0;  ///< 0: nothing; 1: a crease; 2: a silhouette
        Vec3 out, other_out;
    };
    struct Point {
        double t;
        Vec3 p;
    };
    [[nodiscard]] Here here(const SolidCurve& curve, double t) const;
    void emit(const SolidCurve& curve, int state, double from, double to);
    /// Approximates a stretch of a curve by lines between its points.
    void divide(const SolidCurve& curve, FeatureCurve& result, const Point& a, const Point& b,
                int depth);
    /// Fits normals of the form a + cos(t) b + sin(t) c to three points of a curve.
    void set_normals(const SolidCurve& curve, FeatureCurve& result) const;
    /// True if the same part was found before as a curve of other faces.
    bool is_known(const SolidCurve& curve, double from, double middle, double to);

    const FacedSolid& solid_;
    BeamApex eye_;
    std::vector<FeatureCurve> curves_;
    std::vector<std::array<Vec3, 3>> known_;  ///< ends and middles of the parts found
};

}  // namespace alhazen
