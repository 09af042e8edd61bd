#pragma once
/// What every renderer offers: it fills tiles of a film. To add one: CONTRIBUTING.md.
///
/// Conventions: a pixel depends on the scene, the camera, the sampling and its own coordinates,
/// never on the tile it is rendered in or the thread that does it.

#include <memory>
#include <span>
#include <string>

#include "alhazen/base/progress.h"
#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/aov.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Everything that a tile needs to know.
struct RenderJob {
    const Scene& scene;
    Camera camera;  ///< already fitted to the frame's aspect ratio
    int samples_per_pixel =
        1;  ///< 1: the convention's point of the pixel; more: stratified, jittered
    std::uint64_t seed = 0;
    bool count_tests = false;        ///< fill RayCounters::tests (rays are always counted)
    const StopFlag* stop = nullptr;  ///< looked at before each batch of rays; may be null
    RayCone cone{};           ///< of each eye ray; zero: textures are not filtered by distance
    AovFilm* aovs = nullptr;  ///< filled besides the film; may be null

    [[nodiscard]] bool stop_requested() const { return stop != nullptr && stop->requested(); }
};

/// Renders tiles of a job, one after the other; what it needs besides is kept from tile to tile.
/// Threads: belongs to one at a time.
class TileRenderer {
  public:
    virtual ~TileRenderer() = default;
    /// Renders the pixels of `tile` into `film`, adding to `counters`.
    virtual void render(const PixelBox& tile, Film& film, RayCounters& counters) = 0;
};

class Renderer {
  public:
    virtual ~Renderer() = default;
    /// `job` must outlive what is made. Called from many threads.
    [[nodiscard]] virtual std::unique_ptr<TileRenderer> begin(const RenderJob& job) const = 0;
    /// One tile alone.
    void render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                     RayCounters& counters) const {
        begin(job)->render(tile, film, counters);
    }
};

/// A renderer by name, and what it does in one line.
struct RendererEntry {
    const char* name;
    const char* description;
    std::unique_ptr<Renderer> (*make)();
};

/// The table of renderers. ADD A RENDERER HERE (renderer.cpp: one line).
[[nodiscard]] std::span<const RendererEntry> renderers();
/// Throws Error (Usage) listing the names for an unknown one.
[[nodiscard]] std::unique_ptr<Renderer> make_renderer(const std::string& name);

}  // namespace alhazen
