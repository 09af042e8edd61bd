#include "alhazen/scene/aggregate.h"

namespace alhazen {

bool hit_less(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    // Outermost ids first: paths are stored innermost first, followed outward.
    std::size_t i = a.path.size();
    std::size_t j = b.path.size();
    while (i > 0 && j > 0) {
        --i;
        --j;
        if (a.path[i] != b.path[j]) return a.path[i] < b.path[j];
    }
    // One path ended: its next id is the primitive itself.
    const PrimitiveId pa = i > 0 ? a.path[i - 1] : a.primitive;
    const PrimitiveId pb = j > 0 ? b.path[j - 1] : b.primitive;
    // Crossings of one primitive at one t stay in the order in which the primitive reports them.
    return pa < pb;
}

}  // namespace alhazen
