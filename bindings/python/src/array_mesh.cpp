#include "array_mesh.h"

#include <cstring>
#include <vector>

#include "errors.h"
#include "ray_array.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

[[noreturn]] void fail(const std::string& message, const FileLocation& where) {
    throw Error(ErrorKind::Scene, message, where);
}

/// Sets the corners of all triangles, each from 0 to `vertices` - 1.
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
                         std::to_string(corner) +
                         (vertices == 0 ? "; there are no vertices"
                                        : "; expected 0 to " + std::to_string(vertices - 1)),
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

/// An array with one row of numbers per element of `values`.
template <class Number, class Value>
py::array_t<Number> array_of(const std::vector<Value>& values) {
    constexpr std::size_t kColumns = sizeof(Value) / sizeof(Number);
    py::array_t<Number> array({values.size(), kColumns});
    if (!values.empty()) {
        std::memcpy(array.mutable_data(), values.data(), values.size() * sizeof(Value));
    }
    return array;
}

std::shared_ptr<TriangleMesh> mesh_of_arrays(const py::object& vertices, const py::object& faces,
                                             const py::object& normals, const py::object& uvs,
                                             const FileLocation& where, bool unit) {
    const NumberArray points(vertices, {3}, "vertices");
    if (points.shape().size() != 1) fail("vertices: expected the shape (n, 3)", where);
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions.resize(points.count());
    for (std::size_t i = 0; i < points.count(); ++i) mesh->positions[i] = points.vector(i, 0);
    refuse_masked(faces, "faces");
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
            mesh->normals.push_back(unit ? array.vector(i, 0) : normalize(array.vector(i, 0)));
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

}  // namespace

FileLocation location_of(const py::tuple& origin) {
    return {origin[0].cast<std::string>(), origin[1].cast<int>(), 0};
}

ArrayMesh make_mesh(const std::string& name, const py::object& vertices, const py::object& faces,
                    const py::object& normals, const py::object& uvs, const py::tuple& origin) {
    const FileLocation where = location_of(origin);
    return {name, mesh_of_arrays(vertices, faces, normals, uvs, where, false), where};
}

py::tuple state_of_mesh(const ArrayMesh& array_mesh) {
    const TriangleMesh& mesh = *array_mesh.mesh;
    const FileLocation& where = array_mesh.location;
    py::object normals = py::none(), uvs = py::none();
    if (!mesh.normals.empty()) normals = array_of<double>(mesh.normals);
    if (!mesh.uvs.empty()) uvs = array_of<double>(mesh.uvs);
    return py::make_tuple(array_mesh.name, array_of<double>(mesh.positions),
                          array_of<std::uint32_t>(mesh.triangles), normals, uvs,
                          py::make_tuple(where.file, where.line));
}

ArrayMesh mesh_of_state(const py::tuple& state) {
    const FileLocation where = location_of(state[5].cast<py::tuple>());
    return {state[0].cast<std::string>(),
            mesh_of_arrays(state[1], state[2], state[3], state[4], where, true), where};
}

}  // namespace alhazen::python
