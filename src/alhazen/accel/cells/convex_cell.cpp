#include "alhazen/accel/cells/convex_cell.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace alhazen {
namespace {

/// Twice the vector area of a polygon, accumulated point by point.
struct VectorArea {
    Vec3 first, last, sum;
    int count = 0;

    void add(const Vec3& p) {
        if (count == 0) {
            first = p;
        } else if (count > 1) {
            sum = sum + cross(last - first, p - first);
        }
        last = p;
        ++count;
    }
};

double area_of(std::span<const Vec3> polygon) {
    VectorArea area;
    for (const Vec3& p : polygon) area.add(p);
    return 0.5 * length(area.sum);
}

/// Calls keep(point) for the outline of the part below the plane, cut(point) for intersections with
/// the plane.
template <class Keep, class Cut>
void clip(std::span<const Vec3> polygon, const Vec3& normal, double offset, const Keep& keep,
          const Cut& cut) {
    const Vec3* a = &polygon.back();
    double from = dot(normal, *a) - offset;
    for (const Vec3& b : polygon) {
        const double to = dot(normal, b) - offset;
        if ((from <= 0.0) != (to <= 0.0)) {
            const Vec3 p = *a + (from / (from - to)) * (b - *a);
            keep(p);
            cut(p);
        }
        if (to <= 0.0) keep(b);
        a = &b;
        from = to;
    }
}

std::span<const Vec3> face(const std::vector<Vec3>& points,
                           const std::vector<std::uint32_t>& starts, std::size_t f) {
    return std::span(points).subspan(starts[f], starts[f + 1] - starts[f]);
}

}  // namespace

ConvexCell::ConvexCell(const Box3& box) {
    // The corners of a face, counterclockwise from outside; bit k selects the upper end of axis k.
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& corners : kFaces) {
        std::vector<Vec3> points;
        for (const int c : corners) points.push_back(box.corner(c));
        add_face(points);
    }
}

void ConvexCell::add_face(const std::vector<Vec3>& points) {
    if (points.size() < 3) return;
    points_.insert(points_.end(), points.begin(), points.end());
    starts_.push_back(static_cast<std::uint32_t>(points_.size()));
    area_ += area_of(points);
}

double ConvexCell::volume() const {
    if (points_.empty()) return 0;
    // Pyramids over the faces with a common apex.
    const Vec3 top = points_.front();
    double six_volumes = 0;
    for (std::size_t f = 0; f + 1 < starts_.size(); ++f) {
        const auto polygon = face(points_, starts_, f);
        VectorArea area;
        for (const Vec3& p : polygon) area.add(p);
        six_volumes += dot(polygon.front() - top, area.sum);
    }
    return six_volumes / 6;
}

Interval ConvexCell::extent(const Vec3& normal) const {
    Interval range;
    for (const Vec3& p : points_) range.include(dot(normal, p));
    return range;
}

ConvexCell::Areas ConvexCell::areas_of_parts(const Vec3& normal, double offset) const {
    double lower = 0;
    Vec3 open;  // the vector area missing from the lower part
    for (std::size_t f = 0; f + 1 < starts_.size(); ++f) {
        VectorArea area;
        clip(
            face(points_, starts_, f), normal, offset, [&](const Vec3& p) { area.add(p); },
            [](const Vec3&) {});
        lower += 0.5 * length(area.sum);
        open = open + 0.5 * area.sum;
    }
    const double cut = length(open);
    return {lower + cut, std::max(0.0, area_ - lower) + cut};
}

ConvexCell ConvexCell::lower_part(const Vec3& normal, double offset) const {
    ConvexCell part;
    std::vector<Vec3> outline, rim;
    for (std::size_t f = 0; f + 1 < starts_.size(); ++f) {
        outline.clear();
        clip(
            face(points_, starts_, f), normal, offset, [&](const Vec3& p) { outline.push_back(p); },
            [&](const Vec3& p) { rim.push_back(p); });
        part.add_face(outline);
    }
    part.close(std::move(rim), normal);
    return part;
}

/// Adds the face in the plane of the cut.
void ConvexCell::close(std::vector<Vec3> rim, const Vec3& normal) {
    if (rim.size() < 3) return;
    Vec3 center;
    for (const Vec3& p : rim) center = center + p / static_cast<double>(rim.size());
    const Vec3 away = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 x = normalize(cross(away, normal));
    const Vec3 y = cross(normal, x);
    const auto angle = [&](const Vec3& p) {
        return std::atan2(dot(y, p - center), dot(x, p - center));
    };
    std::vector<std::pair<double, Vec3>> by_angle;
    for (const Vec3& p : rim) by_angle.emplace_back(angle(p), p);
    std::sort(by_angle.begin(), by_angle.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Vec3> outline;
    // Neighbouring faces share points of the cut.
    for (const auto& [a, p] : by_angle) {
        if (outline.empty() || max_component(abs(p - outline.back())) > 1e-13) outline.push_back(p);
    }
    add_face(outline);
}

}  // namespace alhazen
