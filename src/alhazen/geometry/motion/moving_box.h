#pragma once
/// A box that moves linearly between shutter opening and closing.
///
/// Conventions: time is 0 at shutter opening and 1 at closing.

#include "alhazen/geometry/box.h"

namespace alhazen {

struct MovingBox {
    Box3 at_open, at_close;

    [[nodiscard]] bool empty() const { return at_open.empty() || at_close.empty(); }
    [[nodiscard]] bool bounded() const { return at_open.bounded() && at_close.bounded(); }
    [[nodiscard]] Box3 at(double time) const {
        return {(1.0 - time) * at_open.lo + time * at_close.lo,
                (1.0 - time) * at_open.hi + time * at_close.hi};
    }
    /// A box that contains the moving box at every time.
    [[nodiscard]] Box3 swept() const {
        Box3 both = at_open;
        both.include(at_close);
        return both;
    }
    void include(const MovingBox& b) {
        at_open.include(b.at_open);
        at_close.include(b.at_close);
    }
    /// Enlarges both end boxes until the box at `time`, in [0, 1], contains `b`.
    void widen_to(double time, const Box3& b) {
        const Box3 here = at(time);
        const auto beyond = [](double a) { return a > 0.0 ? a : 0.0; };
        const Vec3 below{beyond(here.lo.x - b.lo.x), beyond(here.lo.y - b.lo.y),
                         beyond(here.lo.z - b.lo.z)};
        const Vec3 above{beyond(b.hi.x - here.hi.x), beyond(b.hi.y - here.hi.y),
                         beyond(b.hi.z - here.hi.z)};
        for (Box3* end : {&at_open, &at_close}) {
            end->lo -= below;
            end->hi += above;
        }
    }
};

}  // namespace alhazen
