#include "alhazen/laboratory/claims/sampled_pictures.h"

#include <algorithm>
#include <cmath>

#include "alhazen/scene/scene.h"

namespace alhazen {

SampledPicture sampled(const Scene& scene, const Renderer& renderer, int side, int samples,
                       const SampleChoice& choice, std::uint64_t seed) {
    const CameraDescription& camera = find_camera(scene, "");
    RenderJob job{.scene = scene, .camera = with_aspect(camera.camera, camera.aspect, 1.0)};
    job.samples_per_pixel = samples;
    job.seed = seed;
    job.antialias = choice.antialias;
    job.sampling = choice.sampling;
    job.control.threads = 1;
    SampledPicture picture{Film(side, side, {0, 0, side, side}), {}};
    picture.report = renderer.render(job, picture.film);
    return picture;
}

double shown_rmse(const Film& a, const Film& b) {
    const PixelBox& crop = a.crop();
    double sum = 0;
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double d = std::min(a.at(x, y)[c], 1.0) - std::min(b.at(x, y)[c], 1.0);
                sum += d * d;
            }
        }
    }
    return std::sqrt(sum / (3.0 * static_cast<double>(crop.area())));
}

double rays_for(std::span<const RaysAndError> uniform, double error) {
    std::size_t k = 1;
    while (k + 1 < uniform.size() && uniform[k].error > error) ++k;
    const RaysAndError &a = uniform[k - 1], &b = uniform[k];
    const double slope = std::log(b.rays / a.rays) / std::log(b.error / a.error);
    return a.rays * std::pow(error / a.error, slope);
}

}  // namespace alhazen
