#pragma once
/// Tells the two families of the SBT-raytracer format apart and sets the conventions of each.
///
/// Source: docs/reference/formats/ray.md.
/// Differs: neither program says which family a file is for; see `detect_ray_family` for the rule.

#include "alhazen/formats/text/text_tree.h"
#include "alhazen/shading/shading_conventions.h"

namespace alhazen {

struct RayFamily {
    /// The dictionary parsers (older UW, HKUST); else the token parsers (UW from 2003, UT Austin).
    bool dictionary = false;
    /// `shininess = 0.2` means an exponent of 0.2 * this.
    double shininess_scale = 1.0;
    ShadingConventions conventions;
};

/// A file is of the dictionary family when it spells something only that family knows (`material {
/// name = ...`, `gennormals = true`, `quaternion`, `focaldistance`, an object or a light that its
/// students added), or when the largest shininess it writes is in (0, 2]: exponents of that size
/// make no highlight, 0.2 and 2 of the one family are 25.6 and 256 in the other. Sizes decide
/// nothing in a file that spells what only the token parsers know (`gennormals;`, `name x;`,
/// `quaternian`).
[[nodiscard]] RayFamily detect_ray_family(TextNode root);

}  // namespace alhazen
