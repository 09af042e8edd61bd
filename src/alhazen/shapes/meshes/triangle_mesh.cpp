#include "alhazen/shapes/meshes/triangle_mesh.h"

#include <algorithm>

#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/meshes/triangle_normal.h"

namespace alhazen {

namespace {

/// Reports an array that is neither empty nor one entry per vertex.
void check_length(FieldChecks& checks, const char* field, std::size_t size, std::size_t vertices) {
    if (size == 0 || size == vertices) return;
    checks.fail(std::string(field) + " has " + std::to_string(size) + " entries for " +
                std::to_string(vertices) + " vertices");
}

}  // namespace

void TriangleMesh::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks("mesh", where, diagnostics);
    check_length(checks, "normals", normals.size(), positions.size());
    check_length(checks, "uvs", uvs.size(), positions.size());
    check_length(checks, "uvs2", uvs2.size(), positions.size());
    check_length(checks, "colors", colors.size(), positions.size());
    check_length(checks, "tangents", tangents.size(), positions.size());
    check_length(checks, "vertex_materials", vertex_materials.size(), positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (is_finite(positions[i]) && max_component(abs(positions[i])) <= kMaxCoordinate) continue;
        checks.fail("position " + std::to_string(i) + " must be three finite numbers below 1e70");
    }
    // Products of smaller lengths underflow.
    Box3 extent;
    for (const Vec3& position : positions) extent.include(position);
    const double size = extent.empty() ? 0.0 : max_component(extent.size());
    if (size > 0.0 && size < kMinLength) {
        checks.fail("its extent must be zero or at least 1e-70, not " + shortest(size));
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (!is_finite(normals[i])) {
            checks.fail("normal " + std::to_string(i) + " must be three finite numbers");
        }
    }
    for (std::size_t i = 0; i < uvs.size(); ++i) {
        if (!std::isfinite(uvs[i].x) || !std::isfinite(uvs[i].y)) {
            checks.fail("uv " + std::to_string(i) + " must be two finite numbers");
        }
    }
    for (std::size_t i = 0; i < uvs2.size(); ++i) {
        if (!std::isfinite(uvs2[i].x) || !std::isfinite(uvs2[i].y)) {
            checks.fail("uv " + std::to_string(i) +
                        " of the second set must be two finite numbers");
        }
    }
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const VertexColor& c = colors[i];
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b) ||
            !std::isfinite(c.a)) {
            checks.fail("color " + std::to_string(i) + " must be four finite numbers");
        }
    }
    for (std::size_t i = 0; i < tangents.size(); ++i) {
        const VertexTangent& t = tangents[i];
        if (!std::isfinite(t.x) || !std::isfinite(t.y) || !std::isfinite(t.z)) {
            checks.fail("tangent " + std::to_string(i) + " must be three finite numbers");
        }
    }
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const std::uint32_t vertex : triangles[i]) {
            if (vertex < positions.size()) continue;
            checks.fail("triangle " + std::to_string(i) + " uses vertex " + std::to_string(vertex) +
                        " of " + std::to_string(positions.size()));
        }
    }
}

Box3 TriangleMesh::box() const {
    Box3 box;
    for (const auto& triangle : triangles) {
        for (const std::uint32_t vertex : triangle) box.include(positions[vertex]);
    }
    return box;
}

Box3 TriangleMesh::triangle_box(std::size_t triangle) const {
    Box3 box;
    for (const std::uint32_t vertex : triangles[triangle]) box.include(positions[vertex]);
    return box;
}

ShapeSurface TriangleMesh::surface(std::size_t triangle, const ShapeHit& hit) const {
    const auto& [i0, i1, i2] = triangles[triangle];
    const Vec3& p0 = positions[i0];
    const Vec3& p1 = positions[i1];
    const Vec3& p2 = positions[i2];
    const double rest = 1.0 - hit.u;
    const double w = rest - hit.v;
    ShapeSurface surface;
    surface.point = w * p0 + hit.u * p1 + hit.v * p2;
    // Seven roundings of the sum; the weight of p0 has the absolute error of its terms.
    surface.error = gamma_bound(7) * (std::abs(w) * abs(p0) + std::abs(hit.u) * abs(p1) +
                                      std::abs(hit.v) * abs(p2)) +
                    gamma_bound(2) * std::abs(rest) * abs(p0);
    surface.normal = triangle_normal(*this, triangle);
    surface.shading_normal = surface.normal;
    if (!normals.empty()) {
        surface.shading_normal =
            unit_or(w * normals[i0] + hit.u * normals[i1] + hit.v * normals[i2], surface.normal);
    }
    surface.uv = uvs.empty() ? Vec2{hit.u, hit.v} : w * uvs[i0] + hit.u * uvs[i1] + hit.v * uvs[i2];
    const UvDerivatives derivatives = uv_derivatives(triangle, uvs);
    surface.dpdu = derivatives.dpdu;
    surface.dpdv = derivatives.dpdv;
    return surface;
}

UvDerivatives TriangleMesh::uv_derivatives(std::size_t triangle,
                                           const std::vector<Vec2>& coordinates) const {
    const auto& [i0, i1, i2] = triangles[triangle];
    const Vec3 e1 = positions[i1] - positions[i0];
    const Vec3 e2 = positions[i2] - positions[i0];
    if (coordinates.empty()) return {e1, e2};
    const Vec2 a = coordinates[i1] - coordinates[i0];
    const Vec2 b = coordinates[i2] - coordinates[i0];
    const double area = difference_of_products(a.x, b.y, a.y, b.x);
    const UvDerivatives result{(b.y * e1 - a.y * e2) / area, (a.x * e2 - b.x * e1) / area};
    // Texture coordinates on a line or in a point do not determine both directions.
    return is_finite(result.dpdu) && is_finite(result.dpdv) ? result : UvDerivatives{};
}

void TriangleMesh::generate_normals() {
    normals.assign(positions.size(), Vec3{});
    for (const auto& triangle : triangles) {
        const Vec3& p0 = positions[triangle[0]];
        const Vec3 area = cross(positions[triangle[1]] - p0, positions[triangle[2]] - p0);
        for (const std::uint32_t vertex : triangle) normals[vertex] += area;
    }
    // A vertex without area keeps a zero normal; its triangles have flat shading there.
    for (Vec3& normal : normals) normal = unit_or(normal, {});
}

void TriangleMesh::generate_mean_normals() {
    normals.assign(positions.size(), Vec3{});
    std::vector<double> counts(positions.size());
    for (const auto& triangle : triangles) {
        const Vec3& p0 = positions[triangle[0]];
        const Vec3 normal =
            unit_or(cross(positions[triangle[1]] - p0, positions[triangle[2]] - p0), {});
        if (normal == Vec3{}) continue;
        for (const std::uint32_t vertex : triangle) {
            normals[vertex] += normal;
            ++counts[vertex];
        }
    }
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (counts[i] > 0) normals[i] = normals[i] / counts[i];
    }
}

void TriangleMesh::transform(const Affine& to_from) {
    for (Vec3& position : positions) position = to_from.point(position);
    // Normals keep their proportions: interpolated ones are those of the mesh, transformed.
    Mat3 from_to = inverse(to_from.linear);
    const double largest =
        std::max({max_component(abs(from_to.x_axis)), max_component(abs(from_to.y_axis)),
                  max_component(abs(from_to.z_axis))});
    from_to = {from_to.x_axis / largest, from_to.y_axis / largest, from_to.z_axis / largest};
    for (Vec3& normal : normals) normal = transpose_times(from_to, normal);
    // A mirrored frame reverses the orientation.
    const float turn = determinant(to_from.linear) < 0.0 ? -1.0f : 1.0f;
    for (VertexTangent& tangent : tangents) {
        const Vec3 t = unit_or(to_from.linear * Vec3{tangent.x, tangent.y, tangent.z}, {1, 0, 0});
        tangent = {float(t.x), float(t.y), float(t.z), turn * tangent.sign};
    }
}

}  // namespace alhazen
