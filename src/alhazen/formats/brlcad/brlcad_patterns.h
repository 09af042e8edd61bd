#pragma once
/// Images of BRL-CAD's shaders that colour a surface by its texture coordinates.
///
/// Source: Gardner, "Visual Simulation of Clouds", SIGGRAPH 1985 (cloud); BRL-CAD, manual page of
/// its shaders (checker, testmap).
/// Conventions: one image covers u and v from 0 to 1.

#include <optional>

#include "alhazen/formats/brlcad/brlcad_shader.h"
#include "alhazen/imaging/image/image.h"

namespace alhazen {

struct BrlcadPattern {
    Image image;
    double repeats = 1;   ///< number of repetitions along u and v
    bool smooth = false;  ///< interpolates between pixels
    Rgb mean;
};

/// The pattern of a shader; none if the shader is not a pattern.
[[nodiscard]] std::optional<BrlcadPattern> brlcad_pattern(const BrlcadShader& shader);

}  // namespace alhazen
