#pragma once
/// The interface of all renderers. A renderer fills the crop of a film and divides the work (tiles,
/// scan lines, passes) itself; `tiles.h` does so for independent pixels.
/// Design: docs/design/renderers.md. To add one: CONTRIBUTING.md.
///
/// Conventions: a pixel depends on the scene, the camera, the sampling and its own coordinates,
/// never on RenderControl.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/core/renderer_settings.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Settings of the execution. They change no pixel and no count.
struct RenderControl {
    int threads = 0;                   ///< largest number; 0 = all available cores
    int tile_size = 32;                ///< side in pixels, at least 1; for renderers with tiles
    const StopFlag* stop = nullptr;    ///< read before each batch of rays; may be null
    ProgressSink* progress = nullptr;  ///< phase "render"; may be null
};

struct AntialiasReport;
struct AntialiasSettings;
struct BeamReport;
struct PathRecord;
struct PhotonCloud;
struct SampleRound;
struct SamplingPlan;
struct SamplingReport;
struct ScanLineReport;

/// The scene, the view and the settings of a render.
struct RenderJob {
    const Scene& scene;
    Camera camera;              ///< fitted to the aspect ratio of the frame
    int samples_per_pixel = 1;  ///< see samplers.h
    std::uint64_t seed = 0;
    bool count_tests = false;  ///< fill RayCounters::tests (rays are always counted)
    RayCone cone{};            ///< of each eye ray; zero: textures are not filtered by distance
    /// Motion of the camera; `camera` is its state when the shutter opens. Null: at rest.
    const TransformMotion* camera_motion = nullptr;
    AovFilm* aovs = nullptr;  ///< filled in addition to the film; may be null
    /// The source of `scene`, with all shapes and meshes: the geometry for renderers without an
    /// aggregate. Null: unknown.
    const SceneDescription* description = nullptr;
    /// Adaptive supersampling instead of `samples_per_pixel`, for renderers with
    /// `answers_single_rays`; null: none.
    const AntialiasSettings* antialias = nullptr;
    /// Sampler, filter and stop rules, for renderers with `takes_samplers`; null: the samplers of
    /// samplers.h and the mean of their samples.
    const SamplingPlan* sampling = nullptr;
    const SampleRound* round = nullptr;  ///< of `sampling`, while it is rendered (rounds.h)
    bool spectral = false;               ///< light by wavelengths instead of colour channels
    PhotonCloud* photons = nullptr;      ///< filled by renderers with photons; may be null
    PathRecord* path = nullptr;          ///< filled by `path_tracing`; may be null
    RenderControl control{};

    [[nodiscard]] bool stop_requested() const {
        return control.stop != nullptr && control.stop->requested();
    }
};

/// The outcome of Renderer::render.
struct RenderReport {
    RayCounters counters;
    std::size_t done = 0, parts = 0;  ///< of the work, as reported to RenderControl::progress
    int threads = 1;                  ///< largest number used
    std::shared_ptr<const ScanLineReport> scan_lines;  ///< of a renderer in scan lines, else null
    std::shared_ptr<const AntialiasReport> antialias;  ///< of RenderJob::antialias, else null
    std::shared_ptr<const BeamReport> beams;           ///< of a renderer with beams, else null

    std::shared_ptr<const SamplingReport> sampling;  ///< of RenderJob::sampling, else null
    /// Warnings for the user: limitations of the picture and repairs.
    std::vector<std::string> notes;
    /// Informational messages for the user.
    std::vector<std::string> remarks;

    /// False after a stop.
    [[nodiscard]] bool complete() const { return done == parts; }
};

class Renderer {
  public:
    virtual ~Renderer() = default;
    /// Renders the crop of `film`. Uses threads as `job.control` allows and returns early after a
    /// stop; unfinished pixels are unchanged. May be called from many threads, with different
    /// films.
    [[nodiscard]] virtual RenderReport render(const RenderJob& job, Film& film) const = 0;
    /// False: `render` reads the geometry from RenderJob::description; no aggregate is built.
    [[nodiscard]] virtual bool needs_aggregate() const { return true; }
    /// True if `render` supports RenderJob::antialias.
    [[nodiscard]] virtual bool answers_single_rays() const { return false; }
    /// True if `render` supports RenderJob::sampling.
    [[nodiscard]] virtual bool takes_samplers() const { return false; }
    /// True if `render` supports SamplingPlan::noise and SamplingPlan::seconds.
    [[nodiscard]] virtual bool renders_in_rounds() const { return takes_samplers(); }
    /// True if rays are distributed over the lens, the shutter time, area lights and rough
    /// reflections. Others use the centre of the lens and the time at which the shutter opens.
    [[nodiscard]] virtual bool distributes() const { return false; }
    /// True if surfaces show what they reflect and transmit.
    [[nodiscard]] virtual bool reflects() const { return true; }
    /// True if area lights cast penumbras.
    [[nodiscard]] virtual bool lights_have_extent() const { return distributes(); }
    /// Applies the settings of the renderer to the conventions of the scene.
    virtual void adjust(ShadingConventions& /*conventions*/) const {}
    /// True if `render` uses ShadingConventions::optics or always has exact optics.
    [[nodiscard]] virtual bool heeds_optics() const { return follows_light(); }
    /// True if `render` supports WideCamera.
    [[nodiscard]] virtual bool takes_wide_cameras() const { return true; }
    /// True if light is scattered inside volumes (Material::scattering).
    [[nodiscard]] virtual bool scatters_in_volumes() const { return false; }
    /// True if light is followed from surface to surface and the environment lights the scene.
    [[nodiscard]] virtual bool follows_light() const { return false; }
    /// Default number of samples per pixel.
    [[nodiscard]] virtual int usual_samples() const { return 1; }
    /// True if `render` supports AntialiasSettings::exact.
    [[nodiscard]] virtual bool gives_exact_areas() const { return false; }
    /// Above 0: RenderJob::description must have triangles within this distance in place of its
    /// exact shapes.
    [[nodiscard]] virtual double takes_triangles_within() const { return 0.0; }
    /// True if `render` supports RenderJob::spectral.
    [[nodiscard]] virtual bool takes_wavelengths() const { return false; }
    /// True if `render` fills RenderJob::photons.
    [[nodiscard]] virtual bool has_photons() const { return false; }
    /// True if `render` sets RenderReport::scan_lines.
    [[nodiscard]] virtual bool has_scan_lines() const { return false; }
};

/// Name, one-line description and factory of a renderer.
struct RendererEntry {
    const char* name;
    const char* description;
    /// Throws Error (Usage) for an invalid setting.
    std::unique_ptr<Renderer> (*make)(RendererSettings& settings);
    bool follows_paths = false;  ///< its setting `depth` is the largest number of scatterings
};

/// The table of renderers. ADD A RENDERER HERE (renderer_list.cpp: one line).
[[nodiscard]] std::span<const RendererEntry> renderers();
/// Creates the renderer of "NAME" or "NAME:SETTING=VALUE,...". Throws Error (Usage) for an unknown
/// name, listing all names, and for an unknown setting, listing those of the renderer.
[[nodiscard]] std::unique_ptr<Renderer> make_renderer(const std::string& text);
/// Returns the text of the renderer with `depth` as the largest number of reflections and
/// refractions: adds the setting if the renderer `follows_paths` and the text has none; other
/// renderers take it from the scene.
[[nodiscard]] std::string with_depth(const std::string& text, int depth);

}  // namespace alhazen
