#include "alhazen/session/photon_file.h"

#include <fmt/format.h>

#include <bit>

namespace alhazen {

std::string photon_ply(const PhotonCloud& cloud) {
    std::string text = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment photons of alhazen\nelement vertex {}\n",
        cloud.photons.size());
    for (const char* name : {"x", "y", "z"}) text += fmt::format("property double {}\n", name);
    for (const char* name : {"dx", "dy", "dz", "power_r", "power_g", "power_b"}) {
        text += fmt::format("property float {}\n", name);
    }
    text += "property uchar caustic\nend_header\n";
    text.reserve(text.size() + 49 * cloud.photons.size());
    const auto put = [&](std::uint64_t bits, int count) {
        for (int shift = 0; shift < count; shift += 8) {
            text += static_cast<char>(static_cast<unsigned char>(bits >> shift));
        }
    };
    for (const CloudPhoton& photon : cloud.photons) {
        for (const double x : photon.position) put(std::bit_cast<std::uint64_t>(x), 64);
        for (const float x : photon.direction) put(std::bit_cast<std::uint32_t>(x), 32);
        for (const float x : photon.power) put(std::bit_cast<std::uint32_t>(x), 32);
        text += static_cast<char>(photon.caustic);
    }
    return text;
}

}  // namespace alhazen
