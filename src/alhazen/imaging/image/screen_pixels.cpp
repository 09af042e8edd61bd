#include "alhazen/imaging/image/screen_pixels.h"

#include <algorithm>

namespace alhazen {

void write_screen_pixels(const double* rgb, std::size_t pixels, Encoding encoding,
                         std::uint8_t* bytes) {
    constexpr std::size_t kAtOnce = 4096;  // codes stay in the cache
    for (std::size_t first = 0; first < pixels; first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, pixels - first);
        const EncodedImage codes = encode(rgb + 3 * first, static_cast<int>(count), 1, encoding, 8);
        const std::uint16_t* from = codes.samples.data();
        std::uint8_t* to = bytes + 4 * first;
        for (std::size_t i = 0; i < count; ++i, from += 3, to += 4) {
            to[0] = static_cast<std::uint8_t>(from[0]);
            to[1] = static_cast<std::uint8_t>(from[1]);
            to[2] = static_cast<std::uint8_t>(from[2]);
            to[3] = 255;
        }
    }
}

}  // namespace alhazen
