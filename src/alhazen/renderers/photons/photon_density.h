#pragma once
/// The light that a surface scatters, from the density of the photons around a point of it.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5 (n nearest), and
/// "Realistic Image Synthesis Using Photon Mapping", 2001, section 7 (cone and gauss filter);
/// Jensen and Christensen, "Efficient Simulation of Light Transport in Scenes with Participating
/// Media using Photon Maps", SIGGRAPH 1998 (in volumes).
/// Differs: of the n nearest the farthest bounds the disc and is not counted, for n in the disc
/// that ends with the n-th are too many by n / (n - 1). All filters are divided by their mean over
/// the disc (that of Jensen's gauss filter is 0.531). Photons of surfaces that face elsewhere are
/// left out.
/// Conventions: of photons that stand for flux; at a border of the surface the disc still counts as
/// a whole.

#include <cmath>
#include <optional>
#include <vector>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/renderers/photons/photon_tree.h"

namespace alhazen {

/// How photons count by their distance.
enum class DensityFilter : std::uint8_t { Disc, Cone, Gauss };
inline constexpr const char* kDensityFilterNames[] = {"disc", "cone", "gauss"};

/// Of a photon whose squared distance is `share` of that of the border. The mean over the disc is
/// 1.
[[nodiscard]] double filter_weight(DensityFilter filter, double share);

/// Whether a photon arrived at a surface like that at hand.
class PhotonFits {
  public:
    explicit PhotonFits(const ScatterPoint& at) : PhotonFits(at.geometric(), at.transmits()) {}
    PhotonFits(const Vec3& normal, bool both_sides) : normal_(normal), both_sides_(both_sides) {}
    [[nodiscard]] bool operator()(const Photon& photon) const {
        constexpr double kLeast = 0.5;  // cosine of 60 degrees
        const Vec3 normal = photon.normal.along();
        const double facing = dot(normal, normal_);
        return (facing > 0.0 || both_sides_) &&
               facing * facing > kLeast * kLeast * length_squared(normal);
    }

  private:
    Vec3 normal_;
    bool both_sides_;
};

/// Directions that a BSDF samples with a greater density are followed from the eye: no photons are
/// looked at for them. Of a matt surface the greatest is 1 / pi.
inline constexpr double kGlossyDensity = 1.0;

/// Which of the light that a point scatters is asked for.
enum class LightPart : std::uint8_t { All, NotGlossy };

/// Radiance towards the view for the light of a photon, of unit density by area. `hero_only`: of
/// the path that looks at it; where both are, the hero counts for all wavelengths once.
[[nodiscard]] Spectrum scattered_light(const ScatterPoint& at, const Photon& photon, LightPart part,
                                       bool hero_only);

/// `scattered_light` of many photons at one point. Where all that scatters is one matt reflection,
/// each costs two cosines.
class PhotonScattering {
  public:
    /// `at` must outlive it.
    PhotonScattering(const ScatterPoint& at, LightPart part, bool hero_only);
    [[nodiscard]] Spectrum operator()(const Photon& photon) const;

  private:
    const ScatterPoint& at_;
    LightPart part_;
    bool hero_only_;
    std::optional<Spectrum> matt_;  ///< reflectance over pi
};

/// A tree of photons and how it is looked at.
struct PhotonMap {
    PhotonTree tree;
    std::size_t nearest = 1;  ///< photons at most, at least 2
    double radius = 0;        ///< at most
    DensityFilter filter = DensityFilter::Disc;
    /// [node] Irradiance at the photons of surfaces, without their own; empty: not computed.
    std::vector<Spectrum> irradiance;
};

/// Computes `irradiance` of a map, with the threads of the caller's ThreadLimit: matt surfaces then
/// interpolate between the photons around, weighed by their distance.
///
/// Source: Christensen, "Faster Photon Map Global Illumination", JGT 4(3), 1999.
/// Differs: a few photons around a point count, not the nearest alone, so that no cells show.
void compute_irradiance(PhotonMap& map);

/// Photons by area at a point with that geometric normal.
[[nodiscard]] double photons_by_area(const PhotonMap& map, const Vec3& point, const Vec3& normal);

/// A radius that finds enough photons at most places of the map: twice that within which nine of
/// ten photons have `nearest` others. 0 of an empty tree.
[[nodiscard]] double usual_radius(const PhotonTree& tree, std::size_t nearest);

/// The light that a place in a volume scatters towards where a path along `along` came from, over
/// its coefficient, for a photon of unit density by volume.
[[nodiscard]] Spectrum scattered_light(const VolumePoint& at, const Photon& photon, bool hero_only);

/// Estimates of one thread.
class PhotonDensity {
  public:
    [[nodiscard]] Spectrum radiance(const PhotonMap& map, const ScatterPoint& at, const Vec3& point,
                                    LightPart part, bool hero_only);
    /// The radiance that arrives at a place in a volume and is scattered, over the coefficient: by
    /// the photons in a ball, which all count alike.
    [[nodiscard]] Spectrum radiance(const PhotonMap& map, const VolumePoint& at, bool hero_only);

  private:
    /// From the irradiance that the map knows; none where too few photons lie around.
    [[nodiscard]] std::optional<Spectrum> known_irradiance(const PhotonMap& map,
                                                           const ScatterPoint& at,
                                                           const Vec3& point);

    /// Of the squared radius of an estimate: that of the one before in the map.
    struct Guess {
        const PhotonMap* map = nullptr;
        double squared = 0;
    };
    [[nodiscard]] double& guess_of(const PhotonMap& map);

    std::vector<PhotonTree::Near> found_;
    std::vector<Guess> guesses_;
};

}  // namespace alhazen
