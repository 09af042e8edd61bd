#pragma once
/// `include "file"` of the native format.
///
/// Conventions: names are relative to the including file and must stay inside the root scene's
/// folder (or ImportOptions::allowed_folders). Cycles and deep or endless nesting are refused.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the file that `entry` names as if its items were written here. Throws Error (Resource)
/// beyond the limits of ImportOptions.
void read_native_include(TextNode entry, NativeContext& context, NativeScope& scope);

/// The canonical name of a file, independent of links.
[[nodiscard]] std::filesystem::path file_identity(const std::filesystem::path& path);

/// Checks the header of the file whose root is `root`; false after an error.
bool check_native_header(TextNode root, const FileLocation& start, Diagnostics& diagnostics);

}  // namespace alhazen
