#pragma once
/// Distinguishes the two families of the SBT-raytracer format and sets the conventions of each.
///
/// Source: docs/reference/formats/ray.md. Files do not state their family; for the rule see
/// `detect_ray_family`.

#include "alhazen/formats/text/text_tree.h"
#include "alhazen/scene_model/conventions.h"

namespace alhazen {

struct RayFamily {
    /// True: the dictionary parsers (older UW, HKUST); false: the token parsers (UW from 2003, UT
    /// Austin).
    bool dictionary = false;
    /// factor from `shininess` in the file to the exponent
    double shininess_scale = 1.0;
    Conventions conventions;
};

/// Determines the family. A file belongs to the dictionary family if it contains syntax unique to
/// that family (`material { name = ...`, `gennormals = true`, `quaternion`, `focaldistance`, an
/// object or a light of its student extensions), or if its largest shininess is in (0, 2]:
/// exponents of that size give no highlight, while 0.2 and 2 of the dictionary family are exponents
/// of 25.6 and 256. The shininess is ignored in a file with syntax unique to the token parsers
/// (`gennormals;`, `name x;`, `quaternian`).
[[nodiscard]] RayFamily detect_ray_family(TextNode root);

}  // namespace alhazen
