#pragma once
/// The weight of one of the strategies that may find a whole path: a number of its vertices from
/// the light, the others from the eye, joined or merged.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, sections 10.1
/// and 10.2 (the power heuristic with the exponent 2); Georgiev, Krivanek, Davidovic and Slusallek,
/// "Light Transport Simulation with Vertex Connection and Merging", SIGGRAPH Asia 2012, section 4
/// (the density of a merged path).
/// Differs: a light that is joined is chosen for the point that it lights, not by its power: the
/// strategy of one vertex from the light has a density of its own for it.
/// Conventions: vertex 0 is the light, 1 to m scatter, m + 1 is the lens. Strategy s has s
/// vertices from the light. Densities are by area, in volumes by volume; those of a light without a
/// place by solid angle. A singular vertex scatters by a singular lobe: nothing is joined to it.
/// Merged at vertex k is a path whose vertices 0 .. k come from the light and k .. m + 1 from the
/// eye, k in 2 .. m: light that comes straight from a lamp is left to the other strategies. A
/// density of 0 counts as 1, for it occurs in all strategies.

#include <vector>

namespace alhazen {

struct WholePath {
    struct Vertex {
        double from_light = 0, from_eye = 0;  ///< densities; 0: singular
        bool singular = false;
        bool in_volume = false;  ///< nothing is merged there
    };
    std::vector<Vertex> vertices;  ///< 0 .. m
    double joined = 0;    ///< density of vertex 0 where it is chosen for vertex 1; 0: never
    bool emitted = true;  ///< light paths begin there
    bool hit = true;      ///< rays can hit the light
    /// Number of light paths times the area within which vertices are merged; 0: none are.
    double merging = 0.0;
};

/// Of strategy `s`: the weights of all strategies of a path sum to 1.
[[nodiscard]] double path_weight(const WholePath& path, int s);
/// Of the path merged at vertex `k`, which is not singular.
[[nodiscard]] double merged_path_weight(const WholePath& path, int k);

}  // namespace alhazen
