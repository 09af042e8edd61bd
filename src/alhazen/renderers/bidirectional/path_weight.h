#pragma once
/// Multiple importance sampling weights of the strategies for a whole path: some vertices from the
/// light, the others from the eye, connected or merged.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, sections 10.1
/// and 10.2 (the power heuristic with the exponent 2); Georgiev, Krivanek, Davidovic and Slusallek,
/// "Light Transport Simulation with Vertex Connection and Merging", SIGGRAPH Asia 2012, section 4
/// (the density of a merged path).
/// Differs: a light connected to a vertex is sampled for that vertex, not by its power: the
/// strategy of one vertex from the light has its own density for it.
/// Conventions: vertex 0 is the light, 1 to m scatter, m + 1 is the lens. Strategy s has s vertices
/// from the light. Densities are by area, in volumes by volume; those of infinitely distant lights
/// by solid angle. A singular vertex scatters by a singular lobe and cannot be connected. In a path
/// merged at vertex k, k in 2 .. m, vertices 0 .. k come from the light and k .. m + 1 from the
/// eye: direct light is left to the other strategies. A density of 0 counts as 1, since it occurs
/// in all strategies.

#include <vector>

namespace alhazen {

struct WholePath {
    struct Vertex {
        double from_light = 0, from_eye = 0;  ///< densities; 0: singular
        bool singular = false;
        bool in_volume = false;  ///< cannot be merged
    };
    std::vector<Vertex> vertices;  ///< 0 .. m
    double joined = 0;             ///< density of vertex 0 if sampled for vertex 1; 0: never
    bool emitted = true;           ///< light paths can start there
    bool hit = true;               ///< rays can hit the light
    /// Number of light paths times the area within which vertices are merged; 0: no merging.
    double merging = 0.0;
};

/// Weight of strategy `s`; the weights of all strategies of a path sum to 1.
[[nodiscard]] double path_weight(const WholePath& path, int s);
/// Weight of the path merged at vertex `k`, which must not be singular: for tests of the sums that
/// renderers use (vcm/merge_sums.h).
[[nodiscard]] double merged_path_weight(const WholePath& path, int k);

}  // namespace alhazen
