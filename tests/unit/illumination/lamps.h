#pragma once
/// Emitting surfaces of all kinds.

#include <cmath>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

inline Material lamp_material(const Rgb& radiance, bool two_sided = true) {
    Material m;
    m.emission.color = radiance;
    m.double_sided = two_sided;
    return m;
}

/// A scene of one emitter at about (0, 0, 3), with lit points below.
template <class Shape>
Scene lamp_of(Shape shape, const Affine& placement = {}, bool two_sided = true) {
    SceneMaker maker;
    maker.add(shape, maker.material(lamp_material({2, 3, 4}, two_sided)), placement);
    return maker.compile();
}

inline Scene mesh_lamp(const Affine& placement, bool two_sided) {
    SceneMaker maker;
    TriangleMesh mesh;
    mesh.positions = {{-1, -1, 3}, {1, -1, 3.5}, {0.2, 1.5, 2.5}, {2, 1, 4}};
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}};
    const MaterialId m = maker.material(lamp_material({2, 3, 4}, two_sided));
    maker.add(maker.mesh(mesh), m, placement);
    return maker.compile();
}

inline const Affine kSkew{{{1.2, 0.1, 0}, {-0.3, 0.7, 0.2}, {0.1, 0, 1.1}}, {0.2, -0.1, 0.3}};

inline const Affine kMirror{{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};

inline Rectangle rectangle_lamp() {
    Rectangle r;
    r.corner = {-1, -0.5, 3};
    r.edge_u = {0, 1.5, 0};
    r.edge_v = {2, 0, 0};
    return r;
}

inline Cylinder cylinder_lamp(bool capped) {
    Cylinder c;
    c.base = {-1, 0, 3};
    c.top = {1, 0.4, 3.2};
    c.radius = 0.3;
    c.capped = capped;
    return c;
}

inline Polygon polygon_lamp() {
    Polygon p;
    p.vertices = {{-1, -1, 3}, {-1, 1, 3}, {0, 0.2, 3}, {1, 1, 3}, {1, -1, 3}};
    return p;
}

inline BezierPatch patch_lamp() {
    BezierPatch p;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            p.points.push_back({-1 + 0.6 * i, -1 + 0.7 * j, 3 + 0.4 * std::sin(1.0 * i + 2 * j)});
        }
    }
    return p;
}

/// All kinds, with the lit point below them.
inline std::vector<Scene> lamps() {
    std::vector<Scene> all;
    for (const Affine& placement : {Affine{}, kSkew, kMirror}) {
        all.push_back(lamp_of(Sphere{{0.3, 0, 3}, 0.8}, placement));
        all.push_back(lamp_of(rectangle_lamp(), placement));
        all.push_back(lamp_of(rectangle_lamp(), placement, false));
        all.push_back(lamp_of(Disc{{0, 0.2, 3}, {0.2, 0.1, -1}, 1.1, 0.4}, placement));
        all.push_back(lamp_of(cylinder_lamp(false), placement));
        all.push_back(lamp_of(cylinder_lamp(true), placement, false));
        all.push_back(lamp_of(polygon_lamp(), placement));
        all.push_back(lamp_of(BoxShape{{-0.7, -0.5, 2.5}, {0.8, 0.5, 3}}, placement));
        all.push_back(lamp_of(patch_lamp(), placement));
        all.push_back(mesh_lamp(placement, true));
    }
    all.push_back(mesh_lamp({}, false));
    return all;
}

inline const LitPoint kBelowLamps{{0.1, 0.2, 0}, {0, 0, 1}, false};

}  // namespace alhazen::testing
