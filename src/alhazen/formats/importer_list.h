#pragma once
/// Table of importers. ADD A FORMAT HERE (importer_list.cpp: one line).

#include <span>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// All importers, in the order in which they are queried.
[[nodiscard]] std::span<const Importer* const> importers();

/// The importer that recognises the bytes with the highest confidence. Throws Error (Scene),
/// listing the known formats, if none does.
[[nodiscard]] const Importer& find_importer(const ImportSource& source);

/// Reads, recognises, imports and validates a scene file. Throws Error; warnings go to
/// `diagnostics`.
[[nodiscard]] SceneDescription import_scene(const std::filesystem::path& path,
                                            const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
