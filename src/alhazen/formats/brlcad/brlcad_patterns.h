#pragma once
/// Pictures of BRL-CAD's shaders that colour a surface by its texture coordinates.
///
/// Source: Gardner, "Visual Simulation of Clouds", SIGGRAPH 1985 (cloud); BRL-CAD, manual page of
/// its shaders (checker, testmap).
/// Conventions: one picture covers u and v from 0 to 1.

#include <optional>

#include "alhazen/formats/brlcad/brlcad_shader.h"
#include "alhazen/imaging/image/image.h"

namespace alhazen {

struct BrlcadPattern {
    Image image;
    double repeats = 1;   ///< of the picture along u and v
    bool smooth = false;  ///< between the pixels
    Rgb mean;
};

/// None for shaders that are no patterns.
[[nodiscard]] std::optional<BrlcadPattern> brlcad_pattern(const BrlcadShader& shader);

}  // namespace alhazen
