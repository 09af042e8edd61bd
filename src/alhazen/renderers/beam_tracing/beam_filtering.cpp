#include "alhazen/renderers/beam_tracing/beam_filtering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "alhazen/imaging/film/pixel_filter.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
#include "alhazen/renderers/core/antialias_settings.h"

namespace alhazen {

namespace {

int reach_of(const RenderJob& job) {
    return FilterIntegral(*job.antialias->filter, job.antialias->radius).reach();
}

Camera widened(Camera camera, double across, double up) {
    std::visit(
        [&](auto& c) {
            c.right = across * c.right;
            c.up = up * c.up;
        },
        camera);
    return camera;
}

/// The part of a loop on one side of a line across an axis: coordinate >= at, or <= at.
void cut_loop(std::span<const Vec2> loop, int axis, double at, bool above,
              std::vector<Vec2>& result) {
    result.clear();
    double Vec2::*const along = axis == 0 ? &Vec2::x : &Vec2::y;
    const auto side = [&](const Vec2& p) { return above ? p.*along - at : at - p.*along; };
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec2 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
        const double of_a = side(a), of_b = side(b);
        if (of_a >= 0.0) result.push_back(a);
        if ((of_a >= 0.0) == (of_b >= 0.0)) continue;
        // From the same end for both regions that share the edge.
        const bool forward = of_a < of_b;
        const Vec2 &p = forward ? a : b, &q = forward ? b : a;
        const double t = (forward ? of_a : of_b) / (forward ? of_a - of_b : of_b - of_a);
        Vec2 met = p + t * (q - p);
        met.*along = at;
        result.push_back(met);
    }
}

/// Area and middle of loops, by triangles to the origin.
struct LoopMoments {
    double twice_area = 0;
    Vec2 moment{0, 0};

    void add(std::span<const Vec2> loop) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const Vec2 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
            const double cross = a.x * b.y - b.x * a.y;
            twice_area += cross;
            moment = moment + cross * (a + b);
        }
    }
};

constexpr double kLeastShare = 1e-12;
constexpr double kWholeShare = 1.0 - 1e-9;

class BeamFilterRenderer final : public TileRenderer {
  public:
    BeamFilterRenderer(const WiderFrame& frame, const BeamScene& scene, const BeamTree& tree,
                       const BeamPixels& pixels, const BeamBands& bands)
        : job_(frame.job()),
          border_(frame.border()),
          tree_(tree),
          pixels_(pixels),
          bands_(bands),
          integral_(*job_.antialias->filter, job_.antialias->radius),
          shading_(job_, scene, tree) {
        for (int d = -border_; d <= border_; ++d) {
            whole_.push_back(integral_.between(d - 0.5, d + 0.5));
        }
    }

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        tile_ = tile;
        columns_ = static_cast<std::size_t>(tile.x1 - tile.x0);
        const std::size_t count = columns_ * static_cast<std::size_t>(tile.y1 - tile.y0);
        const bool layers = job_.aovs != nullptr && job_.aovs->wanted().has_geometry();
        sums_.assign(count, {});
        errors_.assign(count, 0.0);
        geometry_.assign(layers ? count : 0, PixelGeometry{.samples = 1});
        // Rows and columns of the wider frame.
        for (int j = tile.y0; j < tile.y1 + 2 * border_; ++j) {
            if (job_.stop_requested()) return;
            for (const std::uint32_t k : bands_.pieces_of(j)) add_piece(tree_.pieces[k], j);
        }
        for (std::size_t n = 0; n < count; ++n) {
            const int i = tile.x0 + static_cast<int>(n % columns_);
            const int j = tile.y0 + static_cast<int>(n / columns_);
            BoxFilter filter;
            counters.non_finite += !filter.add(sums_[n]);
            film.set(i, j, filter.value());
            if (layers) write_geometry(*job_.aovs, i, j, geometry_[n]);
            if (job_.aovs) job_.aovs->set(AovKind::RefractionError, i, j, {&errors_[n], 1});
        }
    }

  private:
    void add_piece(const BeamPiece& piece, int j) {
        const bool of_eye = tree_.beams[piece.beam].piece == kNoFacet;
        add_region(piece, piece.seen.region, j, [&](int i) {
            const std::ptrdiff_t n = pixel_at(i - border_, j - border_);
            if (n >= 0) {
                const auto pixel = static_cast<std::size_t>(n);
                errors_[pixel] = std::max(errors_[pixel], shading_.refraction_error());
                if (of_eye && !geometry_.empty() && geometry_[pixel].hits == 0) {
                    shading_.add_to(geometry_[pixel]);
                }
            }
            return shading_.own();
        });
        for (const BeamLight& light : piece.lights) {
            add_region(piece, light.part.region, j, [&](int) { return shading_.light(light); });
        }
    }

    template <class Shade>
    void add_region(const BeamPiece& piece, const PolygonSet& region, int j, const Shade& shade) {
        const double lo = pixels_.bottom(j), hi = pixels_.top(j);
        const LatticeBox& box = region.bounds();
        if (box.hi.y <= lo || box.lo.y >= hi) return;
        const std::span<const double> edges = pixels_.edges(tile_.x0, tile_.x1 + 2 * border_);
        parts_.find(region, tile_.x0, edges, lo, hi);
        for (const PixelParts::Part& part : parts_.parts()) {
            const auto column = static_cast<std::size_t>(part.i - tile_.x0);
            const double wide = edges[column + 1] - edges[column];
            const auto color_at = [&](const Vec2& at) {
                shading_.go(piece,
                            {edges[column] + (at.x + 0.5) * wide, lo + (at.y + 0.5) * (hi - lo)});
                return shade(part.i);
            };
            const bool whole = part.share >= kWholeShare;
            Rgb color;
            if (whole) {
                for (int n = 0; n < 4; ++n) {
                    color += 0.25 * color_at({(n & 1) != 0 ? kGauss : -kGauss,
                                              (n & 2) != 0 ? kGauss : -kGauss});
                }
            } else {
                color = color_at(part.middle);
            }
            spread(part, j, whole, color);
        }
    }

    /// Adds the light of a part to the pixels into whose filter it reaches.
    void spread(const PixelParts::Part& part, int j, bool whole, const Rgb& color) {
        for (int dj = -border_; dj <= border_; ++dj) {
            for (int di = -border_; di <= border_; ++di) {
                const std::ptrdiff_t n = pixel_at(part.i - border_ + di, j - border_ + dj);
                if (n < 0) continue;
                // From the centre of that pixel; rows count downwards.
                const Vec2 moved{-1.0 * di, 1.0 * dj};
                const double weight = whole ? whole_[static_cast<std::size_t>(border_ - di)] *
                                                  whole_[static_cast<std::size_t>(border_ + dj)]
                                            : weight_of(part, moved);
                sums_[static_cast<std::size_t>(n)] += weight * color;
            }
        }
    }
    [[nodiscard]] double weight_of(const PixelParts::Part& part, const Vec2& moved) const {
        double weight = 0.0;
        for (std::size_t l = part.first_loop; l < part.end_loop; ++l) {
            const std::span<const Vec2> loop = parts_.loop(l);
            for (std::size_t k = 0; k < loop.size(); ++k) {
                weight += integral_.along(loop[k] + moved,
                                          loop[k + 1 == loop.size() ? 0 : k + 1] + moved);
            }
        }
        return weight;
    }
    /// The number of a pixel of the film in the tile; -1 outside of it.
    [[nodiscard]] std::ptrdiff_t pixel_at(int i, int j) const {
        if (i < tile_.x0 || i >= tile_.x1 || j < tile_.y0 || j >= tile_.y1) return -1;
        return (j - tile_.y0) * static_cast<std::ptrdiff_t>(columns_) + (i - tile_.x0);
    }

    static constexpr double kGauss = 0.28867513459481287;  ///< 1 / sqrt(12)
    const RenderJob& job_;
    int border_;
    const BeamTree& tree_;
    const BeamPixels& pixels_;
    const BeamBands& bands_;
    FilterIntegral integral_;
    BeamShading shading_;
    std::vector<double> whole_;  ///< [distance + border] the kernel over a pixel, along one axis
    PixelParts parts_;
    PixelBox tile_;
    std::size_t columns_ = 0;
    std::vector<Rgb> sums_;
    std::vector<PixelGeometry> geometry_;
    std::vector<double> errors_;
};

}  // namespace

WiderFrame::WiderFrame(const RenderJob& job, const Film& film, bool filtered)
    : job_(job),
      border_(filtered ? reach_of(job) : 0),
      width_(film.frame_width() + 2 * border_),
      height_(film.frame_height() + 2 * border_),
      crop_(film.crop()) {
    crop_.x1 += 2 * border_;
    crop_.y1 += 2 * border_;
    if (border_ > 0) {
        job_.camera = widened(job.camera, double(width_) / film.frame_width(),
                              double(height_) / film.frame_height());
    }
}

std::unique_ptr<TileRenderer> beam_filter_renderer(const WiderFrame& frame, const BeamScene& scene,
                                                   const BeamTree& tree, const BeamPixels& pixels,
                                                   const BeamBands& bands) {
    return std::make_unique<BeamFilterRenderer>(frame, scene, tree, pixels, bands);
}

void PixelParts::find(const PolygonSet& region, int first, std::span<const double> edges, double lo,
                      double hi) {
    parts_.clear();
    points_.clear();
    ends_.clear();
    strip_.clear();
    strip_ends_.clear();
    double from = edges.back(), to = edges.front();
    for (std::size_t l = 0; l < region.loop_count(); ++l) {
        one_.clear();
        for (const LatticePoint& p : region.loop(l)) one_.push_back({1.0 * p.x, 1.0 * p.y});
        cut_loop(one_, 1, lo, true, other_);
        cut_loop(other_, 1, hi, false, one_);
        if (one_.size() < 3) continue;
        for (const Vec2& p : one_) {
            from = std::min(from, p.x);
            to = std::max(to, p.x);
        }
        strip_.insert(strip_.end(), one_.begin(), one_.end());
        strip_ends_.push_back(strip_.size());
    }
    const auto begin = std::upper_bound(edges.begin(), edges.end(), from) - edges.begin() - 1;
    for (auto c = std::max<std::ptrdiff_t>(begin, 0);
         c + 1 < static_cast<std::ptrdiff_t>(edges.size()); ++c) {
        const auto column = static_cast<std::size_t>(c);
        if (edges[column] >= to) break;
        add_pixel({edges[column], lo}, {edges[column + 1] - edges[column], hi - lo},
                  first + static_cast<int>(c));
    }
}

void PixelParts::add_pixel(const Vec2& corner, const Vec2& size, int number) {
    Part part;
    part.i = number;
    part.first_loop = ends_.size();
    LoopMoments moments;
    std::size_t begin = 0;
    for (const std::size_t end : strip_ends_) {
        const auto loop = std::span<const Vec2>(strip_).subspan(begin, end - begin);
        begin = end;
        cut_loop(loop, 0, corner.x, true, one_);
        cut_loop(one_, 0, corner.x + size.x, false, other_);
        if (other_.size() < 3) continue;
        for (Vec2& p : other_) {
            p = {(p.x - corner.x) / size.x - 0.5, (p.y - corner.y) / size.y - 0.5};
        }
        moments.add(other_);
        points_.insert(points_.end(), other_.begin(), other_.end());
        ends_.push_back(points_.size());
    }
    part.end_loop = ends_.size();
    part.share = 0.5 * moments.twice_area;
    if (!(part.share > kLeastShare)) return;
    const Vec2 middle = (1.0 / (3.0 * moments.twice_area)) * moments.moment;
    part.middle = {std::clamp(middle.x, -0.5, 0.5), std::clamp(middle.y, -0.5, 0.5)};
    parts_.push_back(part);
}

}  // namespace alhazen
