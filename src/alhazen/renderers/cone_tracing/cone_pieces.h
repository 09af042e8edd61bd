#pragma once
/// Visibility of the pieces that a cone meets: coverages combined front to back.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3 (a list of the closest
/// few objects); adding pieces that abut is his remedy against seams.
/// Differs: an object is a surface: faces and triangles that share edges, on one side. Pieces of
/// one surface lie beside each other until they cover the cone; further ones are a layer behind it,
/// which is seen as far as the layers before it let light through. Both sides of a closed solid
/// with alpha are layers of one surface. Different surfaces are treated as independent, so that the
/// remainder of the cone is the product of their remainders. The closest eight surfaces are
/// distinguished; all others share the last entry. If a layer has many pieces, only a few are
/// shaded, evenly distributed over their coverage.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "alhazen/base/inline_vector.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/renderers/cone_tracing/cone_search.h"

namespace alhazen {

/// A part of a surface in a cone.
struct SurfaceShare {
    std::uint32_t surface = 0;  ///< ConeSource::surface
    bool front = true;          ///< its side
    /// Its other side lies behind it or before it: of a closed solid with alpha.
    bool two_sided = false;
    bool within = false;  ///< the cone starts inside it
    double share = 0;     ///< of the cone
    double coverage = 1;  ///< of the part: the rest lets everything through
};

/// The whole light: 1, or white.
template <class Light>
inline constexpr Light kAllLight = 1.0;
template <>
inline constexpr Rgb kAllLight<Rgb> = {1, 1, 1};

/// Pieces of a surface that lie beside each other.
template <class Light>
struct ConeLayer {
    std::size_t number = 0;
    double covered = 0;  ///< share of the cone, whether it lets light through or not
    Light through{};     ///< what passes, summed over `covered`

    [[nodiscard]] Light mean() const {
        return covered > 0.0 ? (1.0 / covered) * through : kAllLight<Light>;
    }
};

/// A surface in a cone.
template <class Light>
struct SurfaceInCone {
    std::uint32_t surface = 0;
    bool front = true;  ///< the side of the first piece
    bool two_sided = false;
    bool within = false;
    bool first = true;                         ///< there is no full layer
    std::array<ConeLayer<Light>, 2> layers{};  ///< being filled: of the first side, of the other
    Light before = kAllLight<Light>;           ///< what passes the full layers
    double filled = 0;                         ///< opaque share of the first layer, without tints
    Light passed{};                            ///< in addition to 1 - filled
    double hidden = 0;                         ///< visible shares of all pieces
};

/// The surfaces that cover a part of a cone, and what they let through. `Light`: double, or Rgb
/// where surfaces tint.
template <class Light>
class ConeSurfaces {
  public:
    static constexpr std::size_t kMost = 8;

    /// Adds a part behind all previous ones; `tint`: transmittance of its covered points. Returns
    /// its visible share, where nothing tints. `layer` is set to the number of its layer.
    double add(const SurfaceShare& part, const Light& tint, std::size_t& layer) {
        const std::size_t number = find(part);
        double others = 1.0;
        for (std::size_t k = 0; k < list_.size(); ++k) {
            if (k != number) others *= 1.0 - list_[k].hidden;
        }
        return add_to(list_[number], part, tint, layer) * others;
    }
    /// The share of light that passes all surfaces.
    [[nodiscard]] Light left() const {
        Light left = kAll;
        for (const One& one : list_) {
            left = left * at_least_none((1.0 - one.filled) * kAll + one.passed);
        }
        return left;
    }

  private:
    using One = SurfaceInCone<Light>;
    static constexpr Light kAll = kAllLight<Light>;
    /// Smaller shares of pieces that overlap by rounding start no layer.
    static constexpr double kLeastRest = 1e-6;

    std::size_t find(const SurfaceShare& part) {
        for (std::size_t k = 0; k < list_.size(); ++k) {
            const One& one = list_[k];
            if (one.surface == part.surface && one.two_sided == part.two_sided &&
                (part.two_sided || one.front == part.front)) {
                return k;
            }
        }
        if (!list_.full()) {
            One one;
            one.surface = part.surface;
            one.front = part.front;
            one.two_sided = part.two_sided;
            one.within = part.within;
            list_.push_back(one);
        }
        return list_.size() - 1;
    }

    double add_to(One& one, const SurfaceShare& part, const Light& tint, std::size_t& number) {
        const std::size_t side = one.two_sided && part.front != one.front ? 1 : 0;
        double rest = part.share, seen = 0.0;
        for (;;) {
            ConeLayer<Light>& layer = one.layers[side];
            if (!(layer.covered > 0.0)) layer.number = layers_++;
            number = layer.number;
            const double here = std::min(rest, 1.0 - layer.covered);
            const double own = here * part.coverage;
            if (one.first && side == 0) {
                one.filled += own;
                one.passed += own * tint;
                one.hidden += own;
                seen += own;
            } else {
                const Light open = side == 0 ? one.before : one.before * past_first(one);
                one.passed += own * open * (tint - kAll);
                const double shown = std::min(own * largest(open), 1.0 - one.hidden);
                one.hidden += shown;
                seen += shown;
            }
            layer.covered += here;
            layer.through += here * ((1.0 - part.coverage) * kAll + part.coverage * tint);
            rest -= here;
            if (!(rest > kLeastRest)) return seen;
            // The layer is full: the rest lies behind it.
            one.before = one.before * one.layers[0].mean() * one.layers[1].mean();
            if (!(largest(one.before) > 0.0)) return seen;
            one.layers = {};
            one.first = false;
        }
    }
    /// What the pieces of the first side leave of the light for the other side.
    [[nodiscard]] static Light past_first(const One& one) {
        const ConeLayer<Light>& first = one.layers[0];
        // Fronts before a start inside are met by the part of an oblique disc that lies beyond them
        // only; the rest of the cone sees the backs past nothing.
        if (one.within && one.front) return (1.0 - first.covered) * kAll + first.through;
        return first.mean();
    }
    static Light at_least_none(const Light& light) {
        if constexpr (std::is_same_v<Light, double>) {
            return std::max(light, 0.0);
        } else {
            return {std::max(light.r, 0.0), std::max(light.g, 0.0), std::max(light.b, 0.0)};
        }
    }
    static double largest(const Light& light) {
        if constexpr (std::is_same_v<Light, double>) {
            return light;
        } else {
            return light.max();
        }
    }

    InlineVector<One, kMost> list_;
    std::size_t layers_ = 0;
};

/// A piece and the share of the cone in which it is visible.
struct SeenPiece {
    ConePiece piece;
    double weight = 0;
    std::size_t layer = 0;  ///< number of its layer
    SolidsAround inside;    ///< solids that contain it
};

/// Keeps at most `most` pieces of each layer, evenly distributed by weight, with the sum of the
/// weights unchanged.
inline void thin_out(std::vector<SeenPiece>& seen, std::size_t most) {
    if (seen.size() <= most) return;
    struct Sum {
        std::size_t count = 0;
        double total = 0, before = 0;
    };
    std::size_t layers = 0;
    for (const SeenPiece& s : seen) layers = std::max(layers, s.layer + 1);
    std::vector<Sum> sums(layers);
    for (const SeenPiece& s : seen) {
        ++sums[s.layer].count;
        sums[s.layer].total += s.weight;
    }
    const double steps = static_cast<double>(most);
    const auto is_left_out = [&](SeenPiece& s) {
        Sum& sum = sums[s.layer];
        if (sum.count <= most) return false;
        // Number of middles of `most` equal parts that fall into this piece.
        const double step = sum.total / steps;
        double& from = sum.before;
        const double first = std::ceil(from / step - 0.5);
        from += s.weight;
        const double end = std::min(std::ceil(from / step - 0.5), steps);
        s.weight = step * std::max(end - first, 0.0);
        return !(s.weight > 0.0);
    };
    seen.erase(std::remove_if(seen.begin(), seen.end(), is_left_out), seen.end());
}

}  // namespace alhazen
