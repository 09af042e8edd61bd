#pragma once
/// The loop over the pixels and samples of a tile that renderers share.

#include <span>
#include <vector>

#include "alhazen/renderers/aov.h"
#include "alhazen/renderers/eye_samples.h"
#include "alhazen/renderers/renderer.h"

namespace alhazen {

/// Gathers eye rays, block by block of pixels, and gives their light back to the pixels.
class PixelLoop {
  public:
    PixelLoop(const RenderJob& job, const PixelBox& tile, Film& film, RayCounters& counters)
        : job_(job), film_(film), counters_(counters), aovs_(job, counters) {
        // Blocks of pixels: rays that follow each other stay near each other.
        for (const PixelBox& block : tiles_of(tile, kBlock)) {
            for (int j = block.y0; j < block.y1; ++j) {
                for (int i = block.x0; i < block.x1; ++i) pixels_.push_back({i, j});
            }
        }
    }

    /// As `render_pixels`.
    template <class Radiance>
    void run(std::size_t at_once, Radiance&& radiance) {
        // What a pixel costs is known where its rays are alone.
        const bool alone = job_.aovs != nullptr && job_.aovs->wanted().has_costs();
        for (const Pixel& pixel : pixels_) {
            aovs_.begin_pixel();
            for (int s = 0; s < job_.samples_per_pixel; ++s) {
                const Vec2 p = eye_sample(job_, pixel.i, pixel.j, film_.frame_width(),
                                          film_.frame_height(), s);
                rays_.push_back(eye_ray(job_.camera, p.x, p.y));
                if (rays_.size() == at_once && !trace(radiance)) return;
            }
            if (alone && !trace(radiance)) return;
        }
        trace(radiance);
    }

  private:
    static constexpr int kBlock = 8;
    struct Pixel {
        int i, j;
    };

    /// False when the job is to stop.
    template <class Radiance>
    bool trace(Radiance& radiance) {
        if (job_.stop_requested()) return false;
        radiance_.assign(rays_.size(), Rgb{});
        radiance(std::span<const Ray>(rays_), std::span<Rgb>(radiance_));
        // What was cut short is given up.
        if (job_.stop_requested()) return false;
        for (const Rgb& c : radiance_) take(c);
        rays_.clear();
        return true;
    }

    void take(const Rgb& c) {
        if (c.is_finite()) {
            sum_ += c;
            ++finite_;
        } else {
            ++counters_.non_finite;
        }
        if (++samples_ == job_.samples_per_pixel) end_pixel();
    }

    void end_pixel() {
        const auto [i, j] = pixels_[done_++];
        film_.set(i, j, finite_ == 1 ? sum_ : finite_ > 1 ? (1.0 / finite_) * sum_ : Rgb{});
        aovs_.end_pixel(i, j, film_.frame_width(), film_.frame_height());
        sum_ = {};
        finite_ = samples_ = 0;
    }

    const RenderJob& job_;
    Film& film_;
    RayCounters& counters_;
    AovRecorder aovs_;
    std::vector<Ray> rays_;
    std::vector<Rgb> radiance_;
    std::vector<Pixel> pixels_;
    std::size_t done_ = 0;  ///< pixels that have their light
    int samples_ = 0, finite_ = 0;
    Rgb sum_;
};

/// Calls `radiance(std::span<const Ray> eye_rays, std::span<Rgb> radiance)` for at most `at_once`
/// samples after the other, until it has all, and writes the mean of a pixel's finite ones to the
/// film. Returns early when the job is to stop; no pixel is left half done.
template <class Radiance>
void render_pixels(const RenderJob& job, const PixelBox& tile, Film& film, RayCounters& counters,
                   std::size_t at_once, Radiance&& radiance) {
    PixelLoop(job, tile, film, counters).run(at_once, radiance);
}

}  // namespace alhazen
