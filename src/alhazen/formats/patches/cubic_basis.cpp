#include "alhazen/formats/patches/cubic_basis.h"

namespace alhazen {

CubicBasis::CubicBasis() {
    for (std::size_t k = 0; k < 4; ++k) factors_[5 * k] = 1.0;
}

CubicBasis::CubicBasis(const std::array<double, 16>& m) : divisor_(3.0) {
    // Bezier points of a t^3 + b t^2 + c t + d: d, d + c/3, d + 2c/3 + b/3, a + b + c + d.
    for (std::size_t k = 0; k < 4; ++k) {
        const double a = m[k], b = m[4 + k], c = m[8 + k], d = m[12 + k];
        factors_[k] = 3 * d;
        factors_[4 + k] = 3 * d + c;
        factors_[8 + k] = 3 * d + 2 * c + b;
        factors_[12 + k] = 3 * (a + b + c + d);
    }
}

std::optional<CubicBasis> CubicBasis::named(std::string_view name) {
    CubicBasis basis;
    if (name == "bezier") return basis;
    if (name == "b-spline") {
        basis.factors_ = {1, 4, 1, 0, 0, 4, 2, 0, 0, 2, 4, 0, 0, 1, 4, 1};
        basis.divisor_ = 6;
    } else if (name == "catmull-rom" || name == "cardinal") {
        basis.factors_ = {0, 6, 0, 0, -1, 6, 1, 0, 0, 1, 6, -1, 0, 0, 6, 0};
        basis.divisor_ = 6;
    } else if (name == "hermite") {
        basis.factors_ = {3, 0, 0, 0, 3, 1, 0, 0, 0, 0, 3, -1, 0, 0, 3, 0};
        basis.divisor_ = 3;
    } else if (name == "power") {
        basis.factors_ = {0, 0, 0, 3, 0, 0, 1, 3, 0, 1, 2, 3, 3, 3, 3, 3};
        basis.divisor_ = 3;
    } else {
        return std::nullopt;
    }
    return basis;
}

std::array<HomogeneousPoint, 4> CubicBasis::bezier(
    const std::array<HomogeneousPoint, 4>& points) const {
    std::array<HomogeneousPoint, 4> out;
    for (std::size_t i = 0; i < 4; ++i) {
        HomogeneousPoint sum{0, 0, 0, 0};
        int used = 0;
        std::size_t last = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double factor = factors_[4 * i + k];
            if (factor == 0.0) continue;
            sum = sum + factor * points[k];
            last = k;
            ++used;
        }
        // A Bezier point that equals a control point keeps its bits.
        out[i] = used == 1 && factors_[4 * i + last] == divisor_
                     ? points[last]
                     : HomogeneousPoint{sum.x / divisor_, sum.y / divisor_, sum.z / divisor_,
                                        sum.w / divisor_};
    }
    return out;
}

BezierNet bezier_of(const CubicBasis& u, const CubicBasis& v,
                    const std::array<HomogeneousPoint, 16>& points) {
    BezierNet net;
    std::array<HomogeneousPoint, 16> columns;
    for (std::size_t j = 0; j < 4; ++j) {
        const auto curve = u.bezier({points[j], points[4 + j], points[8 + j], points[12 + j]});
        for (std::size_t i = 0; i < 4; ++i) columns[4 * i + j] = curve[i];
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const auto curve =
            v.bezier({columns[4 * i], columns[4 * i + 1], columns[4 * i + 2], columns[4 * i + 3]});
        for (std::size_t j = 0; j < 4; ++j) net.points[4 * i + j] = curve[j];
    }
    return net;
}

}  // namespace alhazen
