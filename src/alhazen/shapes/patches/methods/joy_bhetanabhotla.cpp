/// `joy_bhetanabhotla`: minimises the distance of a point of the patch from the line by a
/// quasi-Newton method, starting at the crossings of the previous ray, or else in parts whose boxes
/// are met.
///
/// Source: Joy and Bhetanabhotla, "Ray Tracing Parametric Surface Patches Utilizing Numerical
/// Techniques and Ray Coherence", SIGGRAPH 1986; the update: Broyden, Fletcher, Goldfarb and
/// Shanno, 1970.
/// Differs: the parts are a uniform grid of kParts x kParts, tried once each; the first estimate of
/// the inverse Hessian is diagonal.
/// Conventions: coherence as in the source: if every crossing of the previous ray with the patch
/// leads to a crossing of this ray, no others are sought. A minimum is a crossing below 1e-9 of the
/// patch's size in the plane of the line. Crossings within 2^-22 in both parameters are merged.
/// Complexity: about ten steps for each start.

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/patches/methods/each_patch.h"

namespace alhazen {
namespace {

constexpr int kParts = 4;
constexpr int kMostQuasiSteps = 60;
constexpr double kZeroDistance = 1e-9;
constexpr double kSameMinimum = 0x1p-22;

/// Half the squared distance in the plane of the line, with its gradient.
struct SquaredDistance {
    double value, by_u, by_v;
};

SquaredDistance squared_distance(const PlaneNet& net, double u, double v, double* curvature) {
    const PlaneValue at = plane_value(net, u, v);
    if (curvature != nullptr) {
        curvature[0] = at.f_u.x * at.f_u.x + at.f_u.y * at.f_u.y;
        curvature[1] = at.f_v.x * at.f_v.x + at.f_v.y * at.f_v.y;
    }
    return {0.5 * (at.f.x * at.f.x + at.f.y * at.f.y), at.f.x * at.f_u.x + at.f.y * at.f_u.y,
            at.f.x * at.f_v.x + at.f.y * at.f_v.y};
}

using ParameterPair = std::pair<double, double>;

/// Minimises from (u, v); true if the minimum is on the line and inside the patch.
bool minimised(const PlaneNet& net, double zero, double& u, double& v, std::uint64_t& steps) {
    double curvature[2];
    SquaredDistance now = squared_distance(net, u, v, curvature);
    const double tiny = 1e-300;
    // Estimate of the inverse Hessian.
    double h_uu = 1.0 / (curvature[0] + tiny), h_uv = 0, h_vv = 1.0 / (curvature[1] + tiny);
    for (int step = 0; step < kMostQuasiSteps; ++step) {
        ++steps;
        double du = -(h_uu * now.by_u + h_uv * now.by_v);
        double dv = -(h_uv * now.by_u + h_vv * now.by_v);
        const double far = std::max(std::abs(du), std::abs(dv));
        if (!(far > 1e-16)) break;
        if (far > 0.25) du *= 0.25 / far, dv *= 0.25 / far;
        const double fall = du * now.by_u + dv * now.by_v;
        if (!(fall < 0.0)) break;
        double scale = 1.0;
        SquaredDistance next{};
        for (int half = 0; half < 30; ++half, scale *= 0.5) {
            next = squared_distance(net, u + scale * du, v + scale * dv, nullptr);
            if (next.value <= now.value + 1e-4 * scale * fall) break;
        }
        if (!(next.value < now.value)) break;
        const double s_u = scale * du, s_v = scale * dv;
        const double y_u = next.by_u - now.by_u, y_v = next.by_v - now.by_v;
        const double along = s_u * y_u + s_v * y_v;
        u += s_u;
        v += s_v;
        now = next;
        if (u < -0.25 || u > 1.25 || v < -0.25 || v > 1.25) return false;
        if (!(along > 0.0)) continue;
        const double hy_u = h_uu * y_u + h_uv * y_v, hy_v = h_uv * y_u + h_vv * y_v;
        const double both = (along + y_u * hy_u + y_v * hy_v) / (along * along);
        h_uu += both * s_u * s_u - 2.0 * hy_u * s_u / along;
        h_uv += both * s_u * s_v - (hy_u * s_v + s_u * hy_v) / along;
        h_vv += both * s_v * s_v - 2.0 * hy_v * s_v / along;
    }
    const auto within = [](double t) { return t >= -1e-12 && t <= 1.0 + 1e-12; };
    return std::sqrt(2.0 * now.value) <= zero && within(u) && within(v);
}

class JoyBhetanabhotla final : public EachPatchMethod {
  public:
    explicit JoyBhetanabhotla(std::span<const BezierNet> all) : EachPatchMethod(all) {
        before_.resize(all.size());
        for (const BezierNet& net : all) {
            for (int i = 0; i < kParts; ++i) {
                for (int j = 0; j < kParts; ++j) {
                    constexpr double kSide = 1.0 / kParts;
                    parts_.push_back(control_box(
                        part_of(net, i * kSide, (i + 1) * kSide, j * kSide, (j + 1) * kSide)));
                }
            }
        }
    }

  private:
    void meet(const BezierNet& net, std::uint32_t patch, PatchQuestion& question) override {
        const PlaneNet plane = plane_net(net, question.line);
        const PlaneRange range = range_of(plane);
        const double zero =
            kZeroDistance * std::max(range.hi_x - range.lo_x, range.hi_y - range.lo_y);
        std::vector<ParameterPair> roots;
        const auto start = [&](double u, double v) {
            return minimised(plane, zero, u, v, question.counts.steps) &&
                   is_new_root(roots, u, v, kSameMinimum);
        };
        std::vector<ParameterPair>& before = before_[patch];
        const bool all_again =
            !before.empty() && std::all_of(before.begin(), before.end(), [&](const auto& at) {
                return start(at.first, at.second);
            });
        if (!all_again) {
            for (int k = 0; k < kParts * kParts; ++k) {
                const auto part =
                    static_cast<std::size_t>(patch) * kParts * kParts + static_cast<std::size_t>(k);
                if (!line_meets(parts_[part], 0.0, question.ray)) continue;
                ++question.counts.subdivisions;
                (void)start((k / kParts + 0.5) / kParts, (k % kParts + 0.5) / kParts);
            }
        }
        for (const auto& [u, v] : roots) question.report(net, patch, u, v);
        before = std::move(roots);
    }

    std::vector<Box3> parts_;                         // [patch][kParts * kParts]
    std::vector<std::vector<ParameterPair>> before_;  // [patch]: roots of the previous ray
};

}  // namespace

std::unique_ptr<PatchMethod> make_joy_bhetanabhotla(std::span<const BezierNet> nets) {
    return std::make_unique<JoyBhetanabhotla>(nets);
}

}  // namespace alhazen
