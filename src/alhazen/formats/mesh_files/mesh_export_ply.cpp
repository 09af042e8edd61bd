// A mesh as PLY, with all bits of its numbers; the format to which scenes are converted.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/ply/ply_header.h"
#include "alhazen/formats/ply/ply_vertices.h"
#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

namespace {

/// True if a float holds the value exactly. Compares bits: g++ 12 at -O2 replaces double(float(x))
/// by x where two of them are adjacent. Floats below 2^-126 count as inexact.
bool is_float(double value) {
    const double size = std::abs(value);
    const std::uint64_t lost = std::bit_cast<std::uint64_t>(value) & ((std::uint64_t{1} << 29) - 1);
    return size == 0.0 || (lost == 0 && size >= 0x1p-126 && size < 0x1p128);
}
bool are_floats(const std::vector<Vec3>& list) {
    return std::all_of(list.begin(), list.end(), [](const Vec3& v) {
        return is_float(v.x) && is_float(v.y) && is_float(v.z);
    });
}
bool are_floats(const std::vector<Vec2>& list) {
    return std::all_of(list.begin(), list.end(),
                       [](const Vec2& v) { return is_float(v.x) && is_float(v.y); });
}

std::uint8_t code_of(double linear) {
    const double code = 255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0));
    return std::uint8_t(std::clamp(code + 0.5, 0.0, 255.0));
}
std::uint8_t alpha_code_of(double alpha) {
    return std::uint8_t(255.0 * std::clamp(alpha, 0.0, 1.0) + 0.5);
}
/// True if 8-bit codes hold these colours exactly.
bool are_codes(const std::vector<VertexColor>& colors) {
    return std::all_of(colors.begin(), colors.end(), [](const VertexColor& c) {
        for (const float channel : {c.r, c.g, c.b}) {
            if (!(linear_of_code(code_of(channel)) == channel)) return false;
        }
        return float(alpha_code_of(c.a) / 255.0) == c.a;
    });
}

class Writer {
  public:
    explicit Writer(const TriangleMesh& mesh)
        : mesh_(mesh),
          float_positions_(are_floats(mesh.positions)),
          float_normals_(are_floats(mesh.normals)),
          float_uvs_(are_floats(mesh.uvs)),
          float_uvs2_(are_floats(mesh.uvs2)),
          coded_colors_(are_codes(mesh.colors)) {}

    std::string write() {
        header();
        out_.reserve(out_.size() + vertex_bytes_ * mesh_.positions.size() +
                     13 * mesh_.triangles.size());
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i) vertex(i);
        for (const auto& triangle : mesh_.triangles) {
            out_ += char(3);
            for (const std::uint32_t index : triangle) bits(index);
        }
        return std::move(out_);
    }

  private:
    void header() {
        out_ = "ply\nformat binary_little_endian 1.0\ncomment " + std::string(kPlyExact) +
               "\nelement vertex " + std::to_string(mesh_.positions.size()) + '\n';
        properties(float_positions_ ? "float" : "double", {"x", "y", "z"});
        const auto real = [](bool is_float) { return is_float ? "float" : "double"; };
        if (!mesh_.normals.empty()) properties(real(float_normals_), {"nx", "ny", "nz"});
        if (!mesh_.uvs.empty()) properties(real(float_uvs_), {"u", "v"});
        if (!mesh_.uvs2.empty()) properties(real(float_uvs2_), {"u2", "v2"});
        if (!mesh_.colors.empty()) {
            properties(coded_colors_ ? "uchar" : "float", {"red", "green", "blue", "alpha"});
        }
        if (!mesh_.tangents.empty()) properties("float", {"tx", "ty", "tz", "tsign"});
        if (!mesh_.vertex_materials.empty()) properties("uint", {"vertex_material"});
        const bool fits_int = mesh_.positions.size() <= 0x7FFFFFFFu;
        out_ += "element face " + std::to_string(mesh_.triangles.size()) +
                "\nproperty list uchar " + (fits_int ? "int" : "uint") +
                " vertex_indices\nend_header\n";
    }
    void properties(const std::string& type, std::initializer_list<const char*> names) {
        const std::size_t size = type == "double" ? 8 : type == "uchar" ? 1 : 4;
        for (const char* name : names) {
            out_ += "property " + type + ' ' + name + '\n';
            vertex_bytes_ += size;
        }
    }
    void vertex(std::size_t i) {
        const Vec3& p = mesh_.positions[i];
        reals(float_positions_, {p.x, p.y, p.z});
        if (!mesh_.normals.empty()) {
            const Vec3& n = mesh_.normals[i];
            reals(float_normals_, {n.x, n.y, n.z});
        }
        if (!mesh_.uvs.empty()) reals(float_uvs_, {mesh_.uvs[i].x, mesh_.uvs[i].y});
        if (!mesh_.uvs2.empty()) reals(float_uvs2_, {mesh_.uvs2[i].x, mesh_.uvs2[i].y});
        if (!mesh_.colors.empty()) color(mesh_.colors[i]);
        if (!mesh_.tangents.empty()) {
            const VertexTangent& t = mesh_.tangents[i];
            for (const float c : {t.x, t.y, t.z, t.sign}) bits(std::bit_cast<std::uint32_t>(c));
        }
        if (!mesh_.vertex_materials.empty()) bits(mesh_.vertex_materials[i]);
    }
    void color(const VertexColor& c) {
        if (!coded_colors_) {
            for (const float channel : {c.r, c.g, c.b, c.a}) {
                bits(std::bit_cast<std::uint32_t>(channel));
            }
            return;
        }
        for (const float channel : {c.r, c.g, c.b}) out_ += char(code_of(channel));
        out_ += char(alpha_code_of(c.a));
    }
    void reals(bool as_float, std::initializer_list<double> values) {
        for (const double value : values) {
            if (as_float) {
                bits(std::bit_cast<std::uint32_t>(float(value)));
            } else {
                bits(std::bit_cast<std::uint64_t>(value));
            }
        }
    }
    /// Little endian.
    template <class T>
    void bits(T value) {
        char bytes[sizeof(T)];
        for (std::size_t k = 0; k < sizeof(T); ++k) bytes[k] = char(value >> (8 * k) & 0xFFu);
        out_.append(bytes, sizeof(T));
    }

    const TriangleMesh& mesh_;
    bool float_positions_, float_normals_, float_uvs_, float_uvs2_, coded_colors_;
    std::size_t vertex_bytes_ = 0;
    std::string out_;
};

}  // namespace

std::string ply_bytes(const TriangleMesh& mesh) {
    return Writer(mesh).write();
}

}  // namespace alhazen
