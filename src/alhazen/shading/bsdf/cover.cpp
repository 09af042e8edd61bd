#include "alhazen/shading/bsdf/cover.h"

#include <algorithm>

#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/ggx_albedo.h"
#include "alhazen/shading/microfacets/lobe_albedo.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

Cover Cover::face(double alpha, double f0, double f90, double share) {
    Cover cover;
    cover.share_ = std::clamp(share, 0.0, 1.0);
    cover.roughness_ = alpha;
    cover.f0_ = std::clamp(f0, 0.0, 1.0);
    cover.f90_ = std::clamp(f90, 0.0, 1.0);
    if (alpha >= kSmoothAlpha) {
        const double mean = cover.f0_ + (cover.f90_ - cover.f0_) / 21.0;
        const double single = ggx_mean_albedo(alpha).sum();
        cover.several_ = mean * mean * single / (1.0 - mean * (1.0 - single));
    }
    return cover;
}

Cover Cover::sheen(double roughness, double color) {
    Cover cover;
    cover.sheen_ = true;
    cover.share_ = std::clamp(color, 0.0, 1.0);
    cover.roughness_ = roughness;
    return cover;
}

double Cover::transmittance(double cosine) const {
    double reflected = 0;
    if (sheen_) {
        reflected = sheen_albedo(cosine, roughness_);
    } else if (roughness_ < kSmoothAlpha) {
        reflected = f0_ + schlick_weight(cosine) * (f90_ - f0_);
    } else {
        const SplitAlbedo one = ggx_albedo(cosine, roughness_);
        reflected = f0_ * one.at_f0 + f90_ * one.at_f90 + several_ * (1.0 - one.sum());
    }
    return std::clamp(1.0 - share_ * reflected, 0.0, 1.0);
}

double Cover::mean_transmittance() const {
    if (roughness_ < kSmoothAlpha) return 1.0 - share_ * (f0_ + (f90_ - f0_) / 21.0);
    const SplitAlbedo one = ggx_mean_albedo(roughness_);
    const double reflected = f0_ * one.at_f0 + f90_ * one.at_f90 + several_ * (1.0 - one.sum());
    return 1.0 - share_ * reflected;
}

}  // namespace alhazen
