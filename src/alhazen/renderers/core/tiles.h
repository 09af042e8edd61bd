#pragma once
/// Rendering in tiles: the crop of the film is divided into squares, which all threads render.
///
/// For renderers of independent pixels. Others (scan lines, beam trees, passes over the whole film)
/// implement Renderer directly, or call `render_tiles` once per pass.
/// Conventions: pixels and counters depend neither on the tile size nor on the threads.

#include <functional>
#include <memory>

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// Renders tiles of a job, one after the other; memory is reused from tile to tile. Threads: used
/// by one at a time.
class TileRenderer {
  public:
    virtual ~TileRenderer() = default;
    /// Renders the pixels of `tile` into `film`, adding to `counters`. Returns early after a stop.
    virtual void render(const PixelBox& tile, Film& film, RayCounters& counters) = 0;
};

/// Creates the TileRenderer of one thread. Called from many threads.
using MakeTileRenderer = std::function<std::unique_ptr<TileRenderer>()>;

/// Renders the tiles of the film's crop with the threads, tile size, stop flag and progress sink of
/// `job.control`. The parts of the report are tiles. A tile cut short by a stop keeps its finished
/// pixels and does not count as done. Counters are summed in the order of the tiles.
[[nodiscard]] RenderReport render_tiles(const RenderJob& job, Film& film,
                                        const MakeTileRenderer& make);

/// A renderer that has no work besides its tiles.
class TiledRenderer : public Renderer {
  public:
    /// `job` must outlive the result. Called from many threads.
    [[nodiscard]] virtual std::unique_ptr<TileRenderer> begin(const RenderJob& job) const = 0;

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_samplers() const final { return true; }
    /// Renders one tile in the calling thread.
    void render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                     RayCounters& counters) const {
        begin(job)->render(tile, film, counters);
    }
};

}  // namespace alhazen
