#pragma once
/// Generations of rays (eye rays, or the secondary rays of the surfaces that another generation
/// hits) and the state kept until their radiance is known.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", 1980 (the tree of rays);
/// Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008, and Laine, Karras and Aila,
/// "Megakernels Considered Harmful: Wavefront Path Tracing on GPUs", HPG 2013 (a generation at a
/// time).
/// Differs: radiance returns from the last generation to the first, by the arithmetic and in the
/// order of the recursion, instead of throughputs being carried along. The size of a generation is
/// bounded: further rays wait until the radiance of those before is known.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_cone.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/core/ray_medium.h"

namespace alhazen {

/// The history of a ray.
struct Path : RayMedium {
    RayKind kind = RayKind::Eye;
    std::uint32_t sample = 0;   ///< of its batch of eye rays
    float time = 0;             ///< RayQuery::time
    float nm = 0;               ///< wavelength behind a dispersing surface; else 0
    Rgb contribution{1, 1, 1};  ///< product of the coefficients along the path
    RayCone cone;
};

/// Some rays of a generation, or all.
struct GenerationPart {
    std::span<const Ray> rays;
    std::span<Path> paths;
    std::span<Rgb> radiance;  ///< along each ray, once it has been traced

    [[nodiscard]] std::size_t size() const { return rays.size(); }
};

class Generation {
  public:
    void clear() {
        rays_.clear();
        paths_.clear();
    }
    /// Returns the number of the new ray.
    std::uint32_t add(const Ray& ray, const Path& path) {
        rays_.push_back(ray);
        paths_.push_back(path);
        return static_cast<std::uint32_t>(rays_.size() - 1);
    }
    [[nodiscard]] Path& last_path() { return paths_.back(); }
    [[nodiscard]] std::size_t size() const { return rays_.size(); }
    /// Allocates the radiance of the rays, black. Call after the last ray is added.
    void make_ready() { radiance_.assign(rays_.size(), Rgb{}); }
    [[nodiscard]] GenerationPart part(std::size_t first, std::size_t count) {
        return {std::span(rays_).subspan(first, count), std::span(paths_).subspan(first, count),
                std::span(radiance_).subspan(first, count)};
    }
    [[nodiscard]] const Rgb& radiance(std::uint32_t ray) const { return radiance_[ray]; }

  private:
    std::vector<Ray> rays_;
    std::vector<Path> paths_;
    std::vector<Rgb> radiance_;
};

/// A surface that a ray hit, while its secondary rays are traced.
struct MetSurface {
    static constexpr std::uint32_t kNotSent = std::numeric_limits<std::uint32_t>::max();

    std::uint32_t ray = 0;                                     ///< that hit it
    std::uint32_t reflected = kNotSent, refracted = kNotSent;  ///< rays of the next generation
    bool lit = false;                                          ///< false: its colour is `own` only
    bool filtered = false;  ///< its light is multiplied by `filter`
    bool split = false;     ///< `refracted` is the index of its first ray in Wavefront::split
    Rgb share;              ///< weight of its light in the radiance of the ray
    Rgb own;                ///< emission and ambient light
    Rgb direct;             ///< light of unoccluded lights
    Rgb kr, kt;             ///< factors of the radiance of the two rays
    Rgb filter;             ///< by distance in the medium
};

/// The state of the work on some rays of one generation.
struct Wavefront {
    std::vector<MetSurface> met;
    Generation next;                   ///< the secondary rays of `met`
    std::vector<std::uint32_t> split;  ///< rays of `next`, by wavelength, of dispersing surfaces
    std::vector<Rgb> left;             ///< [ray] transmittance so far, of surfaces and media
    /// Rays that have not ended: their numbers and, behind the first surface, their remainders.
    std::vector<std::uint32_t> active;
    std::vector<Ray> rays;
    /// The active rays that continue behind the surfaces in `met`.
    std::vector<std::uint32_t> next_active;
    std::vector<Ray> next_rays;

    void begin(std::size_t count) {
        left.assign(count, Rgb{1, 1, 1});
        active.resize(count);
        for (std::size_t i = 0; i < count; ++i) active[i] = static_cast<std::uint32_t>(i);
    }
    void begin_surfaces() {
        met.clear();
        met.reserve(active.size());  // keeps references into it valid
        next.clear();
        split.clear();
        next_active.clear();
        next_rays.clear();
    }
    void go_on() {
        active.swap(next_active);
        rays.swap(next_rays);
    }
};

}  // namespace alhazen
