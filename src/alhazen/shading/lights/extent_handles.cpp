#include "alhazen/shading/lights/extent_handles.h"

#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/math/affine.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// The least rotation that takes the direction of `from` to that of `to`; neither may be 0.
Mat3 least_rotation(const Vec3& from, const Vec3& to) {
    const Vec3 a = normalize(from), b = normalize(to);
    const Vec3 axis = cross(a, b);
    if (axis == Vec3{}) {
        return dot(a, b) > 0.0 ? Affine{}.linear : Affine::rotate(perpendicular(a), kPi).linear;
    }
    return Affine::rotate(axis, std::atan2(length(axis), dot(a, b))).linear;
}

/// Motion of the points of a surface: turned and scaled about its centre, and moved.
class Motion {
  public:
    Motion(const ExtentHandles& from, const ExtentChange& change) : from_(from), change_(change) {
        if (change.direction && from.direction && *change.direction != *from.direction) {
            turn_ = least_rotation(*from.direction, *change.direction);
        }
        for (std::size_t i = 0; i < change.sizes.size(); ++i) {
            scales_ |= change.sizes[i] != from.sizes[i].value;
        }
    }

    /// The edge, multiplied by its size.
    [[nodiscard]] Vec3 edge(const Vec3& e, std::size_t size) const {
        const Vec3 turned = turn_ ? *turn_ * e : e;
        return change_.sizes.empty() ? turned
                                     : (change_.sizes[size] / from_.sizes[size].value) * turned;
    }
    [[nodiscard]] Vec3 middle() const { return change_.position.value_or(from_.position); }
    [[nodiscard]] Vec3 moved(const Vec3& point) const {
        return point + (middle() - from_.position);
    }
    [[nodiscard]] bool only_moves() const { return !turn_ && !scales_; }
    void move_all(std::vector<Vec3>& points) const {
        for (Vec3& p : points) p = only_moves() ? moved(p) : middle() + edge(p - from_.position, 0);
    }
    [[nodiscard]] double size(std::size_t i, double old) const {
        return change_.sizes.empty() ? old : change_.sizes[i];
    }

  private:
    const ExtentHandles& from_;
    const ExtentChange& change_;
    std::optional<Mat3> turn_;
    bool scales_ = false;
};

}  // namespace

ExtentHandles handles_of(const LightExtent& extent) {
    ExtentHandles handles;
    handles.position = LightSurface(extent, false).center();
    std::visit(
        Overloaded{
            [&](const RectangleExtent& r) {
                handles.direction = normalize(cross(r.edge_u, r.edge_v));
                handles.sizes = {{"width", length(r.edge_u)}, {"height", length(r.edge_v)}};
            },
            [&](const DiscExtent& d) {
                handles.direction = d.normal;
                handles.sizes = {{"radius", d.radius}, {"inner radius", d.inner_radius}};
            },
            [&](const SphereExtent& s) {
                handles.sizes = {{"radius", s.radius}};
            },
            [&](const TubeExtent& t) {
                handles.direction = normalize(t.top - t.base);
                handles.sizes = {{"length", length(t.top - t.base)}, {"radius", t.radius}};
            },
            [&](const PolygonExtent& p) {
                handles.direction = unit_or(plane_normal_of_loops(p.vertices, {}), {0, 0, 1});
                handles.sizes = {{"scale", 1.0}};
            },
            [&](const MeshExtent&) {
                handles.sizes = {{"scale", 1.0}};
            }},
        extent);
    return handles;
}

LightExtent changed(const LightExtent& extent, const ExtentChange& change) {
    const ExtentHandles handles = handles_of(extent);
    const Motion motion(handles, change);
    LightExtent result = extent;
    std::visit(Overloaded{[&](RectangleExtent& r) {
                              if (motion.only_moves()) {
                                  r.corner = motion.moved(r.corner);
                                  return;
                              }
                              r.edge_u = motion.edge(r.edge_u, 0);
                              r.edge_v = motion.edge(r.edge_v, 1);
                              r.corner = motion.middle() - 0.5 * (r.edge_u + r.edge_v);
                          },
                          [&](DiscExtent& d) {
                              d.center = motion.middle();
                              d.normal = change.direction.value_or(d.normal);
                              d.radius = motion.size(0, d.radius);
                              d.inner_radius = motion.size(1, d.inner_radius);
                          },
                          [&](SphereExtent& s) {
                              s.center = motion.middle();
                              s.radius = motion.size(0, s.radius);
                          },
                          [&](TubeExtent& t) {
                              t.radius = motion.size(1, t.radius);
                              if (motion.only_moves()) {
                                  t.base = motion.moved(t.base);
                                  t.top = motion.moved(t.top);
                                  return;
                              }
                              const Vec3 half = 0.5 * motion.edge(t.top - t.base, 0);
                              t.base = motion.middle() - half;
                              t.top = motion.middle() + half;
                          },
                          [&](PolygonExtent& p) { motion.move_all(p.vertices); },
                          [&](MeshExtent& m) { motion.move_all(m.points); }},
               result);
    return result;
}

}  // namespace alhazen
