#pragma once
/// The weight of one of the strategies that may find a whole path: a number of its vertices from
/// the light, the others from the eye.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, sections 10.1
/// and 10.2 (the power heuristic with the exponent 2).
/// Differs: a light that is joined is chosen for the point that it lights, not by its power: the
/// strategy of one vertex from the light has a density of its own for it.
/// Conventions: vertex 0 is the light, 1 to m are surfaces, m + 1 is the lens. Strategy s has s
/// vertices from the light. Densities are by area; those of a light without a place by solid
/// angle. A singular vertex scatters by a singular lobe: nothing is joined to it, and its densities
/// towards its neighbours count as 1.

#include <vector>

namespace alhazen {

struct WholePath {
    struct Vertex {
        double from_light = 0, from_eye = 0;  ///< densities; 0: singular
        bool singular = false;
    };
    std::vector<Vertex> vertices;  ///< 0 .. m
    double joined = 0;    ///< density of vertex 0 where it is chosen for vertex 1; 0: never
    bool emitted = true;  ///< light paths begin there
    bool hit = true;      ///< rays can hit the light
};

/// Of strategy `s`: the weights of all strategies of a path sum to 1.
[[nodiscard]] double path_weight(const WholePath& path, int s);

}  // namespace alhazen
