#include "alhazen/renderers/beam_tracing/beam_tracing.h"

#include <algorithm>
#include <chrono>

#include "alhazen/base/error.h"
#include "alhazen/imaging/film/pixel_filter.h"
#include "alhazen/renderers/beam_tracing/beam_filtering.h"
#include "alhazen/renderers/beam_tracing/beam_pixels.h"
#include "alhazen/renderers/beam_tracing/beam_raster.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
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
          shading_(job, scene, tree) {}

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
                BoxFilter filter;
                counters.non_finite += !filter.add(row_[c]);
                film.set(i, j, filter.value());
                if (layers) write_geometry(*job_.aovs, i, j, geometry_[c]);
                if (job_.aovs) job_.aovs->set(AovKind::RefractionError, i, j, {&errors_[c], 1});
            }
        }
    }

  private:
    void add(const BeamPiece& piece, const PixelBox& tile, int j) {
        find(piece.seen.region, tile, j);
        const bool of_eye = tree_.beams[piece.beam].piece == kNoFacet;
        for (const BeamSample& s : samples_) {
            shading_.go(piece, s.at);
            at(tile, s) += s.share * shading_.own();
            double& error = errors_[static_cast<std::size_t>(s.i - tile.x0)];
            error = std::max(error, shading_.refraction_error());
            if (of_eye && !geometry_.empty()) {
                PixelGeometry& g = geometry_[static_cast<std::size_t>(s.i - tile.x0)];
                if (g.hits == 0) shading_.add_to(g);
            }
        }
        for (const BeamLight& light : piece.lights) {
            find(light.part.region, tile, j);
            for (const BeamSample& s : samples_) {
                shading_.go(piece, s.at);
                at(tile, s) += s.share * shading_.light(light);
            }
        }
    }
    [[nodiscard]] Rgb& at(const PixelBox& tile, const BeamSample& s) {
        return row_[static_cast<std::size_t>(s.i - tile.x0)];
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
            divide_whole_pixels();
            return;
        }
        const double y = pixels_.y(j);
        if (box.hi.y < y || box.lo.y > y) return;
        add_points(region, j, y, tile.x0, pixels_.xs(tile.x0, tile.x1), crossings_, samples_);
    }

    /// Shades whole pixels at the four points of Gauss' rule, parts in their middles.
    void divide_whole_pixels() {
        const double x = kGauss * (pixels_.edges(0, 1)[1] - pixels_.edges(0, 1)[0]);
        const double y = kGauss * (pixels_.top(0) - pixels_.bottom(0));
        const std::size_t count = samples_.size();
        for (std::size_t k = 0; k < count; ++k) {
            if (samples_[k].share < 1.0 - 1e-9) continue;
            BeamSample s = samples_[k];
            s.share *= 0.25;
            const Vec2 middle = s.at;
            for (int n = 0; n < 4; ++n) {
                s.at = middle + Vec2{(n & 1) != 0 ? x : -x, (n & 2) != 0 ? y : -y};
                if (n == 0) {
                    samples_[k] = s;
                } else {
                    samples_.push_back(s);
                }
            }
        }
    }

    static constexpr double kGauss = 0.28867513459481287;  ///< 1 / sqrt(12)
    const RenderJob& job_;
    const BeamTree& tree_;
    const BeamPixels& pixels_;
    const BeamBands& bands_;
    bool exact_;
    BeamShading shading_;
    RowAreas areas_;
    std::vector<double> crossings_;
    std::vector<BeamSample> samples_;
    std::vector<Rgb> row_;
    std::vector<PixelGeometry> geometry_;
    std::vector<double> errors_;  ///< of refraction
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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
    const auto start = std::chrono::steady_clock::now();
    const BeamScene scene = beam_scene(*job.description, job.scene);
    const double gathered = seconds_since(start);
    const bool filtered = job.antialias != nullptr && job.antialias->filter != nullptr;
    // The film reaches as far beyond the frame as the filters of its pixels.
    const WiderFrame wider(job, film, filtered);
    const BeamPixels pixels(wider.job(), wider.width(), wider.height());
    const PolygonSet window = pixels.around(wider.crop());
    BeamTree tree;
    ThreadLimit limit(job.control.threads);
    limit.run([&] { tree = beam_tree(wider.job(), scene, window, options_); });
    const double beams = seconds_since(start) - gathered;
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
