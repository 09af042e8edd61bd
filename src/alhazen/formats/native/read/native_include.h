#pragma once
/// `include "file"` of the native format.
///
/// Conventions: names are relative to the including file and must stay inside the root scene's
/// folder (or ImportOptions::allowed_folders). Cycles and excessive nesting are errors.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the items of the file that `entry` names in place of the entry. Throws Error (Resource)
/// beyond the limits of ImportOptions.
void read_native_include(TextNode entry, NativeContext& context, NativeScope& scope);

/// The canonical name of a file, independent of links.
[[nodiscard]] std::filesystem::path file_identity(const std::filesystem::path& path);

/// Checks the header of the file with the root node `root`; false after an error.
bool check_native_header(TextNode root, const FileLocation& start, Diagnostics& diagnostics);

}  // namespace alhazen
