#pragma once
/// Conventions of pixel sampling in which the scene formats differ. Importers set them, samplers
/// read them.

namespace alhazen {

struct SamplingConventions {
    /// Position of the ray in its pixel when there is one sample per pixel.
    enum class PixelSample {
        Center,
        LowerLeftCorner,  ///< x = i / width, y = j / height with j counted from the bottom row
        FrameCorners,  ///< x = i / (width - 1): the outermost rays go through the frame's corners
    };
    PixelSample pixel_sample = PixelSample::Center;
};

}  // namespace alhazen
