#include "alhazen/imaging/film/filter_integral.h"

#include <algorithm>
#include <cmath>

#include "alhazen/base/error.h"
#include "alhazen/base/inline_vector.h"

namespace alhazen {

namespace {

struct RuleNode {
    double at, weight;
};
/// The Gauss-Legendre rule of eight points on [0, 1].
constexpr std::array<RuleNode, 8> kRule{{{0.019855071751231884, 0.050614268145188130},
                                         {0.101666761293186630, 0.111190517226687235},
                                         {0.237233795041835507, 0.156853322938943644},
                                         {0.408282678752175098, 0.181341891689180991},
                                         {0.591717321247824902, 0.181341891689180991},
                                         {0.762766204958164493, 0.156853322938943644},
                                         {0.898333238706813370, 0.111190517226687235},
                                         {0.980144928248768116, 0.050614268145188130}}};

}  // namespace

FilterIntegral::FilterIntegral(const FilterEntry& entry, double radius)
    : entry_(&entry),
      radius_(radius),
      reach_(static_cast<int>(std::ceil(std::max(0.0, radius - 0.5)))),
      knots_{-radius, -0.5 * radius, 0.0, 0.5 * radius, radius} {
    if (entry.integral == nullptr) {
        throw Error(ErrorKind::Usage, std::string("filter '") + entry.name +
                                          "': its integral has no closed form; exact areas support "
                                          "box, tent, gaussian, mitchell, blackman_harris");
    }
    scale_ = 0.5 / integral(radius);
}

double FilterIntegral::integral(double x) const {
    return entry_->integral(std::clamp(x, -radius_, radius_), radius_);
}

double FilterIntegral::along(const Vec2& from, const Vec2& to) const {
    const Vec2 d = to - from;
    if (d.y == 0.0 || std::max(from.x, to.x) <= -radius_) return 0.0;
    InlineVector<double, 12> ends;
    ends.push_back(0.0);
    ends.push_back(1.0);
    const auto divide = [&](double start, double step) {
        if (step == 0.0) return;
        for (const double knot : knots_) {
            const double t = (knot - start) / step;
            if (t > 0.0 && t < 1.0) ends.push_back(t);
        }
    };
    divide(from.x, d.x);
    divide(from.y, d.y);
    std::sort(ends.begin(), ends.end());
    double sum = 0.0;
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
        const double width = ends[k + 1] - ends[k];
        if (std::abs(from.y + (ends[k] + 0.5 * width) * d.y) >= radius_) continue;
        double part = 0.0;
        for (const RuleNode& node : kRule) {
            const Vec2 p = from + (ends[k] + node.at * width) * d;
            // Uses F from the left end of the kernel, so that edges at that end contribute nothing.
            part += node.weight * (integral(p.x) + 0.5 / scale_) * entry_->value(p.y, radius_);
        }
        sum += width * part;
    }
    return scale_ * scale_ * d.y * sum;
}

}  // namespace alhazen
