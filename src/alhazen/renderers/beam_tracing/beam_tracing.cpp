#include "alhazen/renderers/beam_tracing/beam_tracing.h"

#include <algorithm>

#include "alhazen/base/error.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/renderers/beam_tracing/beam_filtering.h"
#include "alhazen/renderers/beam_tracing/beam_pixels.h"
#include "alhazen/renderers/beam_tracing/beam_raster.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
#include "alhazen/renderers/beam_tracing/pixel_quadrature.h"
#include "alhazen/renderers/core/antialias_settings.h"
#include "alhazen/renderers/core/reports/beam_report.h"
#include "alhazen/renderers/core/tiles.h"

namespace alhazen {

namespace {

class BeamTileRenderer final : public TileRenderer {
  public:
    BeamTileRenderer(const RenderJob& job, const BeamScene& scene, const BeamTree& tree,
                     const BeamPixels& pixels, const BeamBands& bands)
        : job_(job),
          tree_(tree),
          pixels_(pixels),
          bands_(bands),
          exact_(job.antialias != nullptr),
          shading_(job, scene, tree),
          quadrature_(exact_ ? job.antialias->error : 0.0),
          whole_(whole_pixel()) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        const bool layers = job_.aovs != nullptr && job_.aovs->wanted().has_geometry();
        const auto columns = static_cast<std::size_t>(tile.x1 - tile.x0);
        for (int j = tile.y0; j < tile.y1; ++j) {
            if (job_.stop_requested()) return;
            row_.assign(columns, {});
            geometry_.assign(layers ? columns : 0, PixelGeometry{.samples = 1});
            errors_.assign(columns, 0.0);
            for (const std::uint32_t k : bands_.pieces_of(j)) add(tree_.pieces[k], tile, j);
            for (std::size_t c = 0; c < columns; ++c) {
                const int i = tile.x0 + static_cast<int>(c);
                FiniteMean mean;
                counters.non_finite += !mean.add(row_[c]);
                film.set(i, j, mean.value());
                if (layers) write_geometry(*job_.aovs, i, j, geometry_[c]);
                if (job_.aovs) job_.aovs->set(AovKind::RefractionError, i, j, {&errors_[c], 1});
            }
        }
    }

  private:
    void add(const BeamPiece& piece, const PixelBox& tile, int j) {
        const bool of_eye = tree_.beams[piece.beam].piece == kNoFacet;
        add_region(piece, piece.seen.region, tile, j, [&](std::size_t column) {
            double& error = errors_[column];
            error = std::max(error, shading_.refraction_error());
            if (of_eye && !geometry_.empty()) {
                PixelGeometry& g = geometry_[column];
                if (g.hits == 0) shading_.add_to(g);
            }
            return shading_.own();
        });
        for (const BeamLight& light : piece.lights) {
            add_region(piece, light.part.region, tile, j,
                       [&](std::size_t) { return shading_.light(light); });
        }
    }

    /// Adds the contribution of a region of a piece to the pixels of a row of the tile.
    /// `shade(column)` is the colour of the point to which `shading_` has moved.
    template <class Shade>
    void add_region(const BeamPiece& piece, const PolygonSet& region, const PixelBox& tile, int j,
                    const Shade& shade) {
        find(region, tile, j);
        bool cut = false;
        for (const BeamSample& s : samples_) {
            const auto column = static_cast<std::size_t>(s.i - tile.x0);
            if (!exact_) {
                shading_.go(piece, s.at);
                row_[column] += s.share * shade(column);
                continue;
            }
            const double lo = pixels_.bottom(j), hi = pixels_.top(j);
            const std::span<const double> edges = pixels_.edges(s.i, s.i + 1);
            const bool whole = s.share >= kWholeShare;
            if (!whole) {
                if (!cut) strip_.set(region, lo, hi);
                cut = true;
                strip_.cut(edges[0], edges[1], part_);
            }
            row_[column] += s.share * quadrature_.mean(whole ? whole_ : part_, [&](const Vec2& at,
                                                                                   double width) {
                shading_.filter_over(width);
                shading_.go(piece, {edges[0] + (at.x + 0.5) * (edges[1] - edges[0]),
                                    lo + (at.y + 0.5) * (hi - lo)});
                return shade(column);
            });
        }
    }

    /// The samples of a region in a row of the tile.
    void find(const PolygonSet& region, const PixelBox& tile, int j) {
        samples_.clear();
        const LatticeBox& box = region.bounds();
        if (exact_) {
            const double lo = pixels_.bottom(j), hi = pixels_.top(j);
            if (box.hi.y <= lo || box.lo.y >= hi) return;
            areas_.begin(lo, hi, pixels_.edges(tile.x0, tile.x1));
            areas_.add(region);
            areas_.take(j, tile.x0, samples_);
            return;
        }
        const double y = pixels_.y(j);
        if (box.hi.y < y || box.lo.y > y) return;
        add_points(region, j, y, tile.x0, pixels_.xs(tile.x0, tile.x1), crossings_, samples_);
    }

    static constexpr double kWholeShare = 1.0 - 1e-9;
    const RenderJob& job_;
    const BeamTree& tree_;
    const BeamPixels& pixels_;
    const BeamBands& bands_;
    bool exact_;
    BeamShading shading_;
    PixelQuadrature quadrature_;
    PixelPolygon whole_, part_;
    RowStrip strip_;
    RowAreas areas_;
    std::vector<double> crossings_;
    std::vector<BeamSample> samples_;
    std::vector<Rgb> row_;
    std::vector<PixelGeometry> geometry_;
    std::vector<double> errors_;  ///< errors of refraction
};

std::shared_ptr<BeamReport> report_of(const BeamScene& scene, const BeamTree& tree,
                                      const PolygonSet& window) {
    auto report = std::make_shared<BeamReport>();
    const FacetTreeReport& of_tree = scene.tree.report();
    report->polygons = of_tree.polygons;
    report->tree_splits = of_tree.splits;
    report->tree_pieces = of_tree.pieces;
    report->tree_nodes = of_tree.nodes;
    report->tree_depth = of_tree.depth;
    const auto beams = [&](RayKind kind) {
        return tree.beams_of_kind[static_cast<std::size_t>(kind)];
    };
    report->eye_beams = beams(RayKind::Eye);
    report->reflected_beams = beams(RayKind::Reflection);
    report->refracted_beams = beams(RayKind::Refraction);
    report->shadow_beams = tree.counts.shadow_beams;
    report->pieces = tree.counts.pieces;
    FacetWalkCounts walks = tree.counts.seen;
    walks += tree.counts.shadow;
    report->hulls_tested = walks.hulls;
    report->hulls_missed = walks.missed;
    report->polygons_tested = walks.polygons;
    report->cuts = tree.counts.cuts;
    Int128 area = 0;
    for (const BeamPiece& piece : tree.pieces) {
        if (piece.beam == 0) area += twice_area(piece.seen.region);
    }
    report->seen_area = static_cast<double>(area) / static_cast<double>(twice_area(window));
    return report;
}

void check_job(const RenderJob& job) {
    if (job.description == nullptr) {
        throw Error(ErrorKind::Usage, "beams need the description of the scene");
    }
    if (job.samples_per_pixel != 1) {
        throw Error(ErrorKind::Usage,
                    "renderer 'beam_tracing' takes --spp 1, or --antialias exact for the whole "
                    "area of each pixel");
    }
}

}  // namespace

RenderReport BeamTracing::render(const RenderJob& job, Film& film) const {
    check_job(job);
    const Stopwatch time;
    const BeamScene scene = beam_scene(*job.description, job.scene);
    const double gathered = time.seconds();
    const bool filtered = job.antialias != nullptr && job.antialias->filter != nullptr;
    // The film extends beyond the frame by the radius of the pixel filter.
    const WiderFrame wider(job, film, filtered);
    const BeamPixels pixels(wider.job(), wider.width(), wider.height());
    const PolygonSet window = pixels.around(wider.crop());
    BeamTree tree;
    ThreadLimit limit(job.control.threads);
    limit.run([&] { tree = beam_tree(wider.job(), scene, window, options_); });
    const double beams = time.seconds() - gathered;
    const BeamBands bands(tree, pixels, wider.crop());
    RenderReport report = render_tiles(job, film, [&]() -> std::unique_ptr<TileRenderer> {
        if (filtered) return beam_filter_renderer(wider, scene, tree, pixels, bands);
        return std::make_unique<BeamTileRenderer>(job, scene, tree, pixels, bands);
    });
    const std::shared_ptr<BeamReport> of_beams = report_of(scene, tree, window);
    of_beams->gather_seconds = gathered;
    of_beams->beam_seconds = beams;
    report.beams = of_beams;
    report.notes = scene.notes;
    return report;
}

}  // namespace alhazen
