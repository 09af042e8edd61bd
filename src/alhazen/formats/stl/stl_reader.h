#pragma once
/// Reads an STL file, ascii or binary, into triangle meshes: one per solid.
///
/// Source: 3D Systems, "Stereolithography Interface Specification", 1989; the file layout as
/// described in Marshall Burns, "Automated Fabrication", 1993, section 6.5.
/// Differs: an ascii file may hold several solids; case is ignored; endsolid may be missing. A file
/// is binary if its size matches its count, even if it begins with "solid"; a file of another size
/// that begins with "solid" is binary if it has zero bytes, and is reported as binary.
/// Conventions: corners of exactly equal position (-0 = 0) are one vertex. The winding, not the
/// normals of the file, determines the outside. Attribute bytes are ignored.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// The header of files of this library. It is no name.
inline constexpr std::string_view kStlHeader = "binary STL by Alhazen";

struct StlSolid {
    std::string name;  ///< may be empty
    int line = 0;      ///< ascii files only
    TriangleMesh mesh;
};

/// True if the bytes are certainly STL: binary of the right size, or text with a solid and a facet.
[[nodiscard]] bool looks_like_stl(std::string_view bytes);

/// The solids of a file; empty after an error. With `as_one`, at most one solid with all facets.
/// `file` is for messages only. Throws Error (Resource).
[[nodiscard]] std::vector<StlSolid> read_stl(std::string_view bytes, const std::string& file,
                                             const ImportOptions& options, Diagnostics& diagnostics,
                                             bool as_one = false);

}  // namespace alhazen
