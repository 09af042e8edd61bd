#include "alhazen/session/photon_file.h"

#include <fmt/format.h>

#include <bit>

namespace alhazen {

std::string photon_ply(const PhotonCloud& cloud) {
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment photons of alhazen\nelement vertex {}\n",
        cloud.photons.size());
    for (const char* name : {"x", "y", "z", "dx", "dy", "dz", "power_r", "power_g", "power_b"}) {
        text += fmt::format("property float {}\n", name);
    }
    text += "property uchar caustic\nend_header\n";
    text.reserve(text.size() + 37 * cloud.photons.size());
    const auto put = [&](const std::array<float, 3>& values) {
        for (const float value : values) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            for (int shift = 0; shift < 32; shift += 8) {
                text += static_cast<char>(static_cast<unsigned char>(bits >> shift));
            }
        }
    };
    for (const CloudPhoton& photon : cloud.photons) {
        put(photon.position);
        put(photon.direction);
        put(photon.power);
        text += static_cast<char>(photon.caustic);
    }
    return text;
}

}  // namespace alhazen
