#pragma once
/// Triangle meshes as the bytes of mesh files: PLY for ourselves, PLY, OBJ and STL for others.
///
/// Conventions: binary little-endian PLY, text OBJ, binary STL. Numbers are written with all their
/// bits where the format has room: PLY uses float for arrays whose values are floats, else double;
/// OBJ the shortest decimals that read back equal; STL has floats only, so positions are rounded.
/// Placements are applied to positions, normals and tangents; one that mirrors also turns the
/// triangles around, so that the outside stays outside. Names of properties:
/// docs/reference/formats/ply.md.

#include <span>
#include <string>
#include <vector>

#include "alhazen/math/affine.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// A mesh as one object of a file.
struct NamedMesh {
    std::string name;
    const TriangleMesh* mesh = nullptr;  ///< never null
    Affine placement;                    ///< file_from_mesh
    std::string material;                ///< OBJ: its `usemtl`; empty: none
};

/// One mesh as it is; read_ply gives every array back bit for bit.
[[nodiscard]] std::string ply_bytes(const TriangleMesh& mesh);
/// All meshes as one. Arrays that only some have are filled in where they lack: white, face
/// normals, zero texture coordinates; tangents and vertex materials are left out. Throws Error
/// (Resource) beyond 2^32 - 1 vertices.
[[nodiscard]] std::string ply_bytes(std::span<const NamedMesh> meshes);

/// One `o` per mesh. `mtllib` names the material file; empty: none.
[[nodiscard]] std::string obj_text(std::span<const NamedMesh> meshes,
                                   const std::string& mtllib = {});
/// A texture beside an MTL file.
struct MtlTexture {
    std::string file;  ///< of the picture, relative to the MTL file; empty: the map is left out
    Texture settings;
};
/// The MTL file of these materials, by their names; `textures` [texture]. Adds a line to `lost` for
/// each kind of thing that MTL cannot say.
[[nodiscard]] std::string mtl_text(std::span<const Material> materials,
                                   std::span<const MtlTexture> textures,
                                   std::vector<std::string>& lost);

/// All triangles as one binary STL. Throws Error (Resource) beyond 2^32 - 1 triangles.
[[nodiscard]] std::string stl_bytes(std::span<const NamedMesh> meshes);

}  // namespace alhazen
