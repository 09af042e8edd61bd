#pragma once
/// Encodings of pictures in which the scene formats differ. Importers set it; writers of film files
/// read it.

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

struct FilmConventions {
    /// True: integer pictures hold linear values; false: sRGB.
    bool linear_output = true;
    /// True: linear values are rounded to the nearest code; false: truncated.
    bool round_output = false;

    [[nodiscard]] Encoding encoding() const {
        if (!linear_output) return Encoding::Srgb;
        return round_output ? Encoding::LinearRounded : Encoding::LinearTruncated;
    }
};

}  // namespace alhazen
