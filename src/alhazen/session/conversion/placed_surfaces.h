#pragma once
/// All patches and NURBS surfaces of a scene with instances expanded, for files of patches.

#include <string>
#include <vector>

#include "alhazen/formats/patch_files/patch_export.h"
#include "alhazen/session/conversion/placed_meshes.h"

namespace alhazen {

/// Largest number of placed control points in a file.
inline constexpr std::uint64_t kMaxPlacedControlPoints = 400'000'000;

/// The placed shapes for which `fits` is true, in the order of the parts; removes them from
/// `counts`. `material_names` [MaterialId]. Throws Error (Resource) beyond the limit.
[[nodiscard]] std::vector<NamedSurface> placed_surfaces(
    const SceneDescription& description, bool (*fits)(const AnyShape&),
    const std::vector<std::string>& material_names, PlacedCounts& counts);

}  // namespace alhazen
