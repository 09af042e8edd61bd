#pragma once
/// A built wide BVH in a file: built once, mapped into memory by every program that traces the same
/// geometry.
///
/// A header of 512 bytes, then the arrays of the layout as they are in memory, each from a multiple
/// of 256 on, then the unbounded primitives. The header names format version, byte order and sizes
/// of the build that wrote it, the fingerprint of the geometry
/// (aggregates/wide_bvh/table_fingerprint.h) and a checksum of all the rest. Conventions: a cache,
/// not an archive: a build of another kind refuses it. How well the tree was built does not matter
/// for what it may be loaded for. Complexity: loading reads all of the file once, for the checksum
/// and the references in it; that is a small part of a build. The file must not be written to in
/// place while it is in use.

#include <filesystem>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/geometry/box.h"

namespace alhazen {

/// Raise it when what the stored arrays mean changes; sizes are compared anyway.
inline constexpr std::uint32_t kWideBvhFileVersion = 3;

struct StoredWideBvh {
    WideBvhLayout layout;
    Box3 box;                            ///< of all primitives
    std::vector<PrimitiveId> unbounded;  ///< those that are not in the tree
};

/// Writes the tree as one step: there is the old file or the new one. Throws Error (File).
void save_wide_bvh(const std::filesystem::path& path, const WideBvhLayout& layout, const Box3& box,
                   const std::vector<PrimitiveId>& unbounded, const PrimitiveTable& table);

/// Maps the tree. Throws Error (File) when the file is no such tree, damaged, cut short, of another
/// kind of build or of other geometry than `table`, or when a reference in it leads nowhere.
[[nodiscard]] StoredWideBvh load_wide_bvh(const std::filesystem::path& path,
                                          const PrimitiveTable& table);

}  // namespace alhazen
