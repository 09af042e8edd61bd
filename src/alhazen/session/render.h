#pragma once
/// One picture: the scene, the options that a person gives, and all cores.

#include <optional>
#include <string>

#include "alhazen/base/progress.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// A published way of counting that fixes size, sampling and depth.
enum class Protocol {
    None,
    /// Haines' Standard Procedural Databases: 513x513 rays through the corners of 512x512 pixels,
    /// ray tree of depth 5 with the eye ray at depth 1, no adaptive cut-off, transmitting surfaces
    /// reflect.
    Spd,
};

/// What Protocol::Spd says of a scene; it also fixes the size, 513 x 513.
void apply_spd(ShadingConventions& shading, SamplingConventions& sampling);

struct RenderOptions {
    std::string renderer = "whitted";
    std::string camera;                ///< name or position; empty = the first
    std::optional<int> width, height;  ///< one given: the other follows from the aspect ratio
    std::optional<PixelBox> crop;      ///< of the full frame; default all of it
    int samples_per_pixel = 1;
    std::optional<int> max_depth;  ///< default: the format's
    int threads = 0;               ///< 0 = all available cores
    int tile_size = 32;
    std::uint64_t seed = 0;
    Protocol protocol = Protocol::None;
    bool count_tests = false;
    AovSet aovs;  ///< layers to make besides the picture
    ProgressSink* progress = nullptr;
    const StopFlag* stop = nullptr;
};

struct RenderResult {
    explicit RenderResult(Film film_) : film(std::move(film_)) {}

    Film film;
    FilmLayers layers;
    RayCounters counters;
    double seconds = 0;
    double processor_seconds = 0;  ///< of all threads together
    int threads = 0;
    bool complete = true;  ///< false when it was stopped; tiles not done are black
    std::size_t tiles_done = 0, tiles = 0;
};

/// Width / height of a picture that is not told its camera's: that of the options, of the file, or
/// 4 / 3.
[[nodiscard]] double free_aspect(const PictureSettings& picture, const RenderOptions& options);

/// Throws Error (Usage) for options that make no picture.
[[nodiscard]] RenderResult render(const Scene& scene, const PictureSettings& picture,
                                  const RenderOptions& options);

}  // namespace alhazen
