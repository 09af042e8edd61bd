#pragma once
/// The parts of a curve of a solid that are edges or outlines.
///
/// Source: solid_faces.h (the wheel of solid around a point). Conventions: at 256 points of a curve
/// it is told what is there; between two that differ the place is found by halving. What is closed
/// begins where something changes. The same part of a curve is kept once.

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "alhazen/session/technical/feature_curves.h"
#include "alhazen/session/technical/solid_faces.h"

namespace alhazen {

/// A curve in which two faces may meet, or a face may turn away.
struct SolidCurve {
    const SolidFace* face = nullptr;  ///< one of those that it lies in
    bool outline = false;
    bool has_form = false;  ///< else `at` alone
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

    /// Finds the parts of a curve.
    void add(const SolidCurve& given);
    /// The same for a line within a box, a little larger.
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
    /// Lines between points of a curve.
    void divide(const SolidCurve& curve, FeatureCurve& result, const Point& a, const Point& b,
                int depth);
    /// Directions that change as a + cos(t) b + sin(t) c, from three points.
    void set_normals(const SolidCurve& curve, FeatureCurve& result) const;
    /// Whether the same part of a curve was found before, as one of other faces.
    bool is_known(const SolidCurve& curve, double from, double middle, double to);

    const FacedSolid& solid_;
    BeamApex eye_;
    std::vector<FeatureCurve> curves_;
    std::vector<std::array<Vec3, 3>> known_;  ///< ends and middles
};

}  // namespace alhazen
