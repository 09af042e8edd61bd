/// `bezier_clipping`: clips away parameters outside of the convex hull of distances to a line,
/// alternately in u and v.
///
/// Source: Nishita, Sederberg and Kakimoto, "Ray Tracing Trimmed Rational Surface Patches",
/// SIGGRAPH 1990; Efremov, Havran and Seidel, "Robust and Numerically Stable Bezier Clipping Method
/// for Ray Tracing NURBS Surfaces", SCCG 2005, for the robustness: clipped ranges are grown
/// slightly, only unconverged parameters are clipped, duplicate crossings at the border of two
/// halves are merged, and a converged domain counts only if its control points surround the line.
/// Differs: finds every crossing; halves if a clip leaves more than 80 %, as in the source.
/// Conventions: converged at a width of 2^-38; crossings within 2^-34 in both parameters are
/// merged.
/// Complexity: quadratic convergence at a simple root, halving at a double one.

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/methods/each_patch.h"

namespace alhazen {
namespace {

constexpr double kConverged = 0x1p-38;
constexpr double kSameClip = 0x1p-34;
constexpr double kLeastCut = 0.8;  // fraction above which the domain is halved
constexpr double kGrown = 1e-12;
constexpr int kMostClips = 4000;

struct ParameterRange {
    double lo = 1, hi = 0;
};

/// Range where the convex hull of (k / degree, lo[k]) and (k / degree, hi[k]) meets zero.
ParameterRange hull_at_zero(int degree, const double* lo, const double* hi) {
    ParameterRange range;
    const auto include = [&](double x) { range = {std::min(range.lo, x), std::max(range.hi, x)}; };
    for (int a = 0; a <= degree; ++a) {
        if (lo[a] <= 0.0 && hi[a] >= 0.0) include(double(a) / degree);
        for (int b = 0; b <= degree; ++b) {
            // Lines from each point above at a to each point below at b.
            for (const double above : {lo[a], hi[a]}) {
                for (const double below : {lo[b], hi[b]}) {
                    if (!(above > 0.0 && below < 0.0)) continue;
                    include((a + (b - a) * (above / (above - below))) / degree);
                }
            }
        }
    }
    return range;
}

/// The range of u (or v) in which the patch can meet the line through the origin along the mean
/// direction of the two opposite borders.
ParameterRange clip(const PlaneNet& net, bool along_u) {
    const int n = net.degree_u, m = net.degree_v;
    const auto at = [&](int i, int j) { return net.at[static_cast<std::size_t>(i * (m + 1) + j)]; };
    PlanePoint along = along_u ? (at(0, m) - at(0, 0)) + (at(n, m) - at(n, 0))
                               : (at(n, 0) - at(0, 0)) + (at(n, m) - at(0, m));
    if (along.x == 0.0 && along.y == 0.0) along = {1.0, 0.0};
    const double inverse = 1.0 / std::hypot(along.x, along.y);
    double lo[kMaxPatchOrder], hi[kMaxPatchOrder];
    const int degree = along_u ? n : m;
    std::fill(lo, lo + degree + 1, kInfinity);
    std::fill(hi, hi + degree + 1, -kInfinity);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            const PlanePoint p = at(i, j);
            const double distance = (along.x * p.y - along.y * p.x) * inverse;
            const int k = along_u ? i : j;
            lo[k] = std::min(lo[k], distance);
            hi[k] = std::max(hi[k], distance);
        }
    }
    return hull_at_zero(degree, lo, hi);
}

class BezierClipping final : public EachPatchMethod {
  public:
    using EachPatchMethod::EachPatchMethod;

  private:
    void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) override {
        const PlaneNet whole = plane_net(net, question.line);
        const double rounding = 1e-14 * range_of(whole).size();
        std::vector<std::pair<double, double>> roots;
        std::vector<PatchCell> waiting{{0, 1, 0, 1}};
        int clips = 0;
        while (!waiting.empty() && clips < kMostClips) {
            PatchCell cell = waiting.back();
            waiting.pop_back();
            bool along_u = cell.u1 - cell.u0 >= cell.v1 - cell.v0;
            for (;;) {
                const double width_u = cell.u1 - cell.u0, width_v = cell.v1 - cell.v0;
                const PlaneNet part = part_of(whole, cell);
                if (!range_of(part).has_origin(rounding)) break;
                if (width_u <= kConverged && width_v <= kConverged) {
                    const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
                    if (is_new_root(roots, u, v, kSameClip)) question.report(net, patch, u, v);
                    break;
                }
                if (width_u <= kConverged) along_u = false;
                if (width_v <= kConverged) along_u = true;
                ++clips;
                ParameterRange range = clip(part, along_u);
                if (range.lo > range.hi) break;
                const double width = along_u ? width_u : width_v;
                const double from = along_u ? cell.u0 : cell.v0;
                const double grown = kGrown + 0.25 * kConverged / width;
                range = {std::max(0.0, range.lo - grown), std::min(1.0, range.hi + grown)};
                if (range.hi - range.lo > kLeastCut) {
                    ++question.counts.subdivisions;
                    const bool halve_u = width_v <= kConverged || width_u >= width_v;
                    PatchCell other = cell;
                    (halve_u ? cell.u1 : cell.v1) = (halve_u ? other.u0 : other.v0) =
                        halve_u ? 0.5 * (cell.u0 + cell.u1) : 0.5 * (cell.v0 + cell.v1);
                    waiting.push_back(other);
                    continue;
                }
                (along_u ? cell.u0 : cell.v0) = from + width * range.lo;
                (along_u ? cell.u1 : cell.v1) = from + width * range.hi;
                along_u = !along_u;
            }
        }
        question.counts.steps += static_cast<std::uint64_t>(clips);
    }
};

}  // namespace

std::unique_ptr<PatchMethod> make_bezier_clipping(std::span<const BezierNet> nets) {
    return std::make_unique<BezierClipping>(nets);
}

}  // namespace alhazen
