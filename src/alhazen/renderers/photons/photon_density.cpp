#include "alhazen/renderers/photons/photon_density.h"

#include <algorithm>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"

namespace alhazen {

double filter_weight(DensityFilter filter, double share) {
    constexpr double kCone = 1.1;     // Jensen's k: at the border 1 - 1 / k is left
    constexpr double kGauss = 1.953;  // Jensen's beta
    switch (filter) {
        case DensityFilter::Cone:
            return (1.0 - std::sqrt(share) / kCone) / (1.0 - 2.0 / (3.0 * kCone));
        case DensityFilter::Gauss: {
            const double all = 1.0 - std::exp(-kGauss);
            const double mean = 1.0 - (1.0 - 2.0 / kGauss * (1.0 - std::exp(-0.5 * kGauss))) / all;
            return (1.0 - (1.0 - std::exp(-0.5 * kGauss * share)) / all) / mean;
        }
        case DensityFilter::Disc:
            break;
    }
    return 1.0;
}

Spectrum scattered_light(const ScatterPoint& at, const Photon& photon, LightPart part,
                         bool hero_only) {
    const Vec3 from = photon.from.vector();
    const Spectrum value = at.value(from, Transport::Radiance);
    if (value.is_black()) return {};
    if (part == LightPart::NotGlossy && at.density(from) > kGlossyDensity) return {};
    // Flux by area counts the geometric cosine, the value that of the shading normal.
    const double cosine = std::abs(dot(from, at.geometric()));
    if (!(cosine > 0.0)) return {};
    const Spectrum light = (1.0 / cosine) * (value * photon.light());
    return hero_only && photon.hero_only() ? (1.0 / Spectrum::kCount) * light : light;
}

double photons_by_area(const PhotonMap& map, const Vec3& point, const Vec3& normal) {
    std::vector<PhotonTree::Near> found;
    map.tree.nearest(point, map.nearest, map.radius * map.radius, PhotonFits(normal, false), found);
    if (found.empty()) return 0.0;
    const bool bounded = found.size() == map.nearest && map.nearest > 1;
    const double squared = bounded ? found.front().squared : map.radius * map.radius;
    const double count = static_cast<double>(found.size()) - (bounded ? 1.0 : 0.0);
    return squared > 0.0 ? count / (kPi * squared) : 0.0;
}

double usual_radius(const PhotonTree& tree, std::size_t nearest) {
    constexpr std::size_t kProbes = 512;
    const std::size_t size = tree.photons().size();
    if (size == 0) return 0.0;
    std::vector<double> squares;
    std::vector<PhotonTree::Near> found;
    const std::size_t step = std::max<std::size_t>(1, size / kProbes);
    for (std::size_t i = 0; i < size; i += step) {
        tree.nearest(
            tree.photons()[i].point(), nearest, kInfinity, [](const Photon&) { return true; },
            found);
        squares.push_back(found.front().squared);
    }
    const auto most = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() * 9 / 10);
    std::nth_element(squares.begin(), most, squares.end());
    return 2.0 * std::sqrt(*most);
}

Spectrum PhotonDensity::radiance(const PhotonMap& map, const ScatterPoint& at, const Vec3& point,
                                 LightPart part, bool hero_only) {
    double squared = map.radius * map.radius;
    map.tree.nearest(point, map.nearest, squared, PhotonFits(at), found_);
    if (found_.empty()) return {};
    std::size_t first = 0;
    if (found_.size() == map.nearest && map.nearest > 1) {
        squared = found_.front().squared;
        first = 1;
    }
    if (!(squared > 0.0)) return {};
    Spectrum sum;
    for (std::size_t i = first; i < found_.size(); ++i) {
        const Photon& photon = map.tree.photons()[found_[i].node];
        sum += filter_weight(map.filter, found_[i].squared / squared) *
               scattered_light(at, photon, part, hero_only);
    }
    return (1.0 / (kPi * squared)) * sum;
}

Spectrum scattered_light(const VolumePoint& at, const Photon& photon, bool hero_only) {
    const double phase = henyey_greenstein(dot(at.along, photon.from.vector()), at.anisotropy);
    const double share = hero_only && photon.hero_only() ? 1.0 / Spectrum::kCount : 1.0;
    return (share * phase) * photon.light();
}

Spectrum PhotonDensity::radiance(const PhotonMap& map, const VolumePoint& at, bool hero_only) {
    double squared = map.radius * map.radius;
    map.tree.nearest(
        at.point, map.nearest, squared, [](const Photon&) { return true; }, found_);
    if (found_.empty()) return {};
    std::size_t first = 0;
    if (found_.size() == map.nearest && map.nearest > 1) {
        squared = found_.front().squared;
        first = 1;
    }
    if (!(squared > 0.0)) return {};
    Spectrum sum;
    for (std::size_t i = first; i < found_.size(); ++i) {
        sum += scattered_light(at, map.tree.photons()[found_[i].node], hero_only);
    }
    return (3.0 / (4.0 * kPi * squared * std::sqrt(squared))) * sum;
}

}  // namespace alhazen
