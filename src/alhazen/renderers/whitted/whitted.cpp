#include "alhazen/renderers/whitted/whitted.h"

#include "alhazen/renderers/core/pixel_loop.h"
#include "alhazen/renderers/whitted/recursive_estimator.h"

namespace alhazen {

std::unique_ptr<TileRenderer> Whitted::begin(const RenderJob& job) const {
    return make_pixel_renderer<RecursiveEstimator<NoRandomness>>(job, rays_at_once_, split());
}

std::unique_ptr<RayAnswers> Whitted::answers(const RenderJob& job) const {
    return std::make_unique<EstimatorAnswers<RecursiveEstimator<NoRandomness>>>(job, split());
}

}  // namespace alhazen
