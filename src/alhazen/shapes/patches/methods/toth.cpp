/// `toth`: Newton's method from where Krawczyk's operator proves that it converges, bisection
/// elsewhere.
///
/// Source: Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985; Krawczyk, "Newton-Algorithmen
/// zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4, 1969.
/// Differs: two unknowns, u and v, in the two planes of the line, in place of three with t; ranges
/// of the derivatives are those of their control points over the domain; every crossing is
/// reported.
/// Conventions: without directed rounding. A domain as narrow as 2^-44 that is neither safe nor
/// empty counts as a crossing if its control points surround the line; crossings within 2^-36 in
/// both parameters are merged.
/// Complexity: O(log(1 / distance of two roots)) domains for each.

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/methods/each_patch.h"

namespace alhazen {
namespace {

constexpr double kNarrowest = 0x1p-44;
constexpr double kSameRoot = 0x1p-36;
constexpr int kMostDomains = 4000;

/// Krawczyk's operator for a domain, in half-widths from its middle.
struct KrawczykTest {
    bool regular = false;
    double norm = kInfinity;    ///< norm of I - Y F'
    double middle_u, middle_v;  ///< middle of the image
    double radius_u, radius_v;
};

KrawczykTest krawczyk(const PlaneNet& net) {
    const int n = net.degree_u, m = net.degree_v;
    const auto at = [&](int i, int j) { return net.at[static_cast<std::size_t>(i * (m + 1) + j)]; };
    const PlaneValue mid = plane_value(net, 0.5, 0.5);
    // Derivatives by half-widths.
    const PlanePoint a = 0.5 * mid.f_u, b = 0.5 * mid.f_v;
    const double det = a.x * b.y - a.y * b.x;
    KrawczykTest test{};
    if (!(std::abs(det) > 0.0)) return test;
    const double inverse = 1.0 / det;
    const auto solved = [&](const PlanePoint& p) {
        return PlanePoint{inverse * (p.x * b.y - p.y * b.x), inverse * (a.x * p.y - a.y * p.x)};
    };
    double uu = 0, uv = 0, vu = 0, vv = 0;  // largest of |I - Y F'|
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            if (i < n) {
                const PlanePoint d = solved((0.5 * n) * (at(i + 1, j) - at(i, j)));
                uu = std::max(uu, std::abs(1.0 - d.x));
                vu = std::max(vu, std::abs(d.y));
            }
            if (j < m) {
                const PlanePoint d = solved((0.5 * m) * (at(i, j + 1) - at(i, j)));
                uv = std::max(uv, std::abs(d.x));
                vv = std::max(vv, std::abs(1.0 - d.y));
            }
        }
    }
    const PlanePoint step = solved(mid.f);
    test.regular = true;
    test.radius_u = uu + uv;
    test.radius_v = vu + vv;
    test.norm = std::max(test.radius_u, test.radius_v);
    test.middle_u = -step.x;
    test.middle_v = -step.y;
    return test;
}

class Toth final : public EachPatchMethod {
  public:
    using EachPatchMethod::EachPatchMethod;

  private:
    void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) override {
        const PlaneNet whole = plane_net(net, question.line);
        const double rounding = 1e-14 * range_of(whole).size();
        std::vector<std::pair<double, double>> roots;
        const auto report = [&](double u, double v) {
            if (is_new_root(roots, u, v, kSameRoot)) question.report(net, patch, u, v);
        };
        std::vector<PatchCell> waiting{{0, 1, 0, 1}};
        for (int domains = 0; !waiting.empty() && domains < kMostDomains; ++domains) {
            PatchCell cell = waiting.back();
            waiting.pop_back();
            ++question.counts.steps;
            const PlaneNet part = part_of(whole, cell);
            if (!range_of(part).has_origin(rounding)) continue;
            double half_u = 0.5 * (cell.u1 - cell.u0), half_v = 0.5 * (cell.v1 - cell.v0);
            const double mid_u = cell.u0 + half_u, mid_v = cell.v0 + half_v;
            if (std::max(half_u, half_v) < kNarrowest) {
                report(mid_u, mid_v);
                continue;
            }
            const KrawczykTest test = krawczyk(part);
            if (test.regular) {
                const double lo_u = test.middle_u - test.radius_u,
                             hi_u = test.middle_u + test.radius_u,
                             lo_v = test.middle_v - test.radius_v,
                             hi_v = test.middle_v + test.radius_v;
                if (lo_u > 1.0 || hi_u < -1.0 || lo_v > 1.0 || hi_v < -1.0) continue;
                if (test.norm < 1.0 && lo_u > -1.0 && hi_u < 1.0 && lo_v > -1.0 && hi_v < 1.0) {
                    newton(whole, mid_u + half_u * test.middle_u, mid_v + half_v * test.middle_v,
                           question.counts, report);
                    continue;
                }
                // The remaining domain; halved if it is most of the domain.
                const double left_u = std::min(1.0, hi_u) - std::max(-1.0, lo_u);
                const double left_v = std::min(1.0, hi_v) - std::max(-1.0, lo_v);
                const PatchCell left{
                    mid_u + half_u * std::max(-1.0, lo_u), mid_u + half_u * std::min(1.0, hi_u),
                    mid_v + half_v * std::max(-1.0, lo_v), mid_v + half_v * std::min(1.0, hi_v)};
                cell = left;
                if (left_u * left_v < 2.0) {
                    waiting.push_back(cell);
                    continue;
                }
            }
            ++question.counts.subdivisions;
            const bool along_u = cell.u1 - cell.u0 >= cell.v1 - cell.v0;
            PatchCell other = cell;
            (along_u ? cell.u1 : cell.v1) = (along_u ? other.u0 : other.v0) =
                along_u ? 0.5 * (cell.u0 + cell.u1) : 0.5 * (cell.v0 + cell.v1);
            waiting.push_back(cell);
            waiting.push_back(other);
        }
    }

    template <class Report>
    static void newton(const PlaneNet& net, double u, double v, PatchMethodCounts& counts,
                       const Report& report) {
        for (int step = 0; step < 20; ++step) {
            ++counts.steps;
            const PlaneValue at = plane_value(net, u, v);
            const double det = at.f_u.x * at.f_v.y - at.f_u.y * at.f_v.x;
            if (det == 0.0) break;
            const double du = (at.f.x * at.f_v.y - at.f.y * at.f_v.x) / det;
            const double dv = (at.f_u.x * at.f.y - at.f_u.y * at.f.x) / det;
            u -= du;
            v -= dv;
            if (std::max(std::abs(du), std::abs(dv)) < 0x1p-45) break;
        }
        report(u, v);
    }
};

}  // namespace

std::unique_ptr<PatchMethod> make_toth(std::span<const BezierNet> nets) {
    return std::make_unique<Toth>(nets);
}

}  // namespace alhazen
