#pragma once
/// Triangle meshes as bytes of mesh files: PLY for the library, and PLY, OBJ and STL for export.
///
/// Conventions: binary little-endian PLY, text OBJ, binary STL. Numbers keep all bits where the
/// format permits: PLY uses float for arrays whose values are floats, otherwise double; OBJ uses
/// the shortest decimals that read back equal; STL has floats only, so positions are rounded.
/// Placements apply to positions, normals and tangents; a mirroring placement also reverses the
/// triangle orientation, so that the outside stays outside. The lengths of placed normals are the
/// weights of their interpolation: PLY keeps their ratios in each mesh, the normals of an OBJ are
/// unit. Property names:
/// docs/reference/formats/ply.md.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alhazen/math/affine.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// A mesh as an object of a file.
struct NamedMesh {
    std::string name;
    const TriangleMesh* mesh = nullptr;  ///< never null
    Affine placement;                    ///< file_from_mesh
    std::string material;                ///< OBJ: name for `usemtl`; empty: none
    /// OBJ: names of the materials that the mesh's vertex_materials number; empty: these are not
    /// used. Referenced.
    std::span<const std::string> vertex_material_names{};
    /// OBJ: its materials have pictures. A mesh without texture coordinates then gets those that it
    /// is shaded with, the barycentrics.
    bool needs_coordinates = false;
};

/// A single mesh, unchanged; read_ply returns every array bit for bit.
[[nodiscard]] std::string ply_bytes(const TriangleMesh& mesh);
/// All meshes merged. Arrays that only some meshes have are filled with defaults: white, face
/// normals, zero texture coordinates. Tangents are kept if every mesh has them. Vertex materials
/// are omitted. Throws Error (Resource) beyond 2^32 - 1 vertices.
[[nodiscard]] std::string ply_bytes(std::span<const NamedMesh> meshes);

/// Text with one `o` per mesh, all of different names. `mtllib`: name of the material file; empty:
/// none. With materials per vertex a face has that of its first vertex.
[[nodiscard]] std::string obj_text(std::span<const NamedMesh> meshes,
                                   const std::string& mtllib = {});
[[nodiscard]] std::uint64_t meshes_without_tangents(std::span<const NamedMesh> meshes);
/// The number of meshes whose vertex colours have an alpha below 1, or a channel beyond 0 to 1.
[[nodiscard]] std::uint64_t meshes_with_vertex_alpha(std::span<const NamedMesh> meshes);
[[nodiscard]] std::uint64_t meshes_with_colors_beyond_one(std::span<const NamedMesh> meshes);
/// The number of meshes whose placed normals differ in length, by more than rounding.
[[nodiscard]] std::uint64_t meshes_with_normals_of_several_lengths(
    std::span<const NamedMesh> meshes);
/// The number of faces between vertices of different materials.
[[nodiscard]] std::uint64_t faces_of_several_materials(std::span<const NamedMesh> meshes);

/// A texture that accompanies an MTL file.
struct MtlTexture {
    std::string file;  ///< image file, relative to the MTL file; empty: the map is omitted
    ImageTexture settings;
};
/// The MTL file of these materials; `textures` [texture]. Appends a line to `lost` for each kind of
/// property that MTL cannot express.
[[nodiscard]] std::string mtl_text(std::span<const Material> materials,
                                   std::span<const MtlTexture> textures,
                                   std::vector<std::string>& lost);

/// All triangles as one binary STL. Throws Error (Resource) beyond 2^32 - 1 triangles.
[[nodiscard]] std::string stl_bytes(std::span<const NamedMesh> meshes);
/// The number of triangles of which floats make two corners one that are apart.
[[nodiscard]] std::uint64_t triangles_that_floats_collapse(std::span<const NamedMesh> meshes);
/// The greatest distance by which floats move a corner of a triangle, and so a point of it.
[[nodiscard]] double greatest_move_by_floats(std::span<const NamedMesh> meshes);

}  // namespace alhazen
