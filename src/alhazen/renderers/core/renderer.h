#pragma once
/// The interface of all renderers: a renderer fills the crop of a film. It divides the work (tiles,
/// scan lines, passes) by its own strategy; `tiles.h` is the strategy for independent pixels.
/// docs/design/renderers.md; to add one: CONTRIBUTING.md.
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

/// Settings of the execution. Change no pixel and no count.
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
    /// Moves the camera, which is as the shutter opens; null: it rests.
    const TransformMotion* camera_motion = nullptr;
    AovFilm* aovs = nullptr;  ///< filled besides the film; may be null
    /// The source of `scene`, with all shapes and meshes: the geometry for renderers without an
    /// aggregate. Null where unknown.
    const SceneDescription* description = nullptr;
    /// Adaptive supersampling instead of `samples_per_pixel`, for renderers that answer single
    /// rays; null: none.
    const AntialiasSettings* antialias = nullptr;
    /// Sampler, filter and stop rules by name, for renderers in tiles; null: the samples of
    /// samplers.h, and their mean.
    const SamplingPlan* sampling = nullptr;
    const SampleRound* round = nullptr;  ///< of `sampling`, while it is rendered (rounds.h)
    bool spectral = false;               ///< light by wavelengths, not by channels of colour
    PhotonCloud* photons = nullptr;      ///< filled by renderers that have some; may be null
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
    int threads = 1;                  ///< largest number in force
    std::shared_ptr<const ScanLineReport> scan_lines;  ///< of a renderer in scan lines, else null
    std::shared_ptr<const AntialiasReport> antialias;  ///< of RenderJob::antialias, else null
    std::shared_ptr<const BeamReport> beams;           ///< of a renderer with beams, else null

    std::shared_ptr<const SamplingReport> sampling;  ///< of RenderJob::sampling, else null
    /// For the user: what the picture lacks, what was mended.
    std::vector<std::string> notes;
    /// For the user: what was found out on the way, nothing to worry about.
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
    /// False: `render` takes a scene without an aggregate, so none is built for it; geometry is
    /// read from RenderJob::description.
    [[nodiscard]] virtual bool needs_aggregate() const { return true; }
    /// True: `render` heeds RenderJob::antialias.
    [[nodiscard]] virtual bool answers_single_rays() const { return false; }
    /// True: `render` heeds RenderJob::sampling.
    [[nodiscard]] virtual bool takes_samplers() const { return false; }
    /// True: rays are distributed over lenses, time, lights with extent and rough reflections;
    /// others see through the centre of the lens, as the shutter opens.
    [[nodiscard]] virtual bool distributes() const { return false; }
    /// True: lights with extent throw penumbras.
    [[nodiscard]] virtual bool lights_have_extent() const { return distributes(); }
    /// What the settings of the renderer change in the conventions of the scene.
    virtual void adjust(ShadingConventions& /*conventions*/) const {}
    /// True: ShadingConventions::optics are heeded, or go without saying.
    [[nodiscard]] virtual bool heeds_optics() const { return follows_light(); }
    /// True: cameras that see all around are taken, too.
    [[nodiscard]] virtual bool takes_wide_cameras() const { return true; }
    /// True: light is scattered inside volumes, too (Material::scattering).
    [[nodiscard]] virtual bool scatters_in_volumes() const { return false; }
    /// True: light is followed from surface to surface, and the environment lights the scene.
    [[nodiscard]] virtual bool follows_light() const { return false; }
    /// Samples per pixel where nothing is said.
    [[nodiscard]] virtual int usual_samples() const { return 1; }
    /// True: `render` heeds AntialiasSettings::exact.
    [[nodiscard]] virtual bool gives_exact_areas() const { return false; }
    /// Above 0: RenderJob::description has to have triangles within this distance in place of its
    /// exact shapes.
    [[nodiscard]] virtual double takes_triangles_within() const { return 0.0; }
    /// True: `render` heeds RenderJob::spectral.
    [[nodiscard]] virtual bool takes_wavelengths() const { return false; }
    /// True: `render` fills RenderJob::photons.
    [[nodiscard]] virtual bool has_photons() const { return false; }
    /// True: reports have RenderReport::scan_lines.
    [[nodiscard]] virtual bool has_scan_lines() const { return false; }
};

/// A renderer by name, and what it does in one line.
struct RendererEntry {
    const char* name;
    const char* description;
    /// Throws Error (Usage) for an invalid setting.
    std::unique_ptr<Renderer> (*make)(RendererSettings& settings);
    bool follows_paths = false;  ///< its setting `depth` is the most scatterings of a path
};

/// The table of renderers. ADD A RENDERER HERE (renderer_list.cpp: one line).
[[nodiscard]] std::span<const RendererEntry> renderers();
/// The renderer of "NAME" or "NAME:SETTING=VALUE,...". Throws Error (Usage) listing the names for
/// an unknown one, the settings of a renderer for an unknown setting.
[[nodiscard]] std::unique_ptr<Renderer> make_renderer(const std::string& text);
/// The text of a renderer whose rays are reflected and refracted `depth` times after the eye ray:
/// what follows paths gets a setting, unless it has one; others take it from the scene.
[[nodiscard]] std::string with_depth(const std::string& text, int depth);

}  // namespace alhazen
