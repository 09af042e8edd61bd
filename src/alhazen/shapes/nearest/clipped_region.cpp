#include "alhazen/shapes/nearest/clipped_region.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "alhazen/math/quadratic.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Vec3 foot_on(const ClippedRegion::Plane& plane, const Vec3& x) {
    const Vec3 once = x - (dot(plane.normal, x) - plane.offset) * plane.normal;
    return once - (dot(plane.normal, once) - plane.offset) * plane.normal;
}

/// True if the apex is inside or nearly so: the apex of a frustum may be far beyond its end.
bool holds_apex(const std::vector<ClippedRegion::Plane>& planes, const Vec3& apex) {
    for (const ClippedRegion::Plane& plane : planes) {
        if (!(dot(plane.normal, apex) <= plane.offset + std::abs(plane.offset))) return false;
    }
    return true;
}

}  // namespace

ClippedRegion::ClippedRegion(const Eigensystem& own, const Vec3& b, double c,
                             std::vector<Plane> planes, bool capped,
                             const std::optional<Vec3>& apex)
    : has_quadric_(true), capped_(capped), axes_(own.axes), planes_(std::move(planes)) {
    const double size = max_component(abs(own.values));
    const double scale = size > 0.0 ? 1.0 / size : 1.0;
    form_ = {3, scale * own.values, {}, 0.0};
    if (apex && holds_apex(planes_, *apex)) {
        // Relative to the apex f has no linear and constant terms, and none of their rounding.
        origin_ = *apex;
        has_apex_ = true;
        rounding_ = length(origin_);
        for (Plane& plane : planes_) plane.offset -= dot(plane.normal, origin_);
        return;
    }
    form_.b = scale * transpose_times(axes_, b);
    form_.c = scale * c;
    // Clears gradient components that are mere rounding of the others.
    for (int i = 0; i < 3; ++i) {
        if (std::abs(form_.b[i]) < 8 * kEpsilon * scale * length(b)) form_.b[i] = 0.0;
    }
}

ClippedRegion::ClippedRegion(std::vector<Plane> planes) : planes_(std::move(planes)) {}

double ClippedRegion::value(const Vec3& x) const {
    return has_quadric_ ? form_.value(transpose_times(axes_, x)) : -1.0;
}

double ClippedRegion::magnitude(const Vec3& x) const {
    const Vec3 y = transpose_times(axes_, x), m = abs(y);
    const double terms = dot(m, abs(form_.a) * m + 2.0 * abs(form_.b)) + std::abs(form_.c);
    return terms + 2.0 * length(form_.half_gradient(y)) * length(x);
}

Vec3 ClippedRegion::onto_surface(Vec3 x, const Plane* plane) const {
    // The rounding of a distant candidate displaces it from the plane.
    if (plane != nullptr) x = foot_on(*plane, x);
    double off = std::abs(value(x));
    for (int i = 0; i < 6 && off > 0.0; ++i) {
        Vec3 gradient = half_gradient(x);
        if (plane != nullptr) gradient -= dot(gradient, plane->normal) * plane->normal;
        Vec3 next = x - (0.5 * value(x) / length_squared(gradient)) * gradient;
        if (plane != nullptr) next = foot_on(*plane, next);
        const double still_off = std::abs(value(next));
        if (!(still_off < off)) break;
        x = next;
        off = still_off;
    }
    return x;
}

Eigensystem ClippedRegion::own_in(const Vec3& x, const Vec3& y) const {
    // With at most two curved axes in the plane the eigensystem of rows is accurate; the plane is
    // mostly perpendicular to one axis.
    const Vec3 along_x = transpose_times(axes_, x), along_y = transpose_times(axes_, y);
    std::array<Vec3, 3> rows;
    Vec3 signs;
    int count = 0;
    for (int i = 0; i < 3; ++i) {
        const Vec3 row{along_x[i], along_y[i], 0.0};
        if (form_.a[i] == 0.0 || length(row) <= 4 * kEpsilon) continue;
        if (count < 2) {
            rows[count] = std::sqrt(std::abs(form_.a[i])) * row;
            signs[count] = form_.a[i] > 0.0 ? 1.0 : -1.0;
        }
        ++count;
    }
    if (count == 1) {
        const Vec3 first = normalize(rows[0]);
        return {{signs[0] * length_squared(rows[0]), 0.0, 0.0},
                {first, {-first.y, first.x, 0.0}, {0.0, 0.0, 1.0}}};
    }
    if (count == 2) {
        if (const auto own = eigensystem_of_rows(rows, signs)) return *own;
    }
    // The third axis is unchanged: its row and column are zero.
    Eigensystem own =
        eigensystem({{second(x, x), second(x, y), 0.0}, {second(x, y), second(y, y), 0.0}, {}});
    for (int i = 0; i < 2; ++i) {
        if (std::abs(own.values[i]) < 8 * kEpsilon) own.values[i] = 0.0;
    }
    return own;
}

ClippedRegion::Conic ClippedRegion::conic_in(const Plane& plane) const {
    Conic conic;
    conic.origin = foot_on(plane, {});
    const Vec3 x = perpendicular(plane.normal), y = cross(plane.normal, x);
    const Eigensystem own = own_in(x, y);
    conic.x_axis = own.axes.x_axis.x * x + own.axes.x_axis.y * y;
    conic.y_axis = own.axes.y_axis.x * x + own.axes.y_axis.y * y;
    const Vec3 b = half_gradient(conic.origin);
    conic.form = {
        2, own.values, {dot(b, conic.x_axis), dot(b, conic.y_axis), 0.0}, value(conic.origin)};
    return conic;
}

void ClippedRegion::append_conic_points(const Plane& plane, const Vec3& from,
                                        std::vector<Vec3>& points) const {
    // The point nearest to the foot in the plane is also nearest to `from`.
    const Conic conic = conic_in(plane);
    const Vec3 foot = foot_on(plane, from) - conic.origin;
    std::vector<Vec3> found;
    append_stationary_points(conic.form, {dot(foot, conic.x_axis), dot(foot, conic.y_axis), 0.0},
                             found);
    for (const Vec3& p : found) {
        points.push_back(
            onto_surface(conic.origin + p.x * conic.x_axis + p.y * conic.y_axis, &plane));
    }
}

/// Tests candidates and keeps the nearest.
class ClippedRegion::Search {
  public:
    Search(const ClippedRegion& region, const Vec3& from) : region_(region), from_(from) {}

    void surface() {
        std::vector<Vec3> found;
        append_stationary_points(region_.form_, transpose_times(region_.axes_, from_), found);
        for (const Vec3& p : found) {
            const Vec3 x = region_.onto_surface(region_.axes_ * p, nullptr);
            if (is_on_surface(x)) offer(x, surface_normal(x));
        }
        if (region_.has_apex_ && planes_leave({})) offer({}, unit_or(from_, {0, 0, 1}));
    }
    void plane(std::size_t i) {
        const Plane& plane = region_.planes_[i];
        if (region_.capped_) {
            const Vec3 foot = foot_on(plane, from_);
            if (is_filled(foot)) offer(foot, plane.normal);
        }
        if (!region_.has_quadric_) return;
        std::vector<Vec3> found;
        region_.append_conic_points(plane, from_, found);
        for (const Vec3& x : found) {
            if (is_on_surface(x)) offer(x, rim_normal(x, plane));
        }
    }
    void edge(std::size_t i, std::size_t k) {
        const Plane &p = region_.planes_[i], &q = region_.planes_[k];
        const Vec3 along = cross(p.normal, q.normal);
        const double squared = length_squared(along);
        if (!(squared > 1e-24)) return;
        const Vec3 unit = along / std::sqrt(squared);
        // The foot on the line, computed again from the first result for accuracy.
        const auto foot_of = [&](Vec3 foot) {
            for (int turn = 0; turn < 2; ++turn) {
                const double over_p = dot(p.normal, foot) - p.offset;
                const double over_q = dot(q.normal, foot) - q.offset;
                foot -=
                    (over_p * cross(q.normal, along) - over_q * cross(p.normal, along)) / squared;
            }
            return foot;
        };
        const Vec3 foot = foot_of(from_);
        if (region_.capped_ && is_filled(foot)) offer(foot, p.normal);
        if (!region_.has_quadric_) return;
        // From a point near the region, where roundings are small.
        const Vec3 start = foot_of({});
        const Vec3 half = region_.half_gradient(start);
        const QuadraticRoots roots = solve_half_b_quadratic(region_.second(unit, unit),
                                                            dot(half, unit), region_.value(start));
        for (int r = 0; r < roots.count; ++r) {
            const Vec3 x = start + (r == 0 ? roots.t0 : roots.t1) * unit;
            if (is_on_surface(x)) offer(x, rim_normal(x, p));
        }
    }
    void corner(std::size_t i, std::size_t k, std::size_t m) {
        const Plane &p = region_.planes_[i], &q = region_.planes_[k], &r = region_.planes_[m];
        const Vec3 qr = cross(q.normal, r.normal);
        const double volume = dot(p.normal, qr);
        if (!(std::abs(volume) > 1e-12)) return;
        const Vec3 x = (p.offset * qr + q.offset * cross(r.normal, p.normal) +
                        r.offset * cross(p.normal, q.normal)) /
                       volume;
        if (region_.capped_ && is_filled(x)) offer(x, p.normal);
    }
    [[nodiscard]] const std::optional<PointOnSurface>& best() const { return best_; }

  private:
    /// Rounding may place points of edges outside other planes.
    static constexpr double kSlack = 64 * kEpsilon;

    [[nodiscard]] bool planes_leave(const Vec3& x) const {
        for (const Plane& plane : region_.planes_) {
            const double slack = kSlack * (length(x) + std::abs(plane.offset) + region_.rounding_);
            if (!(dot(plane.normal, x) <= plane.offset + slack)) return false;
        }
        return true;
    }
    [[nodiscard]] bool is_filled(const Vec3& x) const {
        return region_.value(x) <= kSlack * region_.magnitude(x) && planes_leave(x);
    }
    /// False for points where the iteration towards the surface failed.
    [[nodiscard]] bool is_on_surface(const Vec3& x) const {
        return std::abs(region_.value(x)) <= kSlack * region_.magnitude(x) && planes_leave(x);
    }
    [[nodiscard]] Vec3 surface_normal(const Vec3& x) const {
        return unit_or(region_.half_gradient(x), unit_or(from_ - x, {0, 0, 1}));
    }
    [[nodiscard]] Vec3 rim_normal(const Vec3& x, const Plane& plane) const {
        return region_.capped_ ? plane.normal : surface_normal(x);
    }
    void offer(const Vec3& x, const Vec3& normal) {
        keep_nearer(best_, {x, normal, length_squared(x - from_)});
    }

    const ClippedRegion& region_;
    const Vec3 from_;
    std::optional<PointOnSurface> best_;
};

std::optional<PointOnSurface> ClippedRegion::nearest(const Vec3& from) const {
    Search search(*this, from - origin_);
    if (has_quadric_) search.surface();
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        search.plane(i);
        for (std::size_t k = i + 1; k < planes_.size(); ++k) {
            search.edge(i, k);
            for (std::size_t m = k + 1; m < planes_.size(); ++m) search.corner(i, k, m);
        }
    }
    std::optional<PointOnSurface> best = search.best();
    if (best) best->point += origin_;
    return best;
}

std::optional<PointOnSurface> ClippedRegion::nearest_in_plane(const Vec3& from,
                                                              const Plane& plane) const {
    std::vector<Vec3> found;
    append_conic_points(plane, from, found);
    std::optional<PointOnSurface> best;
    for (const Vec3& x : found) {
        if (std::abs(value(x)) > 64 * kEpsilon * magnitude(x)) continue;
        keep_nearer(best, {x, plane.normal, length_squared(x - from)});
    }
    return best;
}

}  // namespace alhazen
