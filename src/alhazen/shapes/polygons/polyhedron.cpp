#include "alhazen/shapes/polygons/polyhedron.h"

#include <algorithm>

#include "alhazen/base/number_text.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

namespace {

/// Flatness tolerance relative to the size: vertices farther outside of a face make the solid
/// non-convex or the face non-planar.
constexpr double kFlatness = 1e-3;
/// Least area relative to the squared size: smaller faces have no reliable normal.
constexpr double kLeastArea = 1e-12;

Vec3 mean_of(const std::vector<Vec3>& points) {
    Vec3 sum;
    for (const Vec3& p : points) sum += p - points.front();
    return points.front() + sum / static_cast<double>(points.size());
}

double size_of(const std::vector<Vec3>& points) {
    Box3 box;
    for (const Vec3& p : points) box.include(p);
    return length(box.hi - box.lo);
}

/// The corners of a face without consecutive duplicates.
std::vector<Vec3> face_corners(const Polyhedron& p, std::size_t begin, std::size_t end) {
    std::vector<Vec3> points;
    for (std::size_t i = begin; i < end; ++i) {
        const Vec3& v = p.vertices[p.corners[i]];
        if (points.empty() || v != points.back()) points.push_back(v);
    }
    while (points.size() > 1 && points.back() == points.front()) points.pop_back();
    return points;
}

/// Newell's normal; its length is twice the area.
Vec3 newell_normal(const std::vector<Vec3>& points) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
        sum += accurate_cross(points[i] - points[0], points[i + 1] - points[0]);
    }
    return sum;
}

/// The planes with unit outward normals, without faces of zero area.
std::vector<OrientedPlane> oriented_planes(const Polyhedron& p) {
    std::vector<OrientedPlane> planes;
    for (const OrientedPlane& plane : p.planes) {
        planes.push_back({plane.point, unit_or(plane.normal, {0, 0, 1})});
    }
    if (p.vertices.empty()) return planes;
    const Vec3 middle = mean_of(p.vertices);
    const double size = size_of(p.vertices);
    std::size_t begin = 0;
    for (const std::size_t end : p.face_ends) {
        const std::vector<Vec3> points = face_corners(p, begin, end);
        begin = end;
        const Vec3 normal = newell_normal(points);
        if (points.size() < 3 || !(length(normal) > kLeastArea * size * size)) continue;
        OrientedPlane plane{mean_of(points), unit_or(normal, {0, 0, 1})};
        if (dot(plane.normal, middle - plane.point) > 0.0) plane.normal = -plane.normal;
        planes.push_back(plane);
    }
    return planes;
}

double largest_coordinate(const std::vector<OrientedPlane>& planes, const ConvexCorners& solid) {
    double largest = 0.0;
    for (const OrientedPlane& plane : planes) {
        largest = std::max(largest, max_component(abs(plane.point)));
    }
    for (const Vec3& p : solid.corners) largest = std::max(largest, max_component(abs(p)));
    return largest;
}

bool check_planes(const Polyhedron& p, FieldChecks& checks) {
    for (const OrientedPlane& plane : p.planes) {
        checks.point("point of a plane", plane.point);
        checks.vector("normal of a plane", plane.normal);
        if (!checks.ok()) return false;
    }
    return true;
}

bool check_faces(const Polyhedron& p, FieldChecks& checks) {
    for (const Vec3& v : p.vertices) {
        checks.point("vertex", v);
        if (!checks.ok()) return false;
    }
    std::uint32_t begin = 0;
    for (const std::uint32_t end : p.face_ends) {
        if (end < begin + 3 || end > p.corners.size()) {
            checks.fail("a face needs at least three corners");
            return false;
        }
        begin = end;
    }
    for (const std::uint32_t corner : p.corners) {
        if (corner < p.vertices.size()) continue;
        checks.fail("a face names vertex " + std::to_string(corner) + ", but there are " +
                    std::to_string(p.vertices.size()));
        return false;
    }
    return true;
}

void check_convexity(const Polyhedron& p, const std::vector<OrientedPlane>& planes,
                     FieldChecks& checks) {
    const double size = size_of(p.vertices);
    double worst = 0.0;
    for (const OrientedPlane& plane : planes) {
        for (const std::uint32_t corner : p.corners) {
            worst = std::max(worst, dot(plane.normal, p.vertices[corner] - plane.point));
        }
    }
    if (worst > kFlatness * size) {
        checks.fail("not convex, or its faces are not flat: a vertex lies " + shortest(worst) +
                    " outside of a face");
    }
}

}  // namespace

void Polyhedron::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    if (planes.empty() == vertices.empty()) {
        return checks.fail("either planes or vertices with faces must be given");
    }
    if (!check_planes(*this, checks) || !check_faces(*this, checks)) return;
    const std::vector<OrientedPlane> all = oriented_planes(*this);
    if (!vertices.empty()) check_convexity(*this, all, checks);
    if (!checks.ok()) return;
    const ConvexCorners solid = convex_corners(all);
    if (!solid.bounded) {
        return checks.fail(
            "its " + std::to_string(all.size()) +
            " planes do not bound a volume; what reaches to infinity is an intersection of "
            "half_space");
    }
    if (!(convex_volume(solid) > 0.0)) checks.fail("nothing lies inside all of its planes");
}

void Polyhedron::prepare() {
    faces = oriented_planes(*this);
    // Moves the corners outward by a few ulps: near a sharp edge a crossing may be rounded much
    // farther past the edge.
    const double pad = gamma_bound(32) * largest_coordinate(faces, convex_corners(faces));
    std::vector<OrientedPlane> outer = faces;
    for (OrientedPlane& plane : outer) plane.point += pad * plane.normal;
    hull = convex_corners(outer).corners;
    bounds = {};
    for (const Vec3& p : hull) bounds.include(outward_box(p, {pad, pad, pad}));
}

Interval Polyhedron::extent(const Vec3& axis) const {
    Interval range;
    for (const Vec3& p : hull) range = alhazen::hull(range, outward_extent(axis, p, 0.0));
    return range;
}

int Polyhedron::intersect(const Ray& ray, ShapeHit* hits) const {
    double entry = -kInfinity, exit = kInfinity;
    std::uint32_t entry_part = 0, exit_part = 0;
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const OrientedPlane& face = faces[i];
        const double toward = dot(face.normal, ray.direction);
        const double depth = dot(face.normal, face.point - ray.origin);
        if (toward == 0.0) {
            if (!(depth > 0.0 || (depth == 0.0 && keeps_face(face.normal)))) return 0;
            continue;
        }
        const double t = depth / toward;
        if (toward < 0.0) {
            if (t > entry) {
                entry = t;
                entry_part = i;
            }
        } else if (t < exit) {
            exit = t;
            exit_part = i;
        }
        if (entry > exit) return 0;
    }
    return report_span(ray, entry, entry_part, exit, exit_part, hits);
}

ShapeSurface Polyhedron::surface(const Ray& ray, const ShapeHit& hit) const {
    const OrientedPlane& face = faces[hit.part];
    ShapeSurface surface = surface_on_plane(ray.at(hit.t), face.point, face.normal);
    const Vec3 offset = surface.point - face.point;
    surface.dpdu = perpendicular(face.normal);
    surface.dpdv = cross(face.normal, surface.dpdu);
    surface.uv = {dot(offset, surface.dpdu), dot(offset, surface.dpdv)};
    return surface;
}

Polyhedron hexahedron(const std::array<Vec3, 8>& points) {
    constexpr std::uint32_t kFaces[6][4] = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                            {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    Polyhedron solid;
    solid.vertices.assign(points.begin(), points.end());
    for (const auto& face : kFaces) {
        solid.corners.insert(solid.corners.end(), std::begin(face), std::end(face));
        solid.face_ends.push_back(static_cast<std::uint32_t>(solid.corners.size()));
    }
    return solid;
}

}  // namespace alhazen
