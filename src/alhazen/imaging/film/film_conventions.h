#pragma once
/// Encoding of pictures in which the scene formats differ. An importer sets it; it is read where a
/// film is written to a file.

namespace alhazen {

struct FilmConventions {
    /// Integer pictures hold linear values truncated to 8 bits; false: sRGB.
    bool linear_output = true;
};

}  // namespace alhazen
