#pragma once
/// Renders an image of a scene with options of the command line.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/photon_cloud.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/core/sampling_plan.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

struct AntialiasReport;
struct BeamReport;
struct LoadedScene;
struct PathRecord;
class Renderer;
struct SamplingReport;
struct ScanLineReport;

/// A published counting protocol that fixes size, sampling and depth.
enum class Protocol {
    None,
    /// Haines' Standard Procedural Databases: 513x513 rays through the corners of 512x512 pixels,
    /// ray tree of depth 5 with the eye ray at depth 1, no adaptive cut-off, transmitting surfaces
    /// reflect.
    Spd,
};

/// Sets the conventions of Protocol::Spd; the protocol also fixes the size, 513 x 513.
void apply_spd(ShadingConventions& shading, SamplingConventions& sampling);

struct RenderOptions {
    std::string renderer = "whitted";
    std::string camera;  ///< name or position; empty = the first
    /// Instead of a camera of the scene; null: none.
    const CameraDescription* view = nullptr;
    std::optional<int> width, height;  ///< one given: the other follows from the aspect ratio
    std::optional<PixelBox> crop;      ///< part of the full frame; default: all of it
    int samples_per_pixel = 1;
    /// Adaptive supersampling; replaces samples_per_pixel.
    std::optional<AntialiasSettings> antialias;
    /// Sampler, filter and stop rules; samples_per_pixel is then the maximum of a pixel.
    std::optional<SamplingPlan> sampling;
    std::optional<int> max_depth;  ///< default: the format's
    int threads = 0;               ///< 0 = all available cores
    int tile_size = 32;
    std::uint64_t seed = 0;
    Protocol protocol = Protocol::None;
    bool count_tests = false;
    AovSet aovs;                 ///< layers to render in addition to the image
    bool keep_photons = false;   ///< fill RenderResult::photons
    bool spectral = false;       ///< RenderJob::spectral
    PathRecord* path = nullptr;  ///< RenderJob::path
    ProgressSink* progress = nullptr;
    const StopFlag* stop = nullptr;
};

struct RenderResult {
    explicit RenderResult(Film film_) : film(std::move(film_)) {}

    Film film;
    FilmLayers layers;
    RayCounters counters;
    double seconds = 0;
    double processor_seconds = 0;  ///< sum over all threads
    int threads = 0;
    bool complete = true;                   ///< false after a stop; unfinished tiles are black
    std::size_t tiles_done = 0, tiles = 0;  ///< or parts, as counted by the renderer
    std::shared_ptr<const AntialiasReport> antialias;  ///< null without adaptive supersampling
    std::shared_ptr<const SamplingReport> sampling;    ///< null without RenderOptions::sampling
    std::shared_ptr<const ScanLineReport> scan_lines;  ///< null unless a scan-line renderer
    std::shared_ptr<const BeamReport> beams;           ///< null unless a beam renderer
    std::vector<std::string> notes, remarks;           ///< as in RenderReport
    PhotonCloud photons;                               ///< with RenderOptions::keep_photons
};

/// The camera that the options select. Throws Error (Usage) for an unknown name.
[[nodiscard]] const CameraDescription& chosen_camera(const Scene& scene,
                                                     const RenderOptions& options);

struct FrameSize {
    int width, height;
};
/// The size of the picture for a camera described for `aspect`.
[[nodiscard]] FrameSize frame_size(const PictureSettings& picture, const RenderOptions& options,
                                   double aspect);

/// Width / height of an image without a camera: that of the options, of the file, or 4 / 3.
[[nodiscard]] double free_aspect(const PictureSettings& picture, const RenderOptions& options);

/// Throws Error (Usage) if RenderOptions::antialias conflicts with another option or the renderer.
void check_antialias(const RenderOptions& options, const Renderer& renderer);

/// As check_antialias, for RenderOptions::sampling.
void check_sampling(const RenderOptions& options, const Renderer& renderer);

/// As check_antialias, for RenderOptions::keep_photons.
void check_photons(const RenderOptions& options, const Renderer& renderer);

/// As check_antialias, for RenderOptions::spectral.
void check_spectral(const RenderOptions& options, const Renderer& renderer);

/// The properties of the view and the lights that `renderer` simplifies, one sentence each.
[[nodiscard]] std::vector<std::string> simplified(const Scene& scene, const RenderOptions& options,
                                                  const Renderer& renderer);

/// Renders an image. Throws Error (Usage) for invalid options, and if the renderer needs an
/// aggregate and the scene has none.
[[nodiscard]] RenderResult render(const Scene& scene, const PictureSettings& picture,
                                  const RenderOptions& options);
/// Renders with the description, for renderers that read geometry from it.
[[nodiscard]] RenderResult render(const LoadedScene& loaded, const RenderOptions& options);
/// Renders a scene whose lights differ from those of the description (lighting.h).
[[nodiscard]] RenderResult render_with_description(const Scene& scene,
                                                   const SceneDescription& description,
                                                   const RenderOptions& options);

}  // namespace alhazen
