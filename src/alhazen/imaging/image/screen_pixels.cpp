#include "alhazen/imaging/image/screen_pixels.h"

#include <algorithm>
#include <array>
#include <span>

namespace alhazen {

void write_screen_pixels(const double* rgb, std::size_t pixels, Encoding encoding,
                         std::uint8_t* bytes) {
    constexpr std::size_t kAtOnce = 4096;  // codes stay in the cache
    std::array<std::uint16_t, 3 * kAtOnce> codes;
    for (std::size_t first = 0; first < pixels; first += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, pixels - first);
        encode(rgb + 3 * first, encoding, 8, std::span(codes).first(3 * count));
        const std::uint16_t* from = codes.data();
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
