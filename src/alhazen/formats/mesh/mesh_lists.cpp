#include "alhazen/formats/mesh/mesh_lists.h"

#include <cmath>
#include <string>

#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Reads a vertex index of a face.
bool read_index(TextNode value, std::string_view what, std::size_t vertices,
                const ValueReader& values, std::uint32_t& out) {
    if (!value.is(NodeKind::Number)) return values.fail(value, what, "a vertex number");
    const double number = value.number();
    if (number == std::floor(number) && number >= 0 && number < static_cast<double>(vertices)) {
        out = static_cast<std::uint32_t>(number);
        return true;
    }
    values.diagnostics.error(value.location(),
                             std::string(what) +
                                 ": a vertex number must be a whole number from 0 to " +
                                 std::to_string(vertices == 0 ? 0 : vertices - 1) +
                                 (vertices == 0 ? ", and there are no points" : ""));
    return false;
}

/// Reads all elements even after an error, to report all errors.
template <class T>
bool read_all(TextNode list, std::string_view what, const ValueReader& values,
              std::vector<T>& out) {
    if (!values.is_list(list, what)) return false;
    bool good = true;
    for (const TextNode value : list) {
        T element;
        if (values.read(value, what, element)) {
            out.push_back(element);
        } else {
            good = false;
        }
    }
    return good;
}

}  // namespace

bool has_one_per_vertex(TextNode list, std::string_view what, std::size_t vertices,
                        const ValueReader& values) {
    const std::size_t count = list.size();
    if (count == vertices) return true;
    values.diagnostics.error(
        list.location(), std::string(what) + ": expected one for each of the " +
                             std::to_string(vertices) + " points, found " + std::to_string(count));
    return false;
}

bool read_points(TextNode list, std::string_view what, const ValueReader& values,
                 TriangleMesh& mesh) {
    return read_all(list, what, values, mesh.positions);
}

bool read_faces(TextNode list, std::string_view what, const ValueReader& values,
                TriangleMesh& mesh) {
    if (!values.is_list(list, what)) return false;
    bool good = true;
    for (const TextNode face : list) {
        std::uint32_t corner[3] = {};
        std::size_t count = 0;
        bool face_good = face.is(NodeKind::List) ||
                         values.fail(face, what, "a list of at least 3 vertex numbers");
        const std::size_t first_triangle = mesh.triangles.size();
        for (const TextNode value : face) {
            std::uint32_t index = 0;
            if (!face_good || !read_index(value, what, mesh.positions.size(), values, index)) {
                face_good = false;
                break;
            }
            corner[count < 2 ? count : 2] = index;
            if (++count < 3) continue;
            mesh.triangles.push_back({corner[0], corner[1], corner[2]});
            corner[1] = corner[2];
        }
        if (face_good && count < 3) {
            face_good = values.fail(face, what, "a list of at least 3 vertex numbers");
        }
        if (!face_good) mesh.triangles.resize(first_triangle);
        good = good && face_good;
    }
    return good;
}

bool read_normals(TextNode list, std::string_view what, const ValueReader& values,
                  NormalLengths lengths, TriangleMesh& mesh) {
    std::vector<Vec3> normals;
    if (!read_all(list, what, values, normals)) return false;
    if (!has_one_per_vertex(list, what, mesh.positions.size(), values)) return false;
    auto value = list.begin();
    for (Vec3& normal : normals) {
        const Vec3 unit = unit_or(normal, {});
        if (unit == Vec3{}) {
            values.diagnostics.error((*value).location(),
                                     std::string(what) + ": a normal must have a direction");
            return false;
        }
        if (lengths == NormalLengths::Unit) normal = unit;
        ++value;
    }
    mesh.normals = std::move(normals);
    return true;
}

bool read_uvs(TextNode list, std::string_view what, const ValueReader& values, TriangleMesh& mesh) {
    if (!read_all(list, what, values, mesh.uvs)) return false;
    return has_one_per_vertex(list, what, mesh.positions.size(), values);
}

}  // namespace alhazen
