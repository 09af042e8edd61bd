#pragma once
/// Reads a file of Bezier patches (.bpt) into patch meshes, one for each pair of degrees.
///
/// Source: the teapot files of Ryan Holmes, holmes3d.net: a count, then for each patch a line with
/// its two degrees and its control points, one per line.
/// Differs: `#` begins a comment; degrees may differ between patches; a line may hold several
/// points; a count that is too small is a warning, and all patches are read.
/// Conventions: points are u-major: (degree_u + 1) rows of (degree_v + 1) points. Control points of
/// equal position are merged (patch_welder.h).
/// Complexity: linear; no memory is reserved by the count in the file.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

struct BptMesh {
    PatchMesh mesh;
    FileLocation location;  ///< of its first patch
};

/// True if the text begins with a count, two degrees and a point, each on its line.
[[nodiscard]] bool looks_like_bpt(std::string_view bytes);

/// Returns the meshes in the order of their first patches. Adds findings to `diagnostics`, at most
/// 50 errors. Throws Error (Resource) beyond options.max_elements control points.
[[nodiscard]] std::vector<BptMesh> read_bpt(std::string_view bytes, const std::string& file,
                                            const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
