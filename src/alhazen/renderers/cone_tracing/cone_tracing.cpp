#include "alhazen/renderers/cone_tracing/cone_tracing.h"

#include "alhazen/base/error.h"
#include "alhazen/cameras/pixel_cones.h"
#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/renderers/cone_tracing/cone_tracer.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

namespace {

/// Traces the cones of pixels.
class ConeTileRenderer final : public TileRenderer {
  public:
    ConeTileRenderer(const RenderJob& job, const ConeScene& scene, bool tables)
        : job_(job), tracer_(job, scene, tables, counters_) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        const int width = film.frame_width(), height = film.frame_height();
        const PixelCones cones(job_.camera, width, height, job_.samples_per_pixel);
        const PointSampler middle(job_, width, height);
        const JitteredSampler several(job_, width, height);
        const bool layers = job_.aovs != nullptr && job_.aovs->wanted().has_geometry();
        for (int j = tile.y0; j < tile.y1; ++j) {
            for (int i = tile.x0; i < tile.x1; ++i) {
                FiniteMean mean;
                PixelGeometry geometry;
                geometry.samples = job_.samples_per_pixel;
                for (int s = 0; s < job_.samples_per_pixel; ++s) {
                    if (job_.stop_requested()) return;
                    const Vec2 at =
                        job_.samples_per_pixel == 1 ? middle.at(i, j) : several.at(i, j, s);
                    const Rgb color = tracer_.trace_eye(cones.at(at), layers ? &geometry : nullptr);
                    counters_.non_finite += !mean.add(color);
                }
                if (job_.stop_requested()) return;
                film.set(i, j, mean.value());
                if (layers) write_geometry(*job_.aovs, i, j, geometry);
            }
        }
        counters += counters_;
        counters_ = {};
    }

  private:
    const RenderJob& job_;
    RayCounters counters_;  ///< counts of the tile
    ConeTracer tracer_;
};

}  // namespace

RenderReport ConeTracing::render(const RenderJob& job, Film& film) const {
    if (job.description == nullptr) {
        throw Error(ErrorKind::Usage, "cones need the description of the scene");
    }
    const ConeScene scene = cone_scene(*job.description, job.scene);
    return render_tiles(job, film, [&]() -> std::unique_ptr<TileRenderer> {
        return std::make_unique<ConeTileRenderer>(job, scene, options_.tables);
    });
}

}  // namespace alhazen
