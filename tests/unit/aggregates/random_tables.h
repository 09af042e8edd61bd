#pragma once
/// Primitive tables and rays for comparing accelerators: random, on a lattice, coincident, flat,
/// huge, tiny.

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen::testing {

using RandomEngine = std::mt19937_64;

/// Uniform in [lo, hi); the same on every machine, unlike std::uniform_real_distribution.
inline double uniform(RandomEngine& random, double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1p-53);
}
inline int uniform_int(RandomEngine& random, int lo, int hi) {
    return lo + static_cast<int>(random() % static_cast<std::uint64_t>(hi - lo + 1));
}
inline Vec3 uniform_point(RandomEngine& random, double reach) {
    const double x = uniform(random, -reach, reach);
    const double y = uniform(random, -reach, reach);
    return {x, y, uniform(random, -reach, reach)};
}
inline Vec3 lattice_point(RandomEngine& random, int reach) {
    const int x = uniform_int(random, -reach, reach);
    const int y = uniform_int(random, -reach, reach);
    return Vec3{double(x), double(y), double(uniform_int(random, -reach, reach))};
}

/// Builds a table. Material 0 is opaque, 1 is not.
struct TableBuilder {
    PrimitiveTable table;
    std::shared_ptr<TriangleMesh> mesh = std::make_shared<TriangleMesh>();
    std::shared_ptr<TriangleMesh> glass = std::make_shared<TriangleMesh>();

    void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, bool opaque = true) {
        TriangleMesh& m = opaque ? *mesh : *glass;
        const auto first = static_cast<std::uint32_t>(m.positions.size());
        m.positions.insert(m.positions.end(), {a, b, c});
        m.triangles.push_back({first, first + 1, first + 2});
    }
    void add_sphere(const Vec3& center, double radius, bool opaque = true,
                    std::uint32_t placement = kNoPlacement) {
        auto& column = std::get<ShapeColumn<Sphere>>(table.columns);
        column.shapes.push_back({.center = center, .radius = radius});
        column.placements.push_back(placement);
        column.materials.push_back(MaterialId{opaque ? 0u : 1u});
    }
    void add_plane(const Vec3& point, const Vec3& normal, bool opaque = true) {
        auto& column = std::get<ShapeColumn<Plane>>(table.columns);
        column.shapes.emplace_back();
        column.shapes.back().point = point;
        column.shapes.back().normal = normal;
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{opaque ? 0u : 1u});
    }
    [[nodiscard]] PrimitiveTable finish() {
        table.material_opacity = {Opacity::Opaque, Opacity::Transparent};
        if (!mesh->triangles.empty()) table.meshes.push_back({mesh, MaterialId{0}, 0, false});
        if (!glass->triangles.empty()) table.meshes.push_back({glass, MaterialId{1}, 0, false});
        table.finish();
        return table;
    }
};

}  // namespace alhazen::testing
