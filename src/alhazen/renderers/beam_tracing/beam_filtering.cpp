#include "alhazen/renderers/beam_tracing/beam_filtering.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "alhazen/imaging/film/filter_integral.h"
#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/renderers/beam_tracing/beam_shading.h"
#include "alhazen/renderers/beam_tracing/pixel_quadrature.h"
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

constexpr double kLeastBeamShare = 1e-12;
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
          shading_(job_, scene, tree),
          quadrature_(job_.antialias->error) {
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
            FiniteMean mean;
            counters.non_finite += !mean.add(sums_[n]);
            film.set(i, j, mean.value());
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
        strip_.set(region, lo, hi);
        const std::span<const double> edges = pixels_.edges(tile_.x0, tile_.x1 + 2 * border_);
        const auto begin = std::upper_bound(edges.begin(), edges.end(), strip_.left());
        for (auto c = std::max<std::ptrdiff_t>(begin - edges.begin() - 1, 0);
             c + 1 < static_cast<std::ptrdiff_t>(edges.size()); ++c) {
            const double left = edges[static_cast<std::size_t>(c)];
            const double right = edges[static_cast<std::size_t>(c + 1)];
            if (left >= strip_.right()) break;
            strip_.cut(left, right, part_);
            const double share = rule_of(part_).area;
            if (!(share > kLeastBeamShare)) continue;
            const int column = tile_.x0 + static_cast<int>(c);
            const Rgb color = quadrature_.mean(part_, [&](const Vec2& at, double width) {
                shading_.filter_over(width);
                shading_.go(piece,
                            {left + (at.x + 0.5) * (right - left), lo + (at.y + 0.5) * (hi - lo)});
                return shade(column);
            });
            spread(column, j, share >= kWholeShare, color);
        }
    }

    /// Adds the light of a part in a column to the pixels whose filter reaches it.
    void spread(int column, int j, bool whole, const Rgb& color) {
        for (int dj = -border_; dj <= border_; ++dj) {
            for (int di = -border_; di <= border_; ++di) {
                const std::ptrdiff_t n = pixel_at(column - border_ + di, j - border_ + dj);
                if (n < 0) continue;
                // Relative to the centre of that pixel; rows count downwards.
                const Vec2 moved{-1.0 * di, 1.0 * dj};
                const double weight = whole ? whole_[static_cast<std::size_t>(border_ - di)] *
                                                  whole_[static_cast<std::size_t>(border_ + dj)]
                                            : weight_of(moved);
                sums_[static_cast<std::size_t>(n)] += weight * color;
            }
        }
    }
    [[nodiscard]] double weight_of(const Vec2& moved) const {
        double weight = 0.0;
        for (std::size_t l = 0; l < part_.ends.size(); ++l) {
            const std::span<const Vec2> loop = part_.loop(l);
            for (std::size_t k = 0; k < loop.size(); ++k) {
                weight += integral_.along(loop[k] + moved,
                                          loop[k + 1 == loop.size() ? 0 : k + 1] + moved);
            }
        }
        return weight;
    }
    /// Index of a pixel of the film in the tile; -1 outside.
    [[nodiscard]] std::ptrdiff_t pixel_at(int i, int j) const {
        if (i < tile_.x0 || i >= tile_.x1 || j < tile_.y0 || j >= tile_.y1) return -1;
        return (j - tile_.y0) * static_cast<std::ptrdiff_t>(columns_) + (i - tile_.x0);
    }

    const RenderJob& job_;
    int border_;
    const BeamTree& tree_;
    const BeamPixels& pixels_;
    const BeamBands& bands_;
    FilterIntegral integral_;
    BeamShading shading_;
    std::vector<double> whole_;  ///< [distance + border] the kernel over a pixel, along one axis
    PixelQuadrature quadrature_;
    RowStrip strip_;
    PixelPolygon part_;
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

}  // namespace alhazen
