#pragma once
/// The passes of `vcm`: light paths whose vertices are kept, and pairs of subpaths for the picture.

#include <cstdint>

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

/// What a pilot run is for.
enum class Pilot : std::uint8_t {
    Off,
    Say,     ///< whether merging pays
    Choose,  ///< the same, and heeded
};
inline constexpr const char* kPilotNames[] = {"off", "say", "choose"};

struct VcmSettings {
    bool merge = true;  ///< false: the picture is that of `bidirectional`
    Pilot pilot = Pilot::Say;
    std::uint64_t photons = 0;  ///< light paths of a pass to merge with; 0: one for each pixel of
                                ///< the frame, kUsualMost at most
    double radius = 0;          ///< of the first pass; 0: of three pixels
    double alpha = 0.75;        ///< share of the photons of further passes that is kept
    double memory = 512;        ///< of a pass, in megabytes
    PathSettings paths;

    static constexpr std::uint64_t kUsualMost = 200000;
};

/// With the usual photons and radius where 0 stands.
[[nodiscard]] VcmSettings resolved(const VcmSettings& settings, const RenderJob& job,
                                   const Film& film);

/// What a render did.
struct MergeWork {
    std::uint64_t light_rays = 0;  ///< of the light paths that are merged with
    std::uint64_t merged = 0;      ///< pairs of vertices
};

/// With `resolved` settings; a pilot is none of its business.
[[nodiscard]] RenderReport render_merging(const RenderJob& job, Film& film,
                                          const VcmSettings& settings, MergeWork& work);

}  // namespace alhazen
