#pragma once
/// A built wide BVH in a file: built once, mapped into memory by every program that traces the same
/// geometry.
///
/// A header of 512 bytes, then the arrays of the layout as in memory, each at a multiple of 256,
/// then the unbounded primitives. The header holds format version, byte order and sizes of the
/// build that wrote it, the fingerprint of the geometry (aggregates/wide_bvh/table_fingerprint.h)
/// and a checksum of everything else.
/// Conventions: a cache, not an archive: other builds reject it. A tree of any build quality may be
/// loaded. The file must not be modified in place while in use.
/// Complexity: loading reads the whole file once, for the checksum and the check of references; a
/// small part of a build.

#include <filesystem>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/geometry/box.h"

namespace alhazen {

/// Must be raised when the meaning of the stored arrays changes; sizes are compared anyway.
inline constexpr std::uint32_t kWideBvhFileVersion = 6;

struct StoredWideBvh {
    WideBvhLayout layout;
    Box3 box;                            ///< of all primitives
    std::vector<PrimitiveId> unbounded;  ///< those outside the tree
    Precision precision = Precision::Robust;
};

/// Writes the tree atomically. Throws Error (File).
void save_wide_bvh(const std::filesystem::path& path, const WideBvhLayout& layout, const Box3& box,
                   const std::vector<PrimitiveId>& unbounded, const PrimitiveTable& table,
                   Precision precision);

/// Maps the tree. Throws Error (File) if the file is no such tree, damaged, truncated, of another
/// kind of build or of another geometry than `table`, or has an invalid reference.
[[nodiscard]] StoredWideBvh load_wide_bvh(const std::filesystem::path& path,
                                          const PrimitiveTable& table);

}  // namespace alhazen
