#include "alhazen/shapes/shape_tessellation.h"

#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/shapes/patches/exact_forms.h"
#include "alhazen/shapes/tessellation/patch_tessellation.h"

namespace alhazen {

namespace {

/// Turns the triangles from `first` on, with the vertices from `first_vertex` on, inside out.
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

std::string append(const NurbsSurface& shape, double tolerance, std::uint64_t max_triangles,
                   TriangleMesh& mesh) {
    if (!shape.trims.empty()) return "has trimming loops";
    return append<NurbsSurface>(shape, tolerance, max_triangles, mesh);
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
    append_face(shape.vertices, mesh);
    return {};
}

std::string append(const Polyhedron& shape, double, std::uint64_t, TriangleMesh& mesh) {
    if (shape.face_ends.empty()) return "is given by its planes";
    std::size_t corner = 0;
    for (const std::uint32_t end : shape.face_ends) {
        std::vector<Vec3> face;
        for (; corner < end; ++corner) face.push_back(shape.vertices[shape.corners[corner]]);
        append_face(face, mesh);
    }
    return {};
}

/// Any other shape.
std::string append(const auto& shape, double, std::uint64_t, TriangleMesh&) {
    return shape.box().bounded() ? "has no triangulation yet" : "is endless";
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
