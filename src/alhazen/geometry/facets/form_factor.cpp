#include "alhazen/geometry/facets/form_factor.h"

#include <array>
#include <cmath>
#include <functional>
#include <queue>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

FacetPlane plane_of(std::span<const Vec3> loop) {
    Vec3 normal;
    for (std::size_t k = 2; k < loop.size(); ++k) {
        normal += cross(loop[k - 1] - loop[0], loop[k] - loop[0]);
    }
    const double size = length(normal);
    if (!(size > 0.0)) return {{}, 0.0};
    normal = normal / size;
    return {normal, dot(normal, loop[0])};
}

/// Lambert's sum: for each edge the angle that it subtends, times the component along `normal` of
/// the normal of the plane through point and edge.
double contour_sum(const Vec3& point, const Vec3& normal, std::span<const Vec3> loop) {
    double sum = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 a = loop[k] - point, b = loop[k + 1 == loop.size() ? 0 : k + 1] - point;
        const Vec3 across = cross(a, b);
        const double size = length(across);
        if (size > 0.0) sum += std::atan2(size, dot(a, b)) * dot(across, normal) / size;
    }
    return sum;
}

using Triangle = std::array<Vec3, 3>;

/// Integrates a function over triangles; subdivides the one of the largest error.
class TriangleQuadrature {
  public:
    using Integrand = std::function<double(const Vec3&)>;
    explicit TriangleQuadrature(Integrand f) : f_(std::move(f)) {}

    void add(const Triangle& triangle) { push(triangle, rule(triangle)); }
    /// Subdivides until the sum of errors is below the tolerance.
    void refine(double tolerance, std::uint64_t most_points) {
        while (!waiting_.empty() && error_ > tolerance &&
               points_ + 4 * kPoints * 4 <= most_points) {
            const Leaf worst = waiting_.top();
            waiting_.pop();
            value_ -= worst.value;
            error_ -= worst.error;
            for (std::size_t k = 0; k < 4; ++k) push(worst.quarters[k], worst.quarter_values[k]);
        }
        sum_up();
    }
    [[nodiscard]] double value() const { return value_; }
    [[nodiscard]] double error() const { return error_; }
    [[nodiscard]] std::uint64_t points() const { return points_; }

  private:
    static constexpr std::uint64_t kPoints = 7;
    struct Leaf {
        double value = 0, error = 0;
        std::uint64_t number = 0;
        std::array<Triangle, 4> quarters;
        std::array<double, 4> quarter_values{};
        bool operator<(const Leaf& o) const {
            return error != o.error ? error < o.error : number > o.number;
        }
    };

    void push(const Triangle& t, double coarse) {
        const Vec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
        Leaf leaf;
        leaf.quarters = {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
        for (std::size_t k = 0; k < 4; ++k) {
            leaf.quarter_values[k] = rule(leaf.quarters[k]);
            leaf.value += leaf.quarter_values[k];
        }
        leaf.error = std::abs(leaf.value - coarse);
        leaf.number = pushed_++;
        value_ += leaf.value;
        error_ += leaf.error;
        waiting_.push(leaf);
    }
    double rule(const Triangle& t) {
        const double root = std::sqrt(15.0);
        const double a = (6 - root) / 21, b = (6 + root) / 21;
        const double wa = (155 - root) / 1200, wb = (155 + root) / 1200;
        const Vec3 middle = (1.0 / 3.0) * (t[0] + t[1] + t[2]);
        double sum = 0.225 * f_(middle);
        for (std::size_t k = 0; k < 3; ++k) {
            sum += wa * f_(middle + (1 - 3 * a) * (t[k] - middle));
            sum += wb * f_(middle + (1 - 3 * b) * (t[k] - middle));
        }
        points_ += kPoints;
        return sum * area_of(t);
    }
    /// Sums again, without the rounding errors of repeated addition and subtraction.
    void sum_up() {
        value_ = error_ = 0.0;
        for (; !waiting_.empty(); waiting_.pop()) {
            value_ += waiting_.top().value;
            error_ += waiting_.top().error;
        }
    }

    Integrand f_;
    std::priority_queue<Leaf> waiting_;
    double value_ = 0, error_ = 0;
    std::uint64_t points_ = 0, pushed_ = 0;
};

}  // namespace

double solid_angle(const Vec3& point, std::span<const Vec3> loop) {
    double sum = 0.0;
    for (std::size_t k = 2; k < loop.size(); ++k) {
        const Vec3 a = loop[0] - point, b = loop[k - 1] - point, c = loop[k] - point;
        const double la = length(a), lb = length(b), lc = length(c);
        const double volume = dot(a, cross(b, c));
        const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        sum -= 2.0 * std::atan2(volume, below);
    }
    return sum;
}

double form_factor(const Vec3& point, const Vec3& normal, std::span<const Vec3> loop) {
    std::vector<Vec3> above;
    clip_before({normal, dot(normal, point)}, 0.0, loop, above);
    return above.empty() ? 0.0 : std::abs(contour_sum(point, normal, above)) / (2.0 * kPi);
}

double form_factor(const FacetTree& tree, const Vec3& point, const Vec3& normal,
                   std::span<const Vec3> loop, FacetWalkCounts* counts) {
    std::vector<Vec3> above;
    clip_before({normal, dot(normal, point)}, 0.0, loop, above);
    double sum = 0.0;
    for (const ConvexLoop& part : visible_parts(tree, point, above, counts)) {
        sum += std::abs(contour_sum(point, normal, part));
    }
    return sum / (2.0 * kPi);
}

FormFactor form_factor(const FacetTree& tree, std::span<const Vec3> from, std::span<const Vec3> to,
                       const FormFactorOptions& options) {
    FormFactor result;
    const FacetPlane own = plane_of(from), other = plane_of(to);
    const double area = area_of(from);
    std::vector<Vec3> sees;
    if (area > 0.0 && area_of(to) > 0.0) clip_before(other, 0.0, from, sees);
    if (sees.empty()) return result;
    TriangleQuadrature quadrature(
        [&](const Vec3& p) { return form_factor(tree, p, own.normal, to, &result.walk); });
    for (std::size_t k = 2; k < sees.size(); ++k) quadrature.add({sees[0], sees[k - 1], sees[k]});
    quadrature.refine(options.tolerance * area, options.most_points);
    result.value = quadrature.value() / area;
    result.error = quadrature.error() / area;
    result.points = quadrature.points();
    return result;
}

}  // namespace alhazen
