#pragma once
/// Triangle meshes from numpy arrays.

#include <pybind11/numpy.h>

#include <memory>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::python {

/// A mesh from arrays; a `mesh` block of the text places it by its name.
struct ArrayMesh {
    std::string name;
    std::shared_ptr<TriangleMesh> mesh;
    FileLocation location;
};

/// A location (file, line) in a program.
[[nodiscard]] FileLocation location_of(const pybind11::tuple& origin);

/// The mesh of vertices (n, 3) and faces (m, 3), with normals (n, 3) and uvs (n, 2) or None,
/// checked and copied. Throws Error.
[[nodiscard]] ArrayMesh make_mesh(const std::string& name, const pybind11::object& vertices,
                                  const pybind11::object& faces, const pybind11::object& normals,
                                  const pybind11::object& uvs, const pybind11::tuple& origin);

/// For pickle: the arguments of `make_mesh`, and the mesh made from them, bit for bit.
[[nodiscard]] pybind11::tuple state_of_mesh(const ArrayMesh& mesh);
[[nodiscard]] ArrayMesh mesh_of_state(const pybind11::tuple& state);

}  // namespace alhazen::python
