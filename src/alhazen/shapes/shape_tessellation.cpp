#include "alhazen/shapes/shape_tessellation.h"

#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/tessellation/patch_tessellation.h"
#include "alhazen/shapes/tessellation/trimmed_triangles.h"

namespace alhazen {

namespace {

/// Reverses the orientation of the triangles from `first` and the vertices from `first_vertex`.
void turn(TriangleMesh& mesh, std::size_t first, std::size_t first_vertex) {
    for (std::size_t k = first; k < mesh.triangles.size(); ++k) {
        std::swap(mesh.triangles[k][1], mesh.triangles[k][2]);
    }
    for (std::size_t k = first_vertex; k < mesh.normals.size(); ++k) {
        mesh.normals[k] = -mesh.normals[k];
    }
}

template <class S>
bool is_inward(const S& shape, std::uint32_t part) {
    if constexpr (std::is_same_v<S, PatchMesh>) {
        return shape.is_closed && shape.inward[part];
    } else {
        return false;
    }
}

template <HasPatchForm S>
std::string append(const S& shape, double tolerance, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    std::vector<BezierPiece> pieces;
    append_pieces(shape, pieces);
    for (const BezierPiece& piece : pieces) {
        const std::size_t first = mesh.triangles.size(), vertex = mesh.normals.size();
        if (!append_triangles(piece, tolerance, max_triangles, mesh)) return kTooManyTriangles;
        if (is_inward(shape, piece.part)) turn(mesh, first, vertex);
    }
    return {};
}

void append_mesh(const TriangleMesh& from, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), from.positions.begin(), from.positions.end());
    mesh.normals.insert(mesh.normals.end(), from.normals.begin(), from.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), from.uvs.begin(), from.uvs.end());
    for (const auto& [a, b, c] : from.triangles) {
        mesh.triangles.push_back({first + a, first + b, first + c});
    }
}

std::string append(const NurbsSurface& shape, double tolerance, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    TriangleMesh own;
    const std::string failed = append<NurbsSurface>(shape, tolerance, max_triangles, own);
    if (!failed.empty()) return failed;
    if (shape.region != nullptr && !trim_triangles(shape, tolerance, max_triangles, own)) {
        return kTooManyTriangles;
    }
    // Texture coordinates are parameters mapped to the unit square.
    const Vec2 lo{shape.knots_u[shape.degree_u], shape.knots_v[shape.degree_v]};
    const Vec2 size{shape.knots_u[shape.knots_u.size() - shape.degree_u - 1] - lo.x,
                    shape.knots_v[shape.knots_v.size() - shape.degree_v - 1] - lo.y};
    for (Vec2& uv : own.uvs) uv = {(uv.x - lo.x) / size.x, (uv.y - lo.y) / size.y};
    append_mesh(own, mesh);
    return {};
}

std::string append(const BoxShape& shape, double tolerance, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, across = (axis + 1) % 3, up = (axis + 2) % 3;
        const bool high = face % 2 == 1;
        Vec3 points[4];
        for (int k = 0; k < 4; ++k) {
            const bool u = k >= 2, v = k % 2 == 1;  // u x v points outward
            points[k][axis] = high ? shape.hi[axis] : shape.lo[axis];
            points[k][across] = (high ? u : v) ? shape.hi[across] : shape.lo[across];
            points[k][up] = (high ? v : u) ? shape.hi[up] : shape.lo[up];
        }
        const BezierPiece piece{.net = bezier_net(1, 1, points)};
        if (!append_triangles(piece, tolerance, max_triangles, mesh)) return kTooManyTriangles;
    }
    return {};
}

/// Appends a planar face without holes, with the same normal at each corner.
void append_face(std::span<const Vec3> corners, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<std::uint32_t> loop;
    for (const Vec3& p : corners) {
        loop.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(p);
    }
    const Vec3 normal = newell_normal(mesh.positions, loop);
    const double size = length(normal);
    const Vec3 unit = size > 0.0 ? normal / size : Vec3{0, 0, 1};
    for (std::size_t k = first; k < mesh.positions.size(); ++k) {
        mesh.normals.push_back(unit);
        mesh.uvs.push_back({0, 0});
    }
    triangulate(mesh.positions, loop, mesh.triangles);
}

std::string append(const Polygon& shape, double, std::uint64_t, TriangleMesh& mesh) {
    if (shape.loop_ends.size() > 1) return "has holes";
    const RepairedPolygon repaired = repaired_polygon(
        shape.vertices, shape.loop_ends, {shape.normal, dot(shape.normal, shape.point)});
    if (!repaired.crosses) {
        append_face(shape.vertices, mesh);
        return {};
    }
    for (const std::vector<Vec3>& part : repaired.parts) append_face(part, mesh);
    return {};
}

std::string append(const Polyhedron& shape, double, std::uint64_t, TriangleMesh& mesh) {
    if (shape.face_ends.empty()) return shape.box().bounded() ? kNeedsLines : "is endless";
    std::size_t corner = 0;
    for (const std::uint32_t end : shape.face_ends) {
        std::vector<Vec3> face;
        for (; corner < end; ++corner) face.push_back(shape.vertices[shape.corners[corner]]);
        append_face(face, mesh);
    }
    return {};
}

std::string append(const HeightField& shape, double, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    const std::uint64_t count =
        4 * std::uint64_t{shape.cells()} + 4 * (std::uint64_t{shape.columns} + shape.rows - 2);
    if (count > max_triangles) return kTooManyTriangles;
    for (std::uint32_t part = 0; part < count; ++part) append_face(shape.triangle(part), mesh);
    return {};
}

/// Any other shape.
std::string append(const auto& shape, double, std::uint64_t, TriangleMesh&) {
    if (!shape.box().bounded()) return "is endless";
    return shape.closed() ? kNeedsLines : "is open and no patch";
}

}  // namespace

std::string append_triangles(const AnyShape& shape, double tolerance, std::uint64_t max_triangles,
                             TriangleMesh& mesh) {
    const std::size_t triangles = mesh.triangles.size(), vertices = mesh.positions.size();
    std::string failed =
        std::visit([&](const auto& s) { return append(s, tolerance, max_triangles, mesh); }, shape);
    if (!failed.empty()) {
        mesh.triangles.resize(triangles);
        mesh.positions.resize(vertices);
        mesh.normals.resize(vertices);
        mesh.uvs.resize(vertices);
    }
    return failed;
}

}  // namespace alhazen
