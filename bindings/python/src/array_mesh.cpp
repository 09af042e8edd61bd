#include "alhazen/base/error.h"
#include "built_scene.h"
#include "ray_array.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

[[noreturn]] void fail(const std::string& message, const FileLocation& where) {
    throw Error(ErrorKind::Scene, message, where);
}

/// The corners of triangle i, each from 0 to `vertices` - 1.
template <class Index>
void set_faces(const py::array& faces, std::size_t vertices, const FileLocation& where,
               TriangleMesh& mesh) {
    const auto corners = py::array_t<Index, py::array::c_style | py::array::forcecast>(faces);
    const Index* from = corners.data();
    mesh.triangles.resize(static_cast<std::size_t>(faces.shape(0)));
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Index corner = from[3 * i + k];
            if (std::cmp_less(corner, 0) || std::cmp_greater_equal(corner, vertices)) {
                fail("faces[" + std::to_string(i) + "][" + std::to_string(k) + "] is " +
                         std::to_string(corner) + "; expected 0 to " + std::to_string(vertices) +
                         " - 1",
                     where);
            }
            mesh.triangles[i][k] = static_cast<std::uint32_t>(corner);
        }
    }
}

NumberArray per_vertex(const py::object& numbers, py::ssize_t columns, std::size_t vertices,
                       const char* what, const FileLocation& where) {
    NumberArray array(numbers, {columns}, what);
    if (array.shape().size() != 1 || array.count() != vertices) {
        fail(std::string(what) + ": expected one for each of the " + std::to_string(vertices) +
                 " vertices",
             where);
    }
    return array;
}

}  // namespace

std::shared_ptr<TriangleMesh> mesh_of_arrays(const py::object& vertices, const py::object& faces,
                                             const py::object& normals, const py::object& uvs,
                                             const FileLocation& where) {
    const NumberArray points(vertices, {3}, "vertices");
    if (points.shape().size() != 1) fail("vertices: expected the shape (n, 3)", where);
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions.resize(points.count());
    for (std::size_t i = 0; i < points.count(); ++i) mesh->positions[i] = points.vector(i, 0);
    const auto corners = py::array::ensure(faces);
    if (!corners || corners.ndim() != 2 || corners.shape(1) != 3) {
        PyErr_Clear();
        fail("faces: expected the shape (m, 3)", where);
    }
    const char kind = corners.dtype().kind();
    if (kind == 'i') {
        set_faces<std::int64_t>(corners, points.count(), where, *mesh);
    } else if (kind == 'u') {
        set_faces<std::uint64_t>(corners, points.count(), where, *mesh);
    } else {
        fail("faces: expected whole numbers, such as int64 or uint32", where);
    }
    if (!normals.is_none()) {
        const NumberArray array = per_vertex(normals, 3, points.count(), "normals", where);
        for (std::size_t i = 0; i < array.count(); ++i) {
            mesh->normals.push_back(normalize(array.vector(i, 0)));
        }
    }
    if (!uvs.is_none()) {
        const NumberArray array = per_vertex(uvs, 2, points.count(), "uvs", where);
        for (std::size_t i = 0; i < array.count(); ++i) {
            mesh->uvs.push_back({array.at(i, 0), array.at(i, 1)});
        }
    }
    Diagnostics found;
    mesh->validate(where, found);
    throw_found(found);
    return mesh;
}

}  // namespace alhazen::python
