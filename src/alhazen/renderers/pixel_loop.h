#pragma once
/// The loop over the pixels and samples of tiles that renderers share.
///
/// Source: none. Differs: nothing. Conventions: all memory is kept from tile to tile. Threads:
/// belongs to one.

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/aov.h"
#include "alhazen/renderers/eye_samples.h"
#include "alhazen/renderers/renderer.h"
#include "alhazen/scene/eye_rays.h"

namespace alhazen {

/// Gathers eye rays, block by block of pixels, and gives their light back to the pixels.
class PixelLoop {
  public:
    /// `at_once`: so many samples are traced together at most.
    PixelLoop(const RenderJob& job, std::size_t at_once, RayCounters& counters)
        : job_(job),
          counters_(counters),
          aovs_(job, counters),
          eye_(job.camera),
          rays_(at_once),
          radiance_(at_once) {}

    /// Calls `radiance(std::span<const Ray> eye_rays, std::span<Rgb> radiance)` for some samples
    /// after the other, until it has all, and writes the mean of a pixel's finite ones to the film.
    /// Returns early when the job is to stop; no pixel is left half done.
    template <class Radiance>
    void run(const PixelBox& tile, Film& film, Radiance&& radiance) {
        begin_tile(tile, film);
        // What a pixel costs is known where its rays are alone.
        const bool alone = job_.aovs != nullptr && job_.aovs->wanted().has_costs();
        for (const Pixel& pixel : pixels_) {
            if (job_.aovs != nullptr) aovs_.begin_pixel();
            for (int s = 0; s < job_.samples_per_pixel; ++s) {
                rays_[gathered_++] = eye_ray_of(pixel, tile, s);
                if (gathered_ == rays_.size() && !trace(film, radiance)) return;
            }
            if (alone && !trace(film, radiance)) return;
        }
        trace(film, radiance);
    }

  private:
    static constexpr int kBlock = 8;
    struct Pixel {
        int i, j;
    };

    void begin_tile(const PixelBox& tile, const Film& film) {
        width_ = film.frame_width();
        height_ = film.frame_height();
        gathered_ = done_ = 0;
        samples_ = finite_ = 0;
        sum_ = {};
        pixels_.clear();
        // Blocks of pixels: rays that follow each other stay near each other.
        for (int y = tile.y0; y < tile.y1; y += kBlock) {
            for (int x = tile.x0; x < tile.x1; x += kBlock) {
                for (int j = y; j < std::min(y + kBlock, tile.y1); ++j) {
                    for (int i = x; i < std::min(x + kBlock, tile.x1); ++i)
                        pixels_.push_back({i, j});
                }
            }
        }
        if (job_.samples_per_pixel != 1) return;
        columns_.clear();
        rows_.clear();
        const auto sample = [&](int i, int j) {
            return single_sample(job_.scene.conventions.pixel_sample, i, j, width_, height_);
        };
        for (int i = tile.x0; i < tile.x1; ++i) columns_.push_back(eye_.column(sample(i, 0).x));
        for (int j = tile.y0; j < tile.y1; ++j) rows_.push_back(eye_.row(sample(0, j).y));
    }

    [[nodiscard]] Ray eye_ray_of(const Pixel& pixel, const PixelBox& tile, int s) const {
        if (job_.samples_per_pixel == 1) {
            return eye_.ray(columns_[static_cast<std::size_t>(pixel.i - tile.x0)],
                            rows_[static_cast<std::size_t>(pixel.j - tile.y0)]);
        }
        const Vec2 p = jittered_sample(job_, pixel.i, pixel.j, width_, height_, s);
        return eye_.ray(eye_.column(p.x), eye_.row(p.y));
    }

    /// False when the job is to stop.
    template <class Radiance>
    bool trace(Film& film, Radiance& radiance) {
        if (job_.stop_requested()) return false;
        const std::span<Rgb> found = std::span(radiance_).first(gathered_);
        std::fill(found.begin(), found.end(), Rgb{});
        radiance(std::span<const Ray>(rays_).first(gathered_), found);
        // What was cut short is given up.
        if (job_.stop_requested()) return false;
        if (job_.samples_per_pixel == 1 && job_.aovs == nullptr) {
            take_pixels(film, found);
        } else {
            for (const Rgb& c : found) take(film, c);
        }
        gathered_ = 0;
        return true;
    }

    /// As `take`, where each is a pixel and nobody records them.
    void take_pixels(Film& film, std::span<const Rgb> found) {
        const Pixel* pixel = pixels_.data() + done_;
        for (const Rgb& c : found) {
            const bool finite = c.is_finite();
            counters_.non_finite += !finite;
            film.set(pixel->i, pixel->j, finite ? Rgb{} + c : Rgb{});
            ++pixel;
        }
        done_ += found.size();
    }

    void take(Film& film, const Rgb& c) {
        if (c.is_finite()) {
            sum_ += c;
            ++finite_;
        } else {
            ++counters_.non_finite;
        }
        if (++samples_ == job_.samples_per_pixel) end_pixel(film);
    }

    void end_pixel(Film& film) {
        const auto [i, j] = pixels_[done_++];
        film.set(i, j, finite_ == 1 ? sum_ : finite_ > 1 ? (1.0 / finite_) * sum_ : Rgb{});
        if (job_.aovs != nullptr) aovs_.end_pixel(i, j, width_, height_);
        sum_ = {};
        finite_ = samples_ = 0;
    }

    const RenderJob& job_;
    RayCounters& counters_;
    AovRecorder aovs_;
    EyeRays eye_;
    int width_ = 0, height_ = 0;        ///< of the frame
    std::vector<Vec3> columns_, rows_;  ///< of the tile, where a pixel has one sample
    std::vector<Ray> rays_;
    std::size_t gathered_ = 0;  ///< of them
    std::vector<Rgb> radiance_;
    std::vector<Pixel> pixels_;
    std::size_t done_ = 0;  ///< pixels that have their light
    int samples_ = 0, finite_ = 0;
    Rgb sum_;
};

/// Renders tiles with `Integrator(job, rays_at_once, counters)`, whose `trace(eye_rays, radiance)`
/// does the work.
template <class Integrator>
class PixelRenderer final : public TileRenderer {
  public:
    PixelRenderer(const RenderJob& job, std::size_t rays_at_once)
        : integrator_(job, rays_at_once, counters_), loop_(job, rays_at_once, counters_) {}

    void render(const PixelBox& tile, Film& film, RayCounters& counters) override {
        loop_.run(tile, film, [&](std::span<const Ray> rays, std::span<Rgb> radiance) {
            integrator_.trace(rays, radiance);
        });
        counters += counters_;
        counters_ = {};
    }

  private:
    RayCounters counters_;  ///< of the tile
    Integrator integrator_;
    PixelLoop loop_;
};

}  // namespace alhazen
