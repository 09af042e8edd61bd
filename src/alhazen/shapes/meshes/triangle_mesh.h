#pragma once
/// An indexed triangle mesh with optional normals, texture coordinates and materials at the
/// vertices.
///
/// Each triangle is a primitive of its own in an accelerator; all share the mesh.
/// Conventions: counter-clockwise from outside. Without vertex normals shading is flat; without
/// texture coordinates uv are the barycentrics (weights of the second and the third vertex).

#include <cstdint>

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// Linear, with alpha; 1 by default.
struct VertexColor {
    float r = 1, g = 1, b = 1, a = 1;
    friend bool operator==(const VertexColor&, const VertexColor&) = default;
};
/// A unit direction along +u in the surface, and the handedness of the frame: (normal x tangent)
/// times `sign` runs along +v.
struct VertexTangent {
    float x = 1, y = 0, z = 0, sign = 1;
    friend bool operator==(const VertexTangent&, const VertexTangent&) = default;
};

/// Derivatives of the point by texture coordinates; zero where undefined.
struct UvDerivatives {
    Vec3 dpdu, dpdv;
};

struct TriangleMesh {
    std::vector<Vec3> positions;                          ///< [vertex]
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< [triangle] vertex indices
    std::vector<Vec3> normals;                            ///< [vertex] unit, or empty
    std::vector<Vec2> uvs;                                ///< [vertex], or empty
    std::vector<Vec2> uvs2;                               ///< [vertex] second set, or empty
    std::vector<VertexColor> colors;                      ///< [vertex], or empty
    std::vector<VertexTangent> tangents;                  ///< [vertex], or empty
    /// [vertex] index into the owner's list of materials, or empty.
    std::vector<std::uint32_t> vertex_materials;

    /// Reports indices out of range, positions that are not finite, arrays of the wrong length.
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Box3 triangle_box(std::size_t triangle) const;
    /// The surface at a hit whose u, v are the weights of the second and third vertex.
    [[nodiscard]] ShapeSurface surface(std::size_t triangle, const ShapeHit& hit) const;
    /// `coordinates`: a set of texture coordinates; empty: barycentrics.
    [[nodiscard]] UvDerivatives uv_derivatives(std::size_t triangle,
                                               const std::vector<Vec2>& coordinates) const;
    /// True if each edge belongs to an even number of triangles after vertices of equal position
    /// are merged: every line then crosses the mesh an even number of times.
    [[nodiscard]] bool closed() const;

    /// Sets each normal to the normalised sum of the normals of the vertex's triangles, weighted by
    /// their areas.
    void generate_normals();
    /// Sets each normal to the mean of the unit normals of the vertex's triangles. It is shorter
    /// than 1 where they differ, and so has less weight when normals are interpolated. Triangles
    /// without area do not count.
    void generate_mean_normals();
    /// Applies a transform to positions, tangents and (by the inverse transpose) to normals.
    void transform(const Affine& to_from);
};

/// Area; volume enclosed (signed, positive when oriented outward), by the divergence theorem.
[[nodiscard]] double area(const TriangleMesh& mesh);
[[nodiscard]] double signed_volume(const TriangleMesh& mesh);

}  // namespace alhazen
