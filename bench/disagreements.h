#pragma once
/// Resolves disagreements of two tracers about a ray by brute force over the whole scene in
/// extended precision (113 bits if the compiler supports them, else long double).
/// Method: edge functions are triple products without a shear; the only culling is a test in double
/// with a wide margin. A triangle whose edge function is zero, or indistinguishable from zero in
/// extended precision, is *touched*: the ray passes through an edge or a vertex, and both a hit and
/// a miss are right. Spheres and capped cylinders are tested by their intervals; one that the ray
/// grazes within the rounding of double is also touched.
/// Conventions: t is compared up to a tolerance relative to the distances involved.

#include <vector>

#include "our_tracer.h"

namespace alhazen::bench {

/// Which tracers are wrong about a ray.
struct Verdict {
    bool ours_wrong = false, peer_wrong = false;
    double true_t = 0;  ///< nearest certain crossing; infinite for none
};

class Judge {
  public:
    /// Keeps a reference to the scene.
    explicit Judge(const KernelScene& scene);

    /// `ours` and `peer` are the t that each tracer reports, infinite for a miss; with `any_hit`
    /// any finite number means a hit. O(size of the scene).
    [[nodiscard]] Verdict decide(const Ray& ray, bool any_hit, double ours, double peer) const;
    /// True if two answers differ by more than the rounding of float.
    [[nodiscard]] bool disagree(const Ray& ray, bool any_hit, double ours, double peer) const;
    /// Error bound of a float answer near t.
    [[nodiscard]] double float_noise(const Ray& ray, double t) const;

  private:
    /// The unit of tolerances: the distances involved up to t, in units of t.
    [[nodiscard]] double noise_unit(const Ray& ray, double t) const;

    const KernelScene& scene_;
    double reach_;  ///< largest distance of the scene from the origin
};

}  // namespace alhazen::bench
