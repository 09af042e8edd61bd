#include "alhazen/sampling/analysis/periodogram.h"

#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

namespace alhazen {

namespace {

/// exp(-2 pi i f x) for f = 0 .. reach.
std::vector<std::complex<double>> waves(double x, int reach) {
    std::vector<std::complex<double>> w;
    for (int f = 0; f <= reach; ++f) w.push_back(std::polar(1.0, -2.0 * std::numbers::pi * f * x));
    return w;
}

}  // namespace

Periodogram::Periodogram(int reach)
    : reach_(reach),
      sums_(static_cast<std::size_t>(2 * reach + 1) * static_cast<std::size_t>(reach + 1)) {}

void Periodogram::add(std::span<const Vec2> points) {
    std::vector<std::complex<double>> sums(sums_.size());
    for (const Vec2& p : points) {
        const std::vector<std::complex<double>> x = waves(p.x, reach_), y = waves(p.y, reach_);
        std::complex<double>* sum = sums.data();
        for (int fy = -reach_; fy <= reach_; ++fy) {
            const std::complex<double> wave = y[static_cast<std::size_t>(std::abs(fy))];
            const double re = wave.real(), im = fy < 0 ? -wave.imag() : wave.imag();
            for (const std::complex<double>& w : x) {
                *sum++ += std::complex<double>(w.real() * re - w.imag() * im,
                                               w.real() * im + w.imag() * re);
            }
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        sums_[k] += std::norm(sums[k]) / static_cast<double>(points.size());
    }
    ++sets_;
}

double Periodogram::power(int fx, int fy) const {
    if (sets_ == 0 || (fx == 0 && fy == 0)) return 0.0;
    if (fx < 0) return power(-fx, -fy);
    return sums_[static_cast<std::size_t>(fy + reach_) * static_cast<std::size_t>(reach_ + 1) +
                 static_cast<std::size_t>(fx)] /
           sets_;
}

std::vector<double> Periodogram::radial_mean(std::size_t points, int bins_of_root) const {
    const double bins_of_one = bins_of_root / std::sqrt(static_cast<double>(points));
    std::vector<double> sums(static_cast<std::size_t>(reach_ * bins_of_one));
    std::vector<double> counts(sums.size());
    for (int fy = -reach_; fy <= reach_; ++fy) {
        for (int fx = -reach_; fx <= reach_; ++fx) {
            const auto bin = static_cast<std::size_t>(std::hypot(fx, fy) * bins_of_one);
            if (bin >= sums.size() || (fx == 0 && fy == 0)) continue;
            sums[bin] += power(fx, fy);
            counts[bin] += 1.0;
        }
    }
    for (std::size_t k = 0; k < sums.size(); ++k) {
        if (counts[k] > 0.0) sums[k] /= counts[k];
    }
    return sums;
}

}  // namespace alhazen
