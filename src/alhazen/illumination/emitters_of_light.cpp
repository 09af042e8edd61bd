#include "alhazen/illumination/emitters_of_light.h"

#include "alhazen/base/overloaded.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/shading/lights/extent_triangles.h"

namespace alhazen {

namespace {

Affine frame_of(const Vec3& origin, const Vec3& x, const Vec3& y) {
    return {{x, y, unit_or(cross(x, y), {0, 0, 1})}, origin};
}

void append_extent_triangles(const MeshExtent& mesh, std::vector<Emitter>& list) {
    for (const auto& t : mesh.triangles) {
        const Vec3& a = mesh.points[t[0]];
        list.push_back(
            {.form = EmitterForm::Triangle,
             .world_from_own = frame_of(a, mesh.points[t[1]] - a, mesh.points[t[2]] - a)});
    }
}

void append_extent(const LightExtent& extent, std::vector<Emitter>& list) {
    std::visit(
        Overloaded{
            [&](const RectangleExtent& r) {
                list.push_back({.form = EmitterForm::Rectangle,
                                .world_from_own = frame_of(r.corner, r.edge_u, r.edge_v)});
            },
            [&](const DiscExtent& d) {
                const Vec3 n = normalize(d.normal), x = perpendicular(n);
                list.push_back(
                    {.form = EmitterForm::Disc,
                     .world_from_own = frame_of(d.center, d.radius * x, d.radius * cross(n, x)),
                     .inner = d.inner_radius / d.radius});
            },
            [&](const SphereExtent& s) {
                list.push_back({.form = EmitterForm::Sphere,
                                .world_from_own = Affine::translate(s.center) *
                                                  Affine::scale({s.radius, s.radius, s.radius})});
            },
            [&](const TubeExtent& t) {
                const Vec3 n = normalize(t.top - t.base), x = perpendicular(n);
                list.push_back(
                    {.form = EmitterForm::Tube,
                     .world_from_own = {{t.radius * x, t.radius * cross(n, x), t.top - t.base},
                                        t.base}});
            },
            [&](const PolygonExtent& p) { append_extent_triangles(triangles_of(p), list); },
            [&](const MeshExtent& m) { append_extent_triangles(m, list); }},
        extent);
}

}  // namespace

void append_emitters_of_light(const AreaLight& light, std::vector<Emitter>& emitters) {
    const std::size_t first = emitters.size();
    append_extent(light.extent, emitters);
    for (std::size_t i = first; i < emitters.size(); ++i) {
        emitters[i].two_sided = light.two_sided;
        emitters[i].unseen = true;
        emitters[i].radiance = light.radiance;
        if (!make_ready(emitters[i])) emitters[i].area = 0.0;
    }
}

}  // namespace alhazen
