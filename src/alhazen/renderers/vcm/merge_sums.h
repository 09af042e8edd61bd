#pragma once
/// The weight of a merged path in constant time: sums over the strategies of either side, kept from
/// vertex to vertex.
///
/// Source: Georgiev, "Implementing Vertex Connection and Merging", technical report, Saarland
/// University, 2012 (weights by recurrences along both subpaths).
/// Differs: sums of squares, for the power heuristic, over the squared density up to the vertex; a
/// light that is joined has a density of its own; light straight from a lamp is not merged.
/// Conventions: the weight is that of `merged_path_weight` (bidirectional/path_weight.h), which
/// knows the whole path. Densities by area, above 0; 0 counts as 1.

namespace alhazen {

/// The strategies that need fewer vertices of a side than there are up to a vertex of it.
struct SideSums {
    double own = 1;     ///< density of the vertex, from its side
    double fixed = 0;   ///< of the strategy that joins the vertex with the one before
    double factor = 0;  ///< of all others, over the squared density of the vertex before as the
                        ///< other side finds it

    /// The first surface of a light path: the densities of the light itself. `joined`: where it is
    /// chosen for the surface; 0: never. `hit`: rays can hit it.
    [[nodiscard]] static SideSums at_light(double light, double joined, bool hit, double own) {
        const double over = 1.0 / known(light);
        return {known(own), joined * over * (joined * over), hit ? over * over : 0.0};
    }
    /// The first surface of an eye path: the lens is joined to it, and no ray hits the lens.
    [[nodiscard]] static SideSums at_lens(double own) { return {known(own), 1.0, 0.0}; }

    /// All of them. `before`: density of the vertex before as the other side finds it. `singular`:
    /// the path goes on by a singular lobe, and nothing is joined.
    [[nodiscard]] double total(double before, bool singular) const {
        return (singular ? 0.0 : fixed) + factor * known(before) * known(before);
    }
    /// Of the vertex after this one, of density `next`. `merges`: vertices are merged here.
    [[nodiscard]] SideSums after(double before, bool singular, bool merges, double merging,
                                 double next) const {
        const double merged = merges && !singular ? merging * merging : 0.0;
        return {known(next), singular ? 0.0 : 1.0, total(before, singular) / (own * own) + merged};
    }

    [[nodiscard]] static double known(double density) { return density > 0.0 ? density : 1.0; }
};

/// The weight of a path merged where both sides have a vertex. `light_before`: density of the
/// light's vertex before, as the eye's path would go on to it; `eye_before`: the reverse.
[[nodiscard]] inline double weight_of_merged(const SideSums& light, double light_before,
                                             const SideSums& eye, double eye_before,
                                             double merging) {
    const double merged = light.own * merging, across = light.own / eye.own;
    const double squared = merged * merged;
    return squared / (light.total(light_before, false) + squared +
                      across * across * eye.total(eye_before, false));
}

}  // namespace alhazen
