#include "alhazen/shading/bsdf/cover.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/microfacets/anisotropic_albedo.h"
#include "alhazen/shading/microfacets/anisotropic_split.h"
#include "alhazen/shading/microfacets/lobe_albedo.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

Cover Cover::face(double alpha, double f0, double f90, double share) {
    return face({alpha, alpha}, {1, 0}, f0, f90, share);
}

Cover Cover::face(const Ggx& ggx, const Vec2& axis, double f0, double f90, double share) {
    Cover cover;
    cover.share_ = std::clamp(share, 0.0, 1.0);
    cover.ggx_ = ggx;
    cover.axis_ = axis;
    cover.f0_ = std::clamp(f0, 0.0, 1.0);
    cover.f90_ = std::clamp(f90, 0.0, 1.0);
    if (cover.is_rough()) {
        const double mean = cover.f0_ + (cover.f90_ - cover.f0_) / 21.0;
        const double single =
            cover.is_anisotropic() ? mean_anisotropic_albedo(ggx) : ggx_mean_albedo(ggx.x).sum();
        cover.several_ = mean * mean * single / (1.0 - mean * (1.0 - single));
    }
    return cover;
}

Cover Cover::sheen(double roughness, double color) {
    Cover cover;
    cover.sheen_ = true;
    cover.share_ = std::clamp(color, 0.0, 1.0);
    cover.ggx_ = {roughness, roughness};
    return cover;
}

SplitAlbedo Cover::single(const Vec3& direction) const {
    const double z = std::abs(direction.z);
    if (!is_anisotropic()) return ggx_albedo(z, ggx_.x);
    return anisotropic_split_albedo({axis_.x * direction.x + axis_.y * direction.y,
                                     axis_.x * direction.y - axis_.y * direction.x, z},
                                    ggx_);
}

double Cover::transmittance(const Vec3& direction) const {
    double reflected = 0;
    if (sheen_) {
        reflected = sheen_albedo(std::abs(direction.z), ggx_.x);
    } else if (!is_rough()) {
        reflected = f0_ + schlick_weight(std::abs(direction.z)) * (f90_ - f0_);
    } else {
        reflected = reflectance(single(direction));
    }
    return std::clamp(1.0 - share_ * reflected, 0.0, 1.0);
}

double Cover::mean_transmittance() const {
    if (!is_rough()) return 1.0 - share_ * (f0_ + (f90_ - f0_) / 21.0);
    return 1.0 - share_ * reflectance(is_anisotropic() ? mean_anisotropic_split_albedo(ggx_)
                                                       : ggx_mean_albedo(ggx_.x));
}

double Cover::reflectance(const SplitAlbedo& one) const {
    return f0_ * one.at_f0 + f90_ * one.at_f90 + several_ * (1.0 - one.sum());
}

}  // namespace alhazen
