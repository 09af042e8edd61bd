#include "alhazen/formats/mesh_files/mesh_export.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "alhazen/formats/mesh_files/mesh_export_text.h"
#include "alhazen/formats/stl/stl_reader.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

constexpr std::uint64_t kMaxFileElements = 0xFFFFFFFFu;

bool mirrors(const Affine& placement) {
    return determinant(placement.linear) < 0.0;
}

/// The vertices of a triangle, reversed under a mirroring placement.
std::array<std::uint32_t, 3> placed(const std::array<std::uint32_t, 3>& t, bool mirrored) {
    return mirrored ? std::array{t[0], t[2], t[1]} : t;
}

/// The unit normal of a placed mesh; zero if it has no direction.
Vec3 placed_normal(const Mat3& mesh_from_file, const Vec3& normal) {
    return unit_or(transpose_times(mesh_from_file, normal), {});
}

/// The reciprocal of the greatest length of the normals of a placed mesh; nothing if all have one
/// length, within rounding, or none has a length in the range of doubles.
std::optional<double> common_factor(const NamedMesh& from) {
    constexpr double kSameLength = 1e-9;
    const Mat3 mesh_from_file = inverse(from.placement.linear);
    double least = std::numeric_limits<double>::infinity(), greatest = 0.0;
    for (const Vec3& normal : from.mesh->normals) {
        const Vec3 n = transpose_times(mesh_from_file, normal);
        const double size = std::hypot(n.x, n.y, n.z);
        if (!(size > 0.0) || !std::isfinite(size)) continue;
        least = std::min(least, size);
        greatest = std::max(greatest, size);
    }
    const double factor = 1.0 / greatest;
    if (!(least < (1.0 - kSameLength) * greatest) || !std::isfinite(factor)) return std::nullopt;
    return factor;
}

// --- Many meshes as one.

struct Arrays {
    bool normals = false, uvs = false, uvs2 = false, colors = false;
    bool tangents = false;  ///< of all meshes
};

VertexTangent placed_tangent(const Affine& placement, bool mirrored, const VertexTangent& t) {
    if (placement.linear == Mat3{}) return t;
    const Vec3 placed = unit_or(placement.linear * Vec3{t.x, t.y, t.z}, {});
    return {float(placed.x), float(placed.y), float(placed.z), mirrored ? -t.sign : t.sign};
}

/// Adds one vertex of a placed mesh.
void add_vertex(const NamedMesh& from, std::uint32_t i, const Arrays& arrays, const Vec3& normal,
                TriangleMesh& out) {
    const TriangleMesh& mesh = *from.mesh;
    out.positions.push_back(from.placement.point(mesh.positions[i]));
    if (arrays.normals) out.normals.push_back(normal);
    if (arrays.uvs) out.uvs.push_back(mesh.uvs.empty() ? Vec2{} : mesh.uvs[i]);
    if (arrays.uvs2) out.uvs2.push_back(mesh.uvs2.empty() ? Vec2{} : mesh.uvs2[i]);
    if (arrays.colors) out.colors.push_back(mesh.colors.empty() ? VertexColor{} : mesh.colors[i]);
    if (arrays.tangents) {
        out.tangents.push_back(
            placed_tangent(from.placement, mirrors(from.placement), mesh.tangents[i]));
    }
}

void add_mesh(const NamedMesh& from, const Arrays& arrays, TriangleMesh& out) {
    const TriangleMesh& mesh = *from.mesh;
    const Mat3 mesh_from_file = inverse(from.placement.linear);
    const bool mirrored = mirrors(from.placement);
    if (!arrays.normals || !mesh.normals.empty()) {
        const std::optional<double> factor = common_factor(from);
        const std::uint32_t first = std::uint32_t(out.positions.size());
        for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
            Vec3 normal;
            if (arrays.normals) {
                normal = factor ? *factor * transpose_times(mesh_from_file, mesh.normals[i])
                                : placed_normal(mesh_from_file, mesh.normals[i]);
            }
            add_vertex(from, i, arrays, is_finite(normal) ? normal : Vec3{}, out);
        }
        for (const auto& t : mesh.triangles) {
            const auto [a, b, c] = placed(t, mirrored);
            out.triangles.push_back({first + a, first + b, first + c});
        }
        return;
    }
    // A flat mesh among smooth ones: each triangle gets its own vertices.
    for (const auto& t : mesh.triangles) {
        const std::uint32_t first = std::uint32_t(out.positions.size());
        const Vec3& p = mesh.positions[t[0]];
        const Vec3 normal = placed_normal(
            mesh_from_file, cross(mesh.positions[t[1]] - p, mesh.positions[t[2]] - p));
        for (const std::uint32_t i : placed(t, mirrored)) {
            add_vertex(from, i, arrays, normal, out);
        }
        out.triangles.push_back({first, first + 1, first + 2});
    }
}

template <class Predicate>
std::uint64_t meshes_with_color(std::span<const NamedMesh> meshes, Predicate is_one) {
    return std::uint64_t(std::count_if(meshes.begin(), meshes.end(), [&](const NamedMesh& from) {
        return std::any_of(from.mesh->colors.begin(), from.mesh->colors.end(), is_one);
    }));
}

// --- Text.

void append_index(std::string& out, std::uint64_t value) {
    std::array<char, 24> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    out.append(buffer.data(), end);
}
void append_vector(std::string& out, const char* word, const Vec3& v) {
    out += word;
    for (const double c : {v.x, v.y, v.z}) append_number(out, c);
}

/// Indices of the next vertex, texture coordinate and normal, from 1.
struct ObjOffsets {
    std::uint64_t positions = 1, uvs = 1, normals = 1;
};

/// True if all triangles share three texture coordinates, the barycentrics of their vertices.
bool has_barycentrics(const NamedMesh& from) {
    return from.needs_coordinates && from.mesh->uvs.empty();
}

std::span<const Vec2> coordinates_of(const NamedMesh& from) {
    static constexpr std::array<Vec2, 3> kBarycentrics{Vec2{0, 0}, Vec2{1, 0}, Vec2{0, 1}};
    return has_barycentrics(from) ? std::span<const Vec2>(kBarycentrics) : from.mesh->uvs;
}

void append_vertices(const NamedMesh& from, std::string& out) {
    const TriangleMesh& mesh = *from.mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        append_vector(out, "v", from.placement.point(mesh.positions[i]));
        if (!mesh.colors.empty()) {
            const VertexColor& c = mesh.colors[i];
            for (const float channel : {c.r, c.g, c.b}) {
                const double code = srgb_from_linear(std::fmin(std::fmax(channel, 0.0), 1.0));
                append_number(out, std::fmin(code, 1.0));
            }
        }
        out += '\n';
    }
    for (const Vec2& uv : coordinates_of(from)) {
        out += "vt";
        append_number(out, uv.x);
        append_number(out, uv.y);
        out += '\n';
    }
    const Mat3 mesh_from_file = inverse(from.placement.linear);
    for (const Vec3& normal : mesh.normals) {
        append_vector(out, "vn", placed_normal(mesh_from_file, normal));
        out += '\n';
    }
}

bool has_vertex_materials(const NamedMesh& from) {
    return !from.vertex_material_names.empty() && !from.mesh->vertex_materials.empty();
}

/// The material of a face: where vertices have materials, that of its first vertex.
std::string face_material(const NamedMesh& from, const std::array<std::uint32_t, 3>& face) {
    if (!has_vertex_materials(from)) return one_name(from.material);
    return one_name(from.vertex_material_names[from.mesh->vertex_materials[face[0]]]);
}

void append_object(const NamedMesh& from, const std::string& name, ObjOffsets& offsets,
                   std::string& out) {
    const TriangleMesh& mesh = *from.mesh;
    out += "o " + name + '\n';
    append_vertices(from, out);
    const bool mirrored = mirrors(from.placement);
    const bool by_face = has_vertex_materials(from), barycentric = has_barycentrics(from);
    const std::size_t uvs = coordinates_of(from).size();
    std::uint32_t current = 0;
    bool first = true;
    for (const auto& t : mesh.triangles) {
        const std::uint32_t own = by_face ? mesh.vertex_materials[t[0]] : 0;
        if (first || own != current) {
            if (const std::string material = face_material(from, t); !material.empty()) {
                out += "usemtl " + material + '\n';
            }
            first = false;
            current = own;
        }
        out += 'f';
        for (const std::uint32_t corner : placed({0, 1, 2}, mirrored)) {
            const std::uint32_t i = t[corner];
            out += ' ';
            append_index(out, offsets.positions + i);
            if (uvs > 0 || !mesh.normals.empty()) out += '/';
            if (uvs > 0) append_index(out, offsets.uvs + (barycentric ? corner : i));
            if (!mesh.normals.empty()) {
                out += '/';
                append_index(out, offsets.normals + i);
            }
        }
        out += '\n';
    }
    offsets.positions += mesh.positions.size();
    offsets.uvs += uvs;
    offsets.normals += mesh.normals.size();
}

// --- STL.

void append_float(std::string& out, double value) {
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(float(value));
    for (int shift = 0; shift < 32; shift += 8) out += char(bits >> shift & 0xFFu);
}

}  // namespace

std::string ply_bytes(std::span<const NamedMesh> meshes) {
    Arrays arrays;
    std::uint64_t vertices = 0, triangles = 0;
    for (const NamedMesh& from : meshes) {
        arrays.normals = arrays.normals || !from.mesh->normals.empty();
        arrays.uvs = arrays.uvs || !from.mesh->uvs.empty();
        arrays.uvs2 = arrays.uvs2 || !from.mesh->uvs2.empty();
        arrays.colors = arrays.colors || !from.mesh->colors.empty();
    }
    arrays.tangents = meshes_without_tangents(meshes) == 0;
    for (const NamedMesh& from : meshes) {
        const bool split = arrays.normals && from.mesh->normals.empty();
        vertices += split ? 3 * from.mesh->triangles.size() : from.mesh->positions.size();
        triangles += from.mesh->triangles.size();
    }
    if (vertices > kMaxFileElements || triangles > kMaxFileElements) {
        throw Error(ErrorKind::Resource, "more than 4294967295 vertices for one PLY file");
    }
    TriangleMesh whole;
    whole.positions.reserve(vertices);
    whole.triangles.reserve(triangles);
    for (const NamedMesh& from : meshes) add_mesh(from, arrays, whole);
    return ply_bytes(whole);
}

std::string obj_text(std::span<const NamedMesh> meshes, const std::string& mtllib) {
    std::string out = "# Alhazen\n";
    if (!mtllib.empty()) out += "mtllib " + one_line(mtllib) + '\n';
    const std::vector<std::string> names = object_names(meshes, "mesh");
    ObjOffsets offsets;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        append_object(meshes[i], names[i], offsets, out);
    }
    return out;
}

std::uint64_t meshes_without_tangents(std::span<const NamedMesh> meshes) {
    return std::uint64_t(std::count_if(meshes.begin(), meshes.end(), [](const NamedMesh& from) {
        return from.mesh->tangents.empty();
    }));
}

std::uint64_t meshes_with_vertex_alpha(std::span<const NamedMesh> meshes) {
    return meshes_with_color(meshes, [](const VertexColor& c) { return c.a < 1.0f; });
}

std::uint64_t meshes_with_colors_beyond_one(std::span<const NamedMesh> meshes) {
    return meshes_with_color(meshes, [](const VertexColor& c) {
        return std::min({c.r, c.g, c.b}) < 0.0f || std::max({c.r, c.g, c.b}) > 1.0f;
    });
}

std::uint64_t meshes_with_normals_of_several_lengths(std::span<const NamedMesh> meshes) {
    return std::uint64_t(std::count_if(meshes.begin(), meshes.end(), [](const NamedMesh& from) {
        return common_factor(from).has_value();
    }));
}

std::uint64_t faces_of_several_materials(std::span<const NamedMesh> meshes) {
    std::uint64_t count = 0;
    for (const NamedMesh& from : meshes) {
        const auto& own = from.mesh->vertex_materials;
        if (own.empty()) continue;
        for (const auto& [a, b, c] : from.mesh->triangles) {
            if (own[a] != own[b] || own[a] != own[c]) ++count;
        }
    }
    return count;
}

std::string stl_bytes(std::span<const NamedMesh> meshes) {
    std::uint64_t count = 0;
    for (const NamedMesh& from : meshes) count += from.mesh->triangles.size();
    if (count > kMaxFileElements) {
        throw Error(ErrorKind::Resource, "more than 4294967295 triangles for one STL file");
    }
    std::string out(kStlHeader);
    out.reserve(84 + 50 * count);
    out.resize(80, ' ');
    for (int shift = 0; shift < 32; shift += 8) out += char(count >> shift & 0xFFu);
    for (const NamedMesh& from : meshes) {
        const bool mirrored = mirrors(from.placement);
        for (const auto& t : from.mesh->triangles) {
            std::array<Vec3, 4> v;
            for (std::size_t k = 0; k < 3; ++k) {
                v[k + 1] = from.placement.point(from.mesh->positions[placed(t, mirrored)[k]]);
            }
            for (std::size_t k = 1; k < 4; ++k) {
                if (max_component(abs(v[k])) <= double(std::numeric_limits<float>::max())) continue;
                throw Error(ErrorKind::Scene,
                            (from.name.empty() ? "a mesh" : "mesh '" + from.name + "'") +
                                ": STL holds coordinates up to 3.4e38 only");
            }
            const Vec3 area = cross(v[2] - v[1], v[3] - v[1]);
            const double size = length(area);
            if (size > 0.0 && std::isfinite(size)) v[0] = area / size;
            for (const Vec3& p : v) {
                for (const double c : {p.x, p.y, p.z}) append_float(out, c);
            }
            out.append(2, '\0');
        }
    }
    return out;
}

std::uint64_t triangles_that_floats_collapse(std::span<const NamedMesh> meshes) {
    const auto rounded = [](const Vec3& p) {
        return std::array{float(p.x), float(p.y), float(p.z)};
    };
    std::uint64_t count = 0;
    for (const NamedMesh& from : meshes) {
        for (const auto& t : from.mesh->triangles) {
            bool collapses = false, had_area = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a = from.placement.point(from.mesh->positions[t[k]]);
                const Vec3 b = from.placement.point(from.mesh->positions[t[(k + 1) % 3]]);
                had_area = had_area && a != b;
                collapses = collapses || rounded(a) == rounded(b);
            }
            count += had_area && collapses;
        }
    }
    return count;
}

double greatest_move_by_floats(std::span<const NamedMesh> meshes) {
    // Covers the rounding of the distance itself.
    constexpr double kRoundUp = 1.0 + 1e-15;
    double greatest = 0.0;
    for (const NamedMesh& from : meshes) {
        for (const auto& t : from.mesh->triangles) {
            for (const std::uint32_t i : t) {
                const Vec3 p = from.placement.point(from.mesh->positions[i]);
                // Volatile, because g++ 12 takes double(float(x)) for x where two are adjacent.
                const volatile float x = float(p.x), y = float(p.y), z = float(p.z);
                const double move = std::hypot(double(x) - p.x, double(y) - p.y, double(z) - p.z);
                greatest = std::max(greatest, move);
            }
        }
    }
    return greatest * kRoundUp;
}

}  // namespace alhazen
