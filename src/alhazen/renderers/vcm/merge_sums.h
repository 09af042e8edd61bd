#pragma once
/// The weight of a merged path in constant time, by sums over the strategies of either side that
/// are updated from vertex to vertex.
///
/// Source: Georgiev, "Implementing Vertex Connection and Merging", technical report, Saarland
/// University, 2012 (weights by recurrences along both subpaths).
/// Differs: sums of squares, for the power heuristic, relative to the squared density up to the
/// vertex; a light sampled for a vertex has its own density; direct light is not merged.
/// Conventions: the weight is that of `merged_path_weight` (bidirectional/path_weight.h), which
/// requires the whole path. Densities are by area, above 0; 0 counts as 1.

namespace alhazen {

/// The strategies with fewer vertices on a side than there are up to a given vertex of it.
struct SideSums {
    double own = 1;     ///< density of the vertex, from its side
    double fixed = 0;   ///< sum for the strategy that connects the vertex to the previous one
    double factor = 0;  ///< for all others, over the squared density of the vertex before as the
                        ///< other side finds it

    /// For the first surface of a light path, from the densities of the light. `joined`: density of
    /// the light if sampled for the surface; 0: never. `hit`: rays can hit it.
    [[nodiscard]] static SideSums at_light(double light, double joined, bool hit, double own) {
        const double over = 1.0 / known(light);
        return {known(own), joined * over * (joined * over), hit ? over * over : 0.0};
    }
    /// For the first surface of an eye path: the lens is connected to it, and no ray hits the lens.
    [[nodiscard]] static SideSums at_lens(double own) { return {known(own), 1.0, 0.0}; }

    /// Sum of all strategies. `before`: density of the previous vertex from the other side.
    /// `singular`: the path continues by a singular lobe, and nothing is connected.
    [[nodiscard]] double total(double before, bool singular) const {
        return (singular ? 0.0 : fixed) + factor * known(before) * known(before);
    }
    /// For the next vertex, of density `next`. `merges`: vertices are merged here.
    [[nodiscard]] SideSums after(double before, bool singular, bool merges, double merging,
                                 double next) const {
        const double merged = merges && !singular ? merging * merging : 0.0;
        return {known(next), singular ? 0.0 : 1.0, total(before, singular) / (own * own) + merged};
    }

    [[nodiscard]] static double known(double density) { return density > 0.0 ? density : 1.0; }
};

/// The weight of a path merged at a vertex of both sides. `light_before`: density of the light
/// path's previous vertex if the eye path continued to it; `eye_before`: the reverse.
[[nodiscard]] inline double weight_of_merged(const SideSums& light, double light_before,
                                             const SideSums& eye, double eye_before,
                                             double merging) {
    const double merged = light.own * merging, across = light.own / eye.own;
    const double squared = merged * merged;
    return squared / (light.total(light_before, false) + squared +
                      across * across * eye.total(eye_before, false));
}

}  // namespace alhazen
