#include "alhazen/shapes/shape_tessellation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/polygons/face_loops.h"
#include "alhazen/shapes/polygons/flat_vertices.h"
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

// Texture coordinates. Vertices come with the parameters of their piece.

/// Shapes whose texture coordinates are the parameters of their pieces.
template <class S>
inline constexpr bool kHasPieceUv =
    std::is_same_v<S, BezierPatch> || std::is_same_v<S, PatchMesh> ||
    std::is_same_v<S, NurbsSurface> || std::is_same_v<S, BilinearPatch> ||
    std::is_same_v<S, Rectangle>;

/// Those of a shape at a point of its surface. `along`: the parameter of the profile of a lathe.
template <class S>
Vec2 uv_at(const S& shape, const Vec3& point, std::uint32_t part, double along = 0.0) {
    ShapeHit hit;
    hit.u = along;
    hit.part = part;
    return shape.surface(Ray{point, {0, 0, 1}}, hit).uv;
}

/// The limit of a coordinate, from its value at a point on the border of a piece and from that at a
/// near one inside: at a seam both differ by whole turns, at a pole by anything.
double limit_of(double on_border, double inside) {
    constexpr double kNear = 1e-4;
    const double turns = std::round(inside - on_border);
    return std::abs(inside - (on_border + turns)) < kNear ? on_border + turns : inside;
}

/// Replaces the parameters of the vertices from `first` on by the texture coordinates of the shape.
template <class S>
void set_uvs(const S& shape, const BezierPiece& piece, std::size_t first, TriangleMesh& mesh) {
    const Vec2 size = piece.hi - piece.lo;
    const auto inside = [](double x) {
        constexpr double kStep = 1e-6;
        return x == 0.0 ? kStep : x == 1.0 ? 1.0 - kStep : x;
    };
    for (std::size_t k = first; k < mesh.uvs.size(); ++k) {
        Vec2& uv = mesh.uvs[k];
        const Vec2 at{(uv.x - piece.lo.x) / size.x, (uv.y - piece.lo.y) / size.y};
        const Vec2 near{inside(at.x), inside(at.y)};
        uv = uv_at(shape, mesh.positions[k], piece.part, uv.y);
        if (near == at) continue;
        const Vec2 limit = uv_at(shape, point_at(piece.net, near.x, near.y), piece.part,
                                 piece.lo.y + near.y * size.y);
        uv = {limit_of(uv.x, limit.x), limit_of(uv.y, limit.y)};
    }
}

/// Parameters of the triangle from those of the square whose edge v = 1 is a corner.
void set_uvs(const SteinerPatch&, const BezierPiece&, std::size_t first, TriangleMesh& mesh) {
    for (std::size_t k = first; k < mesh.uvs.size(); ++k) mesh.uvs[k].x *= 1.0 - mesh.uvs[k].y;
}

template <HasPatchForm S>
std::string append(const S& shape, double tolerance, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    std::vector<BezierPiece> pieces;
    append_pieces(shape, pieces);
    for (const BezierPiece& piece : pieces) {
        const std::size_t first = mesh.triangles.size(), vertex = mesh.normals.size();
        if (!append_triangles(piece, tolerance, max_triangles, mesh)) return kTooManyTriangles;
        if constexpr (!kHasPieceUv<S>) set_uvs(shape, piece, vertex, mesh);
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
    if (shape.region == nullptr) {
        const std::string failed = append<NurbsSurface>(shape, tolerance, max_triangles, own);
        if (!failed.empty()) return failed;
    } else if (!append_trimmed_triangles(shape, tolerance, max_triangles, own)) {
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
        const BezierPiece piece{.net = bezier_net(1, 1, points),
                                .part = static_cast<std::uint32_t>(face)};
        const std::size_t vertex = mesh.uvs.size();
        if (!append_triangles(piece, tolerance, max_triangles, mesh)) return kTooManyTriangles;
        set_uvs(shape, piece, vertex, mesh);
    }
    return {};
}

/// Appends a planar face without holes, with the same normal at each corner and the texture
/// coordinates `uv_of(k)`.
template <class UvOf>
void append_face(std::span<const Vec3> corners, const UvOf& uv_of, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<std::uint32_t> loop;
    for (const Vec3& p : corners) {
        loop.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(p);
    }
    const Vec3 normal = plane_normal(mesh.positions, loop);
    const double size = length(normal);
    const Vec3 unit = size > 0.0 ? normal / size : Vec3{0, 0, 1};
    for (std::size_t k = first; k < mesh.positions.size(); ++k) {
        mesh.normals.push_back(unit);
        mesh.uvs.push_back(uv_of(k - first));
    }
    triangulate(mesh.positions, loop, mesh.triangles);
}

std::string append(const Polygon& shape, double, std::uint64_t, TriangleMesh& mesh) {
    if (shape.loop_ends.size() > 1) return "has holes";
    const std::vector<Vec3> corners = flat_vertices(shape);
    const RepairedPolygon repaired =
        repaired_polygon(corners, shape.loop_ends, {shape.normal, dot(shape.normal, shape.point)});
    const auto add = [&](const std::vector<Vec3>& loop) {
        append_face(
            loop, [&](std::size_t k) { return uv_at(shape, loop[k], 0); }, mesh);
    };
    if (!repaired.crosses) {
        add(corners);
        return {};
    }
    for (const std::vector<Vec3>& part : repaired.parts) add(part);
    return {};
}

/// The index of the plane of a face: planes of faces without area are left out.
std::uint32_t plane_of(const Polyhedron& shape, std::span<const Vec3> face, std::size_t index) {
    if (shape.faces.size() == shape.face_ends.size()) return static_cast<std::uint32_t>(index);
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t k = 0; k < shape.faces.size(); ++k) {
        double off = 0.0;
        for (const Vec3& p : face) {
            off = std::max(off, std::abs(dot(shape.faces[k].normal, p - shape.faces[k].point)));
        }
        if (off < least) least = off, nearest = k;
    }
    return nearest;
}

/// Appends the faces of a polyhedron given by planes.
std::string append_faces_of_planes(const Polyhedron& shape, TriangleMesh& mesh) {
    const auto loops = closed_face_loops(shape);
    if (!loops) return shape.box().bounded() ? kNeedsLines : "is endless";
    for (const FaceLoop& loop : *loops) {
        append_face(
            loop.corners, [&](std::size_t k) { return uv_at(shape, loop.corners[k], loop.face); },
            mesh);
    }
    return {};
}

std::string append(const Polyhedron& shape, double, std::uint64_t, TriangleMesh& mesh) {
    if (shape.face_ends.empty()) return append_faces_of_planes(shape, mesh);
    std::size_t corner = 0, index = 0;
    for (const std::uint32_t end : shape.face_ends) {
        std::vector<Vec3> face;
        for (; corner < end; ++corner) face.push_back(shape.vertices[shape.corners[corner]]);
        const std::uint32_t part = plane_of(shape, face, index++);
        // Faces may be given in either order.
        std::vector<std::uint32_t> loop(face.size());
        std::iota(loop.begin(), loop.end(), 0u);
        if (dot(plane_normal(face, loop), shape.faces[part].normal) < 0.0) {
            std::reverse(face.begin(), face.end());
        }
        append_face(
            face, [&](std::size_t k) { return uv_at(shape, face[k], part); }, mesh);
    }
    return {};
}

std::string append(const HeightField& shape, double, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    const std::uint64_t count =
        4 * std::uint64_t{shape.cells()} + 4 * (std::uint64_t{shape.columns} + shape.rows - 2);
    if (count > max_triangles) return kTooManyTriangles;
    for (std::uint32_t part = 0; part < count; ++part) {
        const auto uv_of = [&](std::size_t k) {
            const ShapeHit hit{0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0, part};
            return shape.surface(Ray{}, hit).uv;
        };
        append_face(shape.triangle(part), uv_of, mesh);
    }
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
