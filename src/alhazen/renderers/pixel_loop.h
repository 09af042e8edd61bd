#pragma once
/// The loop over the pixels and samples of a tile that renderers share.

#include "alhazen/renderers/aov.h"
#include "alhazen/renderers/eye_samples.h"
#include "alhazen/renderers/renderer.h"

namespace alhazen {

/// Calls `radiance(const Ray& eye_ray)` -> Rgb for each sample and writes the mean of the finite
/// ones to the film. Returns early when the job is to stop; no pixel is left half done.
template <class Radiance>
void render_pixels(const RenderJob& job, const PixelBox& tile, Film& film, RayCounters& counters,
                   Radiance&& radiance) {
    const int width = film.frame_width();
    const int height = film.frame_height();
    AovRecorder aovs(job, counters);
    for (int j = tile.y0; j < tile.y1; ++j) {
        for (int i = tile.x0; i < tile.x1; ++i) {
            if (job.stop_requested()) return;
            aovs.begin_pixel();
            Rgb sum;
            int finite = 0;
            for (int s = 0; s < job.samples_per_pixel; ++s) {
                const Vec2 p = eye_sample(job, i, j, width, height, s);
                const Rgb c = radiance(eye_ray(job.camera, p.x, p.y));
                // The pixel is given up: its last sample may be cut short.
                if (job.stop_requested()) return;
                if (c.is_finite()) {
                    sum += c;
                    ++finite;
                } else {
                    ++counters.non_finite;
                }
            }
            film.set(i, j, finite == 1 ? sum : finite > 1 ? (1.0 / finite) * sum : Rgb{});
            aovs.end_pixel(i, j, width, height);
        }
    }
}

}  // namespace alhazen
