#pragma once
/// Encoding of pictures in which the scene formats differ. An importer sets it; it is read where a
/// film is written to a file.

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

struct FilmConventions {
    /// Integer pictures hold linear values; false: sRGB.
    bool linear_output = true;
    /// Linear values are rounded to the nearest code; false: truncated.
    bool round_output = false;

    [[nodiscard]] Encoding encoding() const {
        if (!linear_output) return Encoding::Srgb;
        return round_output ? Encoding::LinearRounded : Encoding::LinearTruncated;
    }
};

}  // namespace alhazen
