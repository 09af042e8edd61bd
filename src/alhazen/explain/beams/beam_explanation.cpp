#include "alhazen/explain/beams/beam_explanation.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/renderers/beam_tracing/beam_raster.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
#include "alhazen/renderers/core/samplers.h"
#include "alhazen/session/aov_pictures.h"

namespace alhazen {

namespace {

/// In scenes with more polygons only the pixels around are divided.
constexpr std::size_t kFewPolygons = 2000;
constexpr int kPixelsAround = 12;
constexpr std::size_t kMostParts = 600;

/// Pixels of a frame and the window of beams.
class BeamFrame {
  public:
    BeamFrame(int width, int height) : width_(width), height_(height) {}

    [[nodiscard]] Vec2 pixel(const LatticePoint& p) const {
        return {0.5 * width_ * (1.0 + p.x / kBeamFilm), 0.5 * height_ * (1.0 - p.y / kBeamFilm)};
    }
    [[nodiscard]] PolygonSet rectangle(const Vec2& from, const Vec2& to) const {
        return lattice_rectangle(lattice(from.x, to.y), lattice(to.x, from.y));
    }
    [[nodiscard]] static double window(double film) { return (2.0 * film - 1.0) * kBeamFilm; }

  private:
    [[nodiscard]] LatticePoint lattice(double x, double y) const {
        const auto whole = [](double w) { return static_cast<std::int32_t>(std::lround(w)); };
        return {whole(window(x / width_)), whole(window(1.0 - y / height_))};
    }
    int width_, height_;
};

PixelOutline outline_of(const PolygonSet& region, const BeamFrame& frame) {
    PixelOutline outline;
    for (std::size_t i = 0; i < region.loop_count(); ++i) {
        std::vector<Vec2>& loop = outline.emplace_back();
        for (const LatticePoint& p : region.loop(i)) loop.push_back(frame.pixel(p));
    }
    return outline;
}

double area_of(const PolygonSet& region) {
    return static_cast<double>(twice_area(region));
}

class BeamExplainer {
  public:
    BeamExplainer(const RenderJob& job, const BeamScene& scene, const BeamTree& tree, int x, int y,
                  const BeamFrame& frame, const Vec2& film, BeamExplanation& e)
        : job_(job),
          scene_(scene),
          tree_(tree),
          frame_(frame),
          pixel_(frame.rectangle({double(x), double(y)}, {x + 1.0, y + 1.0})),
          sample_{BeamFrame::window(film.x), BeamFrame::window(film.y)},
          shading_(job, scene, tree),
          e_(e) {}

    void explain() {
        // Pieces of the pixel first, in case there are too many; then in the order of the tree.
        std::vector<std::uint32_t> wanted, others;
        for (std::uint32_t k = 0; k < tree_.pieces.size(); ++k) {
            const bool here = tree_.pieces[k].seen.region.bounds().meets(pixel_.bounds());
            (here ? wanted : others).push_back(k);
        }
        wanted.insert(wanted.end(), others.begin(), others.end());
        if (wanted.size() > kMostParts) {
            e_.left_out = wanted.size() - kMostParts;
            wanted.resize(kMostParts);
        }
        std::sort(wanted.begin(), wanted.end());
        for (const std::uint32_t k : wanted) e_.parts.push_back(part(k));
    }

  private:
    [[nodiscard]] BeamPart part(std::uint32_t k) {
        const BeamPiece& piece = tree_.pieces[k];
        const BeamNode& beam = tree_.beams[piece.beam];
        BeamPart part;
        part.id = k;
        part.from = beam.piece == kNoFacet ? k : beam.piece;
        part.kind = beam.view.kind;
        part.depth = beam.depth;
        part.background = piece.seen.facet == kNoFacet;
        if (!part.background) part.object = name(piece.seen.facet);
        part.outline = outline_of(piece.seen.region, frame_);
        part.share = area_of(intersection(piece.seen.region, pixel_)) / area_of(pixel_);
        part.holds_sample = holds_sample(piece.seen.region);
        if (part.holds_sample) {
            shading_.go(piece, sample_);
            part.own = shading_.own();
            e_.color += part.own;
        }
        for (const BeamLight& light : piece.lights) part.lit.push_back(lit(piece, light));
        return part;
    }
    [[nodiscard]] BeamLitPart lit(const BeamPiece& piece, const BeamLight& light) {
        BeamLitPart part;
        part.light = light.light;
        part.outline = outline_of(light.part.region, frame_);
        for (const std::uint32_t facet : light.part.through) part.through.push_back(name(facet));
        part.holds_sample = holds_sample(light.part.region);
        if (part.holds_sample) {
            shading_.go(piece, sample_);
            part.color = shading_.light(light);
            e_.color += part.color;
        }
        return part;
    }
    [[nodiscard]] std::string name(std::uint32_t facet) const {
        return part_name(*job_.description, scene_.sources[scene_.facets[facet].source].part);
    }
    /// Containment by the rule of the renderer.
    [[nodiscard]] bool holds_sample(const PolygonSet& region) {
        if (region.empty()) return false;
        std::vector<BeamSample> samples;
        add_points(region, 0, sample_.y, 0, {&sample_.x, 1}, crossings_, samples);
        return !samples.empty();
    }

    const RenderJob& job_;
    const BeamScene& scene_;
    const BeamTree& tree_;
    const BeamFrame& frame_;
    PolygonSet pixel_;
    Vec2 sample_;  ///< position in the window
    BeamShading shading_;
    std::vector<double> crossings_;
    BeamExplanation& e_;
};

}  // namespace

BeamExplanation explain_beams(const RenderJob& job, int x, int y, int width, int height) {
    BeamExplanation e;
    try {
        const BeamScene scene = beam_scene(*job.description, job.scene);
        const BeamFrame frame(width, height);
        e.polygons = scene.facets.size();
        const bool whole = e.polygons <= kFewPolygons;
        const auto within = [](int a, int most) { return double(std::clamp(a, 0, most)); };
        e.from = whole ? Vec2{0, 0}
                       : Vec2{within(x - kPixelsAround, width), within(y - kPixelsAround, height)};
        e.to = whole ? Vec2{double(width), double(height)}
                     : Vec2{within(x + 1 + kPixelsAround, width),
                            within(y + 1 + kPixelsAround, height)};
        BeamTree tree;
        ThreadLimit(job.control.threads).run([&] {
            tree = beam_tree(job, scene, frame.rectangle(e.from, e.to), {});
        });
        e.beams = tree.beams.size();
        if (job.stop_requested()) return e;
        const Vec2 film = PointSampler(job, width, height).at(x, y);
        BeamExplainer(job, scene, tree, x, y, frame, film, e).explain();
    } catch (const Error& error) {
        e.unavailable = error.what();
    }
    return e;
}

}  // namespace alhazen
