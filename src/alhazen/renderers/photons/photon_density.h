#pragma once
/// Radiance scattered by a surface or a volume, by density estimation of photons.
///
/// Source: Jensen, "Global Illumination using Photon Maps", EGWR 1996, section 5 (n nearest), and
/// "Realistic Image Synthesis Using Photon Mapping", 2001, section 7 (cone and gauss filter);
/// Jensen and Christensen, "Efficient Simulation of Light Transport in Scenes with Participating
/// Media using Photon Maps", SIGGRAPH 1998 (in volumes).
/// Differs: the farthest of the n nearest photons determines the disc and is not counted, since n
/// in the disc up to the n-th overestimates by n / (n - 1). All filters are divided by their mean
/// over the disc (that of Jensen's gauss filter is 0.531). Photons of surfaces of a different
/// orientation are excluded.
/// Conventions: photons stand for flux; at a border of the surface the disc still has its full
/// area.

#include <cmath>
#include <optional>
#include <vector>

#include "alhazen/base/progress.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/renderers/photons/photon_tree.h"

namespace alhazen {

/// Weight of photons by distance.
enum class DensityFilter : std::uint8_t { Disc, Cone, Gauss };
inline constexpr const char* kDensityFilterNames[] = {"disc", "cone", "gauss"};

/// Weight of a photon whose squared distance is the fraction `share` of that of the border. The
/// mean over the disc is 1.
[[nodiscard]] double filter_weight(DensityFilter filter, double share);

/// Tests whether a photon arrived at a surface like the given one.
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

/// Density above which sampled directions of a BSDF are glossy and traced from the eye instead of
/// looked up. The largest density of a matt surface is 1 / pi.
inline constexpr double kGlossyDensity = 1.0;

/// The part of the scattered light to be estimated.
enum class LightPart : std::uint8_t { All, NotGlossy };

/// Radiance towards the view for the light of a photon, per unit of density by area. `hero_only`:
/// of the eye path; if the photon has the hero only as well, its factor of four counts once.
[[nodiscard]] Spectrum scattered_light(const ScatterPoint& at, const Photon& photon, LightPart part,
                                       bool hero_only);

/// `scattered_light` of many photons at one point. For a single matt reflection the cost per photon
/// is two cosines.
class PhotonScattering {
  public:
    /// `at` must outlive the object.
    PhotonScattering(const ScatterPoint& at, LightPart part, bool hero_only);
    [[nodiscard]] Spectrum operator()(const Photon& photon) const;

  private:
    const ScatterPoint& at_;
    LightPart part_;
    bool hero_only_;
    std::optional<Spectrum> matt_;  ///< reflectance over pi
};

/// A tree of photons, and the parameters of its lookup.
struct PhotonMap {
    PhotonTree tree;
    std::size_t nearest = 1;  ///< largest number of photons, at least 2
    double radius = 0;        ///< largest radius
    DensityFilter filter = DensityFilter::Disc;
    /// [node] irradiance at the photons of surfaces, excluding the photon; empty: not computed.
    std::vector<Spectrum> irradiance;
};

/// Computes `irradiance` of a map, with the threads of the caller's ThreadLimit: matt surfaces then
/// interpolate between the surrounding photons by distance. Ends early, with irradiance missing,
/// after a stop; `stop` may be null.
///
/// Source: Christensen, "Faster Photon Map Global Illumination", JGT 4(3), 1999.
/// Differs: interpolates between a few photons instead of the nearest one, which avoids visible
/// cells.
void compute_irradiance(PhotonMap& map, const StopFlag* stop);

/// Photons per area at a point with that geometric normal.
[[nodiscard]] double photons_by_area(const PhotonMap& map, const Vec3& point, const Vec3& normal);

/// A radius that finds enough photons at most places of the map: twice the radius within which 90 %
/// of the photons have `nearest` others. 0 for an empty tree.
[[nodiscard]] double usual_radius(const PhotonTree& tree, std::size_t nearest);

/// In-scattered radiance at a point in a volume, against the path direction `along`, over the
/// scattering coefficient, for a photon of unit density by volume.
[[nodiscard]] Spectrum scattered_light(const VolumePoint& at, const Photon& photon, bool hero_only);

/// Estimates of one thread; caches.
class PhotonDensity {
  public:
    [[nodiscard]] Spectrum radiance(const PhotonMap& map, const ScatterPoint& at, const Vec3& point,
                                    LightPart part, bool hero_only);
    /// In-scattered radiance at a point in a volume over the scattering coefficient: by the photons
    /// in a ball, equally weighted.
    [[nodiscard]] Spectrum radiance(const PhotonMap& map, const VolumePoint& at, bool hero_only);

  private:
    /// Interpolates the map's irradiance; empty if there are too few photons around.
    [[nodiscard]] std::optional<Spectrum> known_irradiance(const PhotonMap& map,
                                                           const ScatterPoint& at,
                                                           const Vec3& point);

    /// Guesses of the squared radius: that of the previous estimate in the map.
    struct Guess {
        const PhotonMap* map = nullptr;
        double squared = 0;
    };
    [[nodiscard]] double& guess_of(const PhotonMap& map);

    std::vector<PhotonTree::Near> found_;
    std::vector<Guess> guesses_;
};

}  // namespace alhazen
