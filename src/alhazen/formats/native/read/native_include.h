#pragma once
/// `include "file"` of the native format.
///
/// Conventions: names are relative to the including file and must stay inside the root scene's
/// folder (or ImportOptions::allowed_folders). Cycles and deep or endless nesting are refused.

#include "alhazen/formats/native/read/native_context.h"

namespace alhazen {

/// Reads the file that `entry` names as if its items stood here. Throws Error (Resource) when the
/// limits of ImportOptions are exceeded.
void read_native_include(TextNode entry, NativeContext& context, NativeScope& scope);

/// The one name of a file, whatever links lead to it.
[[nodiscard]] std::filesystem::path file_identity(const std::filesystem::path& path);

/// Checks the header of the file whose root is `root`; false after an error.
bool check_native_header(TextNode root, const FileLocation& start, Diagnostics& diagnostics);

}  // namespace alhazen
