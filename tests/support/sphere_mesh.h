#pragma once
/// A closed sphere-like mesh for watertightness tests: corners and edges are shared, bit for bit.

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen::testing {

struct SphereMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    /// An octahedron whose triangles are split in four `levels` times, oriented outward: 8 *
    /// 4^levels triangles. With `on_sphere`, corners are moved to the unit sphere; else they are
    /// multiples of 2^-levels on the octahedron.
    explicit SphereMesh(int levels, bool on_sphere = true)
        : positions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}} {
        for (std::uint32_t x : {0u, 1u}) {
            for (std::uint32_t y : {2u, 3u}) {
                for (std::uint32_t z : {4u, 5u}) {
                    const bool odd = (x + y + z) % 2 != 0;
                    triangles.push_back({x, odd ? z : y, odd ? y : z});
                }
            }
        }
        for (int level = 0; level < levels; ++level) split(on_sphere);
    }

  private:
    void split(bool on_sphere) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b));
            if (fresh) {
                const Vec3 p = 0.5 * (positions[a] + positions[b]);
                entry->second = static_cast<std::uint32_t>(positions.size());
                positions.push_back(on_sphere ? normalize(p) : p);
            }
            return entry->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.push_back({a, ab, ca});
            finer.push_back({ab, b, bc});
            finer.push_back({ca, bc, c});
            finer.push_back({ab, bc, ca});
        }
        triangles = std::move(finer);
    }
};

}  // namespace alhazen::testing
