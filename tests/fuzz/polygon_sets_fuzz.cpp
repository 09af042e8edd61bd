// Loops of any points: mending, all operations, triangles, partitions; the areas have to add up.
// Input: one byte for the size of the window, then 4 bytes a point; the first of the top bits ends
// a loop, the second changes the operand.

#include <cstdint>
#include <cstdlib>
#include <vector>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/geometry/polygon_sets/mending.h"
#include "alhazen/geometry/polygon_sets/partition.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "alhazen/geometry/polygon_sets/weiler_atherton.h"

namespace {

void require(bool holds) {
    if (!holds) {
        std::abort();
    }
}

bool overlap(const alhazen::PolygonSet& a, const alhazen::PolygonSet& b) {
    using namespace alhazen;
    for (const SubEdge& e : exact_arrangement(a, b).sub_edges) {
        if (e.below == (kInFirst | kInSecond) || e.above == (kInFirst | kInSecond)) {
            return true;
        }
    }
    return false;
}

// Pieces that are rounded one after the other, made to fit.
void check_partition(const alhazen::PolygonSet& a, const alhazen::PolygonSet& b) {
    using namespace alhazen;
    LatticeBox box = a.bounds();
    box.extend(b.bounds().lo);
    box.extend(b.bounds().hi);
    if (a.empty() || b.empty()) {
        return;
    }
    const PolygonSet window = lattice_rectangle(box.lo, box.hi);
    const PolygonCut first = cut(window, a);
    const PolygonCut second = cut(first.outside, b);
    std::vector<PolygonSet> parts{first.inside, second.inside, second.outside};
    make_partition(window, parts);
    Int128 sum = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        sum += twice_area(parts[i]);
        for (std::size_t k = 0; k < i; ++k) {
            require(!overlap(parts[i], parts[k]));
        }
    }
    require(sum == twice_area(window));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace alhazen;
    if (size < 1 || size > 2048) {
        return 0;
    }
    const int shift = data[0] % 11;  // windows of 2^14 down to 2^3, or stretched to 2^24
    std::vector<LatticeLoop> operands[2];
    LatticeLoop loop;
    int owner = 0;
    for (std::size_t i = 1; i + 4 <= size; i += 4) {
        const auto coordinate = [&](std::size_t k) {
            const int v = ((data[k] << 8 | data[k + 1]) & 0x3fff) - 0x2000;
            return shift == 10 ? v * 2048 : v >> shift;
        };
        loop.push_back({coordinate(i), coordinate(i + 2)});
        if ((data[i] & 0x80) != 0) {
            operands[owner].push_back(loop);
            loop.clear();
        }
        if ((data[i] & 0x40) != 0) {
            owner = 1 - owner;
        }
    }
    operands[owner].push_back(loop);
    Mending mending;
    const PolygonSet a = polygon_set(operands[0], &mending);
    const PolygonSet b = polygon_set(operands[1]);
    require(polygon_set(operands[0]) == a);
    const PolygonCut parts = cut(a, b);
    const PolygonSet all = union_of(a, b);
    require(twice_area(all) ==
            twice_area(parts.inside) + twice_area(parts.outside) + twice_area(difference(b, a)));
    require(intersection(parts.inside, parts.outside).empty());
    require(union_of(all, all) == all);
    Int128 sum = 0;
    for (const LatticeTriangle& t : triangulate(all)) {
        require(turn(t[0], t[1], t[2]) > 0);
        sum += turn(t[0], t[1], t[2]);
    }
    require(sum == twice_area(all));
    std::size_t loops = 0;
    for (const OuterLoop& piece : loops_with_holes(all)) {
        loops += 1 + piece.holes.size();
    }
    require(loops == all.loop_count());
    check_partition(a, b);
    if (const auto walked = weiler_atherton(a, b)) {
        require(walked->inside == parts.inside && walked->outside == parts.outside &&
                walked->merged == all);
    }
    return 0;
}
