#include "alhazen/renderers/beam_tracing/beam_drawing.h"

#include <algorithm>
#include <cmath>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/renderers/beam_tracing/beam_cells.h"
#include "alhazen/renderers/beam_tracing/beam_outlines.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
#include "alhazen/renderers/beam_tracing/light_features.h"
#include "alhazen/renderers/beam_tracing/linear_shade.h"

namespace alhazen {

namespace {

/// Regions with smaller sides, in pixels, are not divided further.
constexpr double kLeastSide = 4;
/// Number of points along a side of the grid, and triangles, at which a region is shaded.
constexpr int kGrid = 5;
constexpr std::size_t kMostTriangles = 48;
/// Triangles at which a region that is not divided is shaded if the tree is not complete.
constexpr std::size_t kFewTriangles = 4;

/// Maps the window to the picture.
class ToPicture {
  public:
    ToPicture(int width, int height) : x_(0.5 * width), y_(0.5 * height) {}
    [[nodiscard]] Vec2 operator()(const Vec2& at) const {
        return {x_ * (1.0 + at.x / kBeamFilm), y_ * (1.0 - at.y / kBeamFilm)};
    }
    [[nodiscard]] std::vector<std::vector<Vec2>> loops(const PolygonSet& region) const {
        std::vector<std::vector<Vec2>> loops;
        for (std::size_t i = 0; i < region.loop_count(); ++i) {
            loops.push_back(points(region.loop(i)));
        }
        return loops;
    }
    [[nodiscard]] std::vector<Vec2> points(std::span<const LatticePoint> of_window) const {
        std::vector<Vec2> points;
        for (const LatticePoint p : of_window) {
            points.push_back((*this)({double(p.x), double(p.y)}));
        }
        return points;
    }

  private:
    double x_, y_;
};

/// Shades the cells of pieces.
class CellPainter {
  public:
    CellPainter(const RenderJob& job, const BeamScene& scene, const BeamTree& tree,
                const BeamDrawingOptions& options)
        : job_(job),
          scene_(scene),
          tree_(tree),
          options_(options),
          picture_(options.width, options.height),
          shading_(job, scene, tree) {}

    void paint(const BeamCell& cell, std::vector<DrawingRegion>& regions) {
        if (cell.region.empty()) return;
        if (!options_.shaded) {
            regions.push_back({picture_.loops(cell.region), {1, 1, 1}, {}});
            return;
        }
        paint(cell, features_of(cell), regions);
    }

  private:
    /// `features`: points of the window around which the shading may change.
    void paint(const BeamCell& cell, std::span<const Vec2> features,
               std::vector<DrawingRegion>& regions) {
        if (cell.region.empty()) return;
        const std::vector<Vec2> close = close_to(cell.region.bounds(), features);
        shade_points(cell, close);
        const LinearShade shade = fit_shade(points_, options_.tolerance);
        if (shade.error > options_.tolerance && is_large(cell.region)) {
            return divide(cell, close, regions);
        }
        regions.push_back({picture_.loops(cell.region), shade.mean, shade.gradient});
    }

    [[nodiscard]] std::vector<Vec2> features_of(const BeamCell& cell) const {
        std::vector<Vec2> features;
        std::vector<Vec3> points;
        for (const BeamTerm& term : cell.terms) {
            const BeamPiece& piece = tree_.pieces[term.piece];
            if (piece.seen.facet == kNoFacet) continue;
            const BeamView& view = tree_.beams[piece.beam].view;
            points.clear();
            for (const std::uint32_t l : term.lights) {
                add_light_features(job_.scene.lights[piece.lights[l].light],
                                   scene_.plane(piece.seen.facet), view.apex, points);
            }
            for (const Vec3& p : points) {
                const Vec3 at = view.projection(p);
                if (at.z > 0.0) features.push_back({at.x / at.z, at.y / at.z});
            }
        }
        return features;
    }

    /// The features whose distance from a box is at most its size.
    [[nodiscard]] static std::vector<Vec2> close_to(const LatticeBox& box,
                                                    std::span<const Vec2> features) {
        const double x = box.lo.x, y = box.lo.y, width = box.hi.x - x, height = box.hi.y - y;
        const double reach = std::max(width, height);
        std::vector<Vec2> close;
        for (const Vec2& f : features) {
            if (std::abs(f.x - x - 0.5 * width) <= 0.5 * width + reach &&
                std::abs(f.y - y - 0.5 * height) <= 0.5 * height + reach) {
                close.push_back(f);
            }
        }
        return close;
    }

    [[nodiscard]] bool is_large(const PolygonSet& region) const {
        const LatticeBox& box = region.bounds();
        const double width = 0.5 * options_.width * (box.hi.x - box.lo.x) / kBeamFilm;
        const double height = 0.5 * options_.height * (box.hi.y - box.lo.y) / kBeamFilm;
        return std::max(width, height) > kLeastSide;
    }

    void divide(const BeamCell& cell, std::span<const Vec2> features,
                std::vector<DrawingRegion>& regions) {
        const LatticeBox box = cell.region.bounds();
        LatticePoint middle = box.hi;
        const double width = double(options_.width) * (box.hi.x - box.lo.x);
        const double height = double(options_.height) * (box.hi.y - box.lo.y);
        (width > height ? middle.x : middle.y) = width > height
                                                     ? box.lo.x + (box.hi.x - box.lo.x) / 2
                                                     : box.lo.y + (box.hi.y - box.lo.y) / 2;
        const PolygonCut halves = cut(cell.region, lattice_rectangle(box.lo, middle));
        paint({halves.inside, cell.terms}, features, regions);
        paint({halves.outside, cell.terms}, features, regions);
    }

    /// Shades the middles of a few triangles.
    void shade_middles(const BeamCell& cell) {
        const std::vector<LatticeTriangle> triangles = triangulate(cell.region);
        const std::size_t step = triangles.size() / kFewTriangles + 1;
        for (std::size_t t = 0; t < triangles.size(); t += step) {
            Vec2 middle;
            for (const LatticePoint& p : triangles[t]) {
                middle = middle + (1.0 / 3.0) * Vec2{double(p.x), double(p.y)};
            }
            add(cell, middle);
        }
    }

    void shade_points(const BeamCell& cell, std::span<const Vec2> features) {
        points_.clear();
        if (tree_.left_out > 0 && !is_large(cell.region)) return shade_middles(cell);
        const std::vector<LatticeTriangle> triangles = triangulate(cell.region);
        const std::size_t step = triangles.size() / kMostTriangles + 1;
        for (std::size_t t = 0; t < triangles.size(); t += step) {
            Vec2 corner[3], middle;
            for (std::size_t k = 0; k < 3; ++k) {
                corner[k] = {double(triangles[t][k].x), double(triangles[t][k].y)};
                middle = middle + (1.0 / 3.0) * corner[k];
            }
            add(cell, middle);
            for (const Vec2& c : corner) add(cell, 0.97 * c + 0.03 * middle);
        }
        const LatticeBox& box = cell.region.bounds();
        for (int j = 0; j < kGrid; ++j) {
            for (int i = 0; i < kGrid; ++i) {
                const auto at = [&](std::int32_t lo, std::int32_t hi, int n) {
                    return lo + static_cast<std::int32_t>((hi - lo) * (n + 0.5) / kGrid);
                };
                const LatticePoint p{at(box.lo.x, box.hi.x, i), at(box.lo.y, box.hi.y, j)};
                if (side_of_point(cell.region, p) == PointSide::Inside) {
                    add(cell, {double(p.x), double(p.y)});
                }
            }
        }
        // The points of the box nearest to the features.
        nearest_.clear();
        for (const Vec2& f : features) {
            nearest_.push_back(
                {static_cast<std::int32_t>(std::clamp(f.x, double(box.lo.x), double(box.hi.x))),
                 static_cast<std::int32_t>(std::clamp(f.y, double(box.lo.y), double(box.hi.y)))});
        }
        std::sort(nearest_.begin(), nearest_.end());
        nearest_.erase(std::unique(nearest_.begin(), nearest_.end()), nearest_.end());
        for (const LatticePoint p : nearest_) {
            if (side_of_point(cell.region, p) != PointSide::Outside) {
                add(cell, {double(p.x), double(p.y)});
            }
        }
    }

    void add(const BeamCell& cell, const Vec2& at) {
        Rgb color;
        for (const BeamTerm& term : cell.terms) {
            const BeamPiece& piece = tree_.pieces[term.piece];
            shading_.go(piece, at);
            color += shading_.own();
            for (const std::uint32_t l : term.lights) color += shading_.light(piece.lights[l]);
        }
        points_.push_back({picture_(at), encoded(color)});
    }

    [[nodiscard]] Rgb encoded(const Rgb& color) const {
        const bool linear = job_.scene.conventions.film.linear_output;
        Rgb out;
        for (int k = 0; k < 3; ++k) {
            const double c = std::clamp(color[k], 0.0, 1.0);
            out[k] = linear ? c : srgb_from_linear(c);
        }
        return out;
    }

    const RenderJob& job_;
    const BeamScene& scene_;
    const BeamTree& tree_;
    const BeamDrawingOptions& options_;
    ToPicture picture_;
    BeamShading shading_;
    std::vector<ShadePoint> points_;
    std::vector<LatticePoint> nearest_;
};

/// Regions of the pieces by part, in the order in which parts are first visible.
std::vector<DrawingGroup> groups_of(const BeamScene& scene, const BeamTree& tree,
                                    std::vector<std::vector<DrawingRegion>>& painted,
                                    const BeamDrawingOptions& options) {
    std::vector<DrawingGroup> groups;
    std::vector<std::int64_t> group_of_part;
    for (std::size_t p = 0; p < painted.size(); ++p) {
        if (painted[p].empty()) continue;
        const std::uint32_t facet = tree.pieces[p].seen.facet;
        const std::uint32_t part =
            facet == kNoFacet ? 0 : scene.sources[scene.facets[facet].source].part + 1;
        if (part >= group_of_part.size()) group_of_part.resize(part + 1, -1);
        if (group_of_part[part] < 0) {
            group_of_part[part] = static_cast<std::int64_t>(groups.size());
            groups.emplace_back();
            if (part > 0 && options.name_of) groups.back().title = options.name_of(part - 1);
        }
        auto& regions = groups[static_cast<std::size_t>(group_of_part[part])].regions;
        for (DrawingRegion& region : painted[p]) regions.push_back(std::move(region));
    }
    return groups;
}

}  // namespace

Drawing beam_drawing(const RenderJob& job, const BeamScene& scene, const BeamTree& tree,
                     const BeamDrawingOptions& options) {
    Drawing drawing;
    drawing.width = options.width;
    drawing.height = options.height;
    const auto behind = pieces_behind(tree);
    // Of a tree that is not complete a cell of a pixel is not divided.
    CellLimit whole;
    if (tree.left_out > 0) {
        whole = {2 * kBeamFilm / options.width, 2 * kBeamFilm / options.height};
    }
    std::vector<std::vector<DrawingRegion>> painted(tree.pieces.size());
    constexpr std::size_t kBlock = 32;
    parallel_for(tree.pieces.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        CellPainter painter(job, scene, tree, options);
        for (std::size_t p = begin; p < end; ++p) {
            if (tree.pieces[p].beam != 0 || job.stop_requested()) continue;
            for (const BeamCell& cell :
                 cells_of(tree, behind, static_cast<std::uint32_t>(p), whole)) {
                painter.paint(cell, painted[p]);
            }
        }
    });
    drawing.groups = groups_of(scene, tree, painted, options);
    if (options.lines) {
        const ToPicture picture(options.width, options.height);
        for (const BeamOutline& outline : beam_outlines(scene, tree)) {
            drawing.lines.push_back(
                {outline.style, picture.points(outline.points), outline.closed});
        }
    }
    return drawing;
}

}  // namespace alhazen
