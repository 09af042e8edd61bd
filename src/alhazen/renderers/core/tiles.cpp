#include "alhazen/renderers/core/tiles.h"

#include <mutex>
#include <utility>
#include <vector>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/rounds.h"

namespace alhazen {

namespace {

/// Counts finished tiles and reports progress, one call at a time.
class TileProgress {
  public:
    TileProgress(ProgressSink* sink, std::size_t total) : sink_(sink), total_(total) {}

    void tile_done() {
        const std::lock_guard lock(mutex_);
        ++done_;
        if (sink_ != nullptr) sink_->update("render", done_, total_);
    }
    [[nodiscard]] std::size_t done() const { return done_; }

  private:
    ProgressSink* sink_;
    std::size_t total_;
    std::size_t done_ = 0;
    std::mutex mutex_;
};

/// Tile renderers, at most one per active thread.
class TileRendererPool {
  public:
    explicit TileRendererPool(const MakeTileRenderer& make) : make_(make) {}

    [[nodiscard]] std::unique_ptr<TileRenderer> take() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return make_();
        std::unique_ptr<TileRenderer> taken = std::move(idle_.back());
        idle_.pop_back();
        return taken;
    }
    void give_back(std::unique_ptr<TileRenderer> renderer) {
        const std::lock_guard lock(mutex_);
        idle_.push_back(std::move(renderer));
    }

  private:
    const MakeTileRenderer& make_;
    std::vector<std::unique_ptr<TileRenderer>> idle_;
    std::mutex mutex_;
};

}  // namespace

RenderReport render_tiles(const RenderJob& job, Film& film, const MakeTileRenderer& make) {
    const std::vector<PixelBox> tiles = tiles_of(film.crop(), job.control.tile_size);
    std::vector<RayCounters> counters(tiles.size());
    TileProgress progress(job.control.progress, tiles.size());
    TileRendererPool pool(make);
    ThreadLimit threads(job.control.threads);
    threads.run([&] {
        parallel_for(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
            std::unique_ptr<TileRenderer> own = pool.take();
            for (std::size_t i = begin; i < end; ++i) {
                if (job.stop_requested()) return;
                own->render(tiles[i], film, counters[i]);
                // A truncated tile keeps its finished pixels, but is not done.
                if (job.stop_requested()) return;
                progress.tile_done();
            }
            pool.give_back(std::move(own));
        });
    });
    RenderReport report;
    report.done = progress.done();
    report.parts = tiles.size();
    report.threads = threads.threads();
    for (const RayCounters& c : counters) report.counters += c;
    return report;
}

RenderReport TiledRenderer::render(const RenderJob& job, Film& film) const {
    if (job.sampling != nullptr) return render_in_rounds(*this, job, film);
    return render_tiles(job, film, [&] { return begin(job); });
}

}  // namespace alhazen
