#include "alhazen/renderers/photons/photon_density.h"

#include <algorithm>
#include <span>

#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"

namespace alhazen {

namespace {

/// The photons of an estimate.
struct CountedPhotons {
    std::span<const PhotonTree::Near> photons;
    double squared = 0;  ///< radius of the estimate; 0: no photons
};

/// The farthest of the nearest photons determines the radius and is not counted. `found` holds
/// them. `guess`: of the squared radius, updated for a nearby point; 0: none.
template <class Accept>
CountedPhotons counted_photons(const PhotonMap& map, const Vec3& point, const Accept& accept,
                               double& guess, std::vector<PhotonTree::Near>& found) {
    const double most = map.radius * map.radius;
    map.tree.nearest(point, map.nearest, most, guess, accept, found);
    const bool all = found.size() < map.nearest || map.nearest == 1;
    constexpr double kMore = 1.25;  // largest growth of the radius to the next estimate
    guess = all ? most : kMore * found.front().squared;
    if (found.empty()) return {};
    if (all) return {found, most};
    return {std::span(found).subspan(1), found.front().squared};
}

}  // namespace

double filter_weight(DensityFilter filter, double share) {
    constexpr double kCone = 1.1;     // Jensen's k: the weight at the border is 1 - 1 / k
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
    // Flux per area uses the geometric cosine, the BSDF value that of the shading normal.
    const double cosine = std::abs(dot(from, at.geometric()));
    if (!(cosine > 0.0)) return {};
    const Spectrum light = (1.0 / cosine) * (value * photon.light());
    return hero_only && photon.hero_only() ? (1.0 / Spectrum::kCount) * light : light;
}

PhotonScattering::PhotonScattering(const ScatterPoint& at, LightPart part, bool hero_only)
    : at_(at), part_(part), hero_only_(hero_only) {
    // The density is at most 1 / pi: no direction is glossy.
    static_assert(kGlossyDensity > 1.0 / kPi);
    if (const auto reflectance = at.lambert()) matt_ = (1.0 / kPi) * *reflectance;
}

Spectrum PhotonScattering::operator()(const Photon& photon) const {
    if (!matt_) return scattered_light(at_, photon, part_, hero_only_);
    const Vec3 from = photon.from.vector();
    const double shading = dot(from, at_.normal()), cosine = dot(from, at_.geometric());
    if (!(shading > 0.0 && cosine > 0.0)) return {};
    const double share = hero_only_ && photon.hero_only() ? 1.0 / Spectrum::kCount : 1.0;
    return (share * (shading / cosine)) * (*matt_ * photon.light());
}

double photons_by_area(const PhotonMap& map, const Vec3& point, const Vec3& normal) {
    std::vector<PhotonTree::Near> found;
    double guess = 0.0;
    const auto [photons, squared] =
        counted_photons(map, point, PhotonFits(normal, false), guess, found);
    return squared > 0.0 ? static_cast<double>(photons.size()) / (kPi * squared) : 0.0;
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

void compute_irradiance(PhotonMap& map, const StopFlag* stop) {
    const std::span<const Photon> photons = map.tree.photons();
    map.irradiance.assign(photons.size(), {});
    constexpr std::size_t kTogether = 256;
    parallel_for(photons.size(), kTogether, [&](std::size_t begin, std::size_t end) {
        std::vector<PhotonTree::Near> found;
        double guess = 0.0;
        for (std::size_t i = begin; i < end; ++i) {
            if (stop != nullptr && stop->requested()) return;
            const PhotonFits fits(photons[i].normal.vector(), false);
            const auto [around, squared] =
                counted_photons(map, photons[i].point(), fits, guess, found);
            if (!(squared > 0.0)) continue;
            Spectrum sum;
            for (const PhotonTree::Near& near : around) {
                if (near.node == i) continue;
                sum +=
                    filter_weight(map.filter, near.squared / squared) * photons[near.node].light();
            }
            map.irradiance[i] = (1.0 / (kPi * squared)) * sum;
        }
    });
}

double& PhotonDensity::guess_of(const PhotonMap& map) {
    const auto is_of = [&](const Guess& guess) { return guess.map == &map; };
    const auto found = std::find_if(guesses_.begin(), guesses_.end(), is_of);
    if (found != guesses_.end()) return found->squared;
    guesses_.push_back({&map, 0.0});
    return guesses_.back().squared;
}

std::optional<Spectrum> PhotonDensity::known_irradiance(const PhotonMap& map,
                                                        const ScatterPoint& at, const Vec3& point) {
    constexpr std::size_t kAround = 8;
    map.tree.nearest(point, kAround, map.radius * map.radius, PhotonFits(at), found_);
    if (found_.size() < kAround) return std::nullopt;
    const double border = std::sqrt(found_.front().squared);
    Spectrum sum;
    double weights = 0.0;
    for (const PhotonTree::Near& near : found_) {
        const double weight = border - std::sqrt(near.squared);
        sum += weight * map.irradiance[near.node];
        weights += weight;
    }
    if (!(weights > 0.0)) return std::nullopt;
    return (1.0 / weights) * sum;
}

Spectrum PhotonDensity::radiance(const PhotonMap& map, const ScatterPoint& at, const Vec3& point,
                                 LightPart part, bool hero_only) {
    // Irradiance uses the geometric cosine of each photon, not that of another normal.
    constexpr double kSameNormal = 0.999;  // within 2.6 degrees
    if (!map.irradiance.empty() && dot(at.normal(), at.geometric()) > kSameNormal) {
        if (const auto matt = at.lambert()) {
            if (const auto known = known_irradiance(map, at, point)) {
                return (1.0 / kPi) * (*matt * *known);
            }
        }
    }
    const auto [photons, squared] =
        counted_photons(map, point, PhotonFits(at), guess_of(map), found_);
    if (!(squared > 0.0)) return {};
    const PhotonScattering scattered(at, part, hero_only);
    Spectrum sum;
    for (const PhotonTree::Near& near : photons) {
        sum += filter_weight(map.filter, near.squared / squared) *
               scattered(map.tree.photons()[near.node]);
    }
    return (1.0 / (kPi * squared)) * sum;
}

Spectrum scattered_light(const VolumePoint& at, const Photon& photon, bool hero_only) {
    const double phase = henyey_greenstein(dot(at.along, photon.from.vector()), at.anisotropy);
    const double share = hero_only && photon.hero_only() ? 1.0 / Spectrum::kCount : 1.0;
    return (share * phase) * photon.light();
}

Spectrum PhotonDensity::radiance(const PhotonMap& map, const VolumePoint& at, bool hero_only) {
    const auto every = [](const Photon&) { return true; };
    const auto [photons, squared] = counted_photons(map, at.point, every, guess_of(map), found_);
    if (!(squared > 0.0)) return {};
    Spectrum sum;
    for (const PhotonTree::Near& near : photons) {
        sum += scattered_light(at, map.tree.photons()[near.node], hero_only);
    }
    return (3.0 / (4.0 * kPi * squared * std::sqrt(squared))) * sum;
}

}  // namespace alhazen
