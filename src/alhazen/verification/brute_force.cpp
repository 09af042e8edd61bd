#include "alhazen/verification/brute_force.h"

#include <algorithm>
#include <cmath>

#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

/// Number of primitives in a block, which has one box.
constexpr std::size_t kBlock = BoxList::kGroup;
/// Number of blocks that all rays of a batch are tested with before the next ones, to stay in the
/// cache.
constexpr std::size_t kBlocksAtOnce = BoxList::kGroup;
constexpr std::size_t kRaysAtOnce = 256;

}  // namespace

/// The primitives of one aggregate.
struct BruteForce::Group {
    const Aggregate* aggregate = nullptr;
    const PrimitiveTable* table = nullptr;  ///< null: one solid
    std::vector<std::uint32_t> plain;       ///< ids tested with every ray
    std::vector<std::uint32_t> boxed;       ///< the other ids, ascending
    BoxList boxes, blocks;                  ///< [boxed], [block of them]
    Vec3 center;
    double scale = 0;  ///< half of the largest side of all boxes; 0: none can be used
    Box3 box;          ///< of everything; all of space if `plain` is not empty
    std::vector<const Group*> inner;  ///< [instance] null for solids
};

BruteForce::BruteForce(const Aggregate& aggregate) : root_(group_of(aggregate)) {}
BruteForce::~BruteForce() = default;

const BruteForce::Group* BruteForce::group_of(const Aggregate& aggregate) {
    std::unique_ptr<Group>& known = groups_[&aggregate];
    if (known != nullptr) return known.get();
    known = std::make_unique<Group>();
    Group& group = *known;
    group.aggregate = &aggregate;
    if (dynamic_cast<const SolidAggregate*>(&aggregate) != nullptr) {
        group.box = kAllSpace;
        return &group;
    }
    group.table = &aggregate.primitives();
    for (const Instance& instance : group.table->instances) {
        const bool solid = dynamic_cast<const SolidAggregate*>(instance.aggregate.get()) != nullptr;
        // Nesting is bounded: compile refuses more than kMaxInstanceDepth.
        group.inner.push_back(solid ? nullptr : group_of(*instance.aggregate));
    }
    add_boxes(group);
    return &group;
}

void BruteForce::add_boxes(Group& group) {
    const PrimitiveTable& table = *group.table;
    const std::uint32_t first_triangle = table.first(kTriangleKind);
    const std::uint32_t first_instance = table.first(kInstanceKind);
    const auto solids = std::count(group.inner.begin(), group.inner.end(), nullptr);
    const bool believes = first_triangle + static_cast<std::size_t>(solids) > kMostPlain;
    std::vector<Box3> boxes;
    const auto sort_in = [&](std::uint32_t id, const Box3& box) {
        if (!box.bounded() || box.empty()) {
            group.plain.push_back(id);
            return;
        }
        group.boxed.push_back(id);
        boxes.push_back(box);
        group.box.include(box);
    };
    for (std::uint32_t id = 0; id < first_triangle; ++id) {
        sort_in(id, believes ? table.box(id) : kAllSpace);
        believed_boxes_ += believes;
    }
    boxes.reserve(first_instance);
    group.boxed.reserve(first_instance);
    for (std::uint32_t id = first_triangle; id < first_instance; ++id) {
        Box3 box;
        for (const Vec3& corner : table.triangle_vertices(id - first_triangle)) box.include(corner);
        sort_in(id, box);
    }
    for (std::uint32_t id = first_instance; id < table.size(); ++id) {
        const Instance& instance = table.instances[id - first_instance];
        const Group* inner = group.inner[id - first_instance];
        Box3 box = inner != nullptr ? inner->box : believes ? instance.aggregate->box() : kAllSpace;
        believed_boxes_ += believes && inner == nullptr;
        if (box.empty()) continue;
        if (box.bounded()) box = transformed(instance.placement.outer_from_inner, box);
        sort_in(id, box);
    }
    group.center = group.box.center();
    group.scale = 0.5 * max_component(group.box.size());
    if (!group.plain.empty()) group.box = kAllSpace;
    if (!(group.scale > 0) || !std::isfinite(group.scale) || !std::isfinite(1 / group.scale)) {
        group.scale = 0;
    }
    // Boxes of blocks are in the units of the lanes.
    const double to_unit = group.scale > 0 ? 1 / group.scale : 0;
    group.boxes.reserve(boxes.size());
    for (std::size_t begin = 0; begin < boxes.size(); begin += kBlock) {
        Box3 block;
        for (std::size_t i = begin; i < std::min(begin + kBlock, boxes.size()); ++i) {
            const Box3 box{to_unit * (boxes[i].lo - group.center),
                           to_unit * (boxes[i].hi - group.center)};
            group.boxes.add(box);
            block.include(box);
        }
        group.blocks.add(block);
    }
    group.boxes.fill();
    group.blocks.fill();
}

/// Rays in the frame of one group.
class BruteForce::Batch {
  public:
    Batch(const Group& group, std::span<const Shot> shots) : group_(group), shots_(shots) {}

    void trace() {
        if (group_.table == nullptr) {
            for (const Shot& shot : shots_) {
                group_.aggregate->all_hits(shot.ray, *shot.hits, {nullptr, shot.mask});
            }
            return;
        }
        for (const Shot& shot : shots_) {
            shears_.emplace_back(shot.ray.direction);
            lines_.push_back(line_of(shot.ray));
        }
        for (std::uint32_t i = 0; i < shots_.size(); ++i) {
            for (const std::uint32_t id : group_.plain) test(id, i);
        }
        const std::size_t blocks = group_.blocks.center[0].size();
        for (std::size_t begin = 0; begin < blocks; begin += kBlocksAtOnce) {
            for (std::uint32_t i = 0; i < shots_.size(); ++i) test_blocks(begin, i);
        }
        trace_instances();
    }

  private:
    enum class Meets { Nothing, SomeBoxes, Unknown };
    struct Line {
        BoxLine line;
        Meets meets;
    };

    [[nodiscard]] Line line_of(const Ray& ray) const {
        if (!is_valid(ray)) return {{}, Meets::Nothing};
        if (!(group_.scale > 0)) return {{}, Meets::Unknown};
        const Vec3 d = ray.direction / max_component(abs(ray.direction));
        // In units of the lanes.
        const Vec3 origin = (ray.origin - group_.center) / group_.scale;
        constexpr double kFarthest = 0x1p28;
        if (!is_finite(d) || !(max_component(abs(origin)) < kFarthest)) {
            return {{}, Meets::Unknown};
        }
        const Vec3 point = origin - dot(origin, d) / dot(d, d) * d;
        // All boxes are within a sphere of radius sqrt(3).
        if (dot(point, point) > 3.001) return {{}, Meets::Nothing};
        Line line{{}, Meets::SomeBoxes};
        const int axis = dominant_axis(d);
        line.line.axis = static_cast<std::size_t>(axis);
        for (int k = 0; k < 2; ++k) {
            const int other = (axis + 1 + k) % 3;
            const double slope = d[other] / d[axis];
            line.line.slope[static_cast<std::size_t>(k)] = static_cast<float>(slope);
            line.line.start[static_cast<std::size_t>(k)] =
                static_cast<float>(point[other] - slope * point[axis]);
        }
        return line;
    }

    void test_blocks(std::size_t begin, std::uint32_t shot) {
        const Line& line = lines_[shot];
        if (line.meets == Meets::Nothing) return;
        if (line.meets == Meets::Unknown) {
            const std::size_t end = std::min((begin + kBlocksAtOnce) * kBlock, group_.boxed.size());
            for (std::size_t i = begin * kBlock; i < end; ++i) test(group_.boxed[i], shot);
            return;
        }
        std::uint32_t met_blocks[kBlocksAtOnce], met[kBlock];
        const std::size_t blocks =
            met_boxes(group_.blocks, line.line, begin, begin + kBlocksAtOnce, met_blocks);
        for (std::size_t b = 0; b < blocks; ++b) {
            const std::size_t first = met_blocks[b] * kBlock;
            const std::size_t count =
                met_boxes(group_.boxes, line.line, first, first + kBlock, met);
            for (std::size_t i = 0; i < count; ++i) test(group_.boxed[met[i]], shot);
        }
    }

    void test(std::uint32_t id, std::uint32_t shot) {
        const Shot& s = shots_[shot];
        const PrimitiveTable& table = *group_.table;
        if (!is_valid(s.ray)) return;
        const std::uint32_t first_instance = table.first(kInstanceKind);
        if (id >= first_instance && group_.inner[id - first_instance] != nullptr) {
            if (table.is_seen(PrimitiveId{id}, s.mask)) {
                placed_.push_back({id - first_instance, shot});
            }
            return;
        }
        table.all_hits(PrimitiveId{id}, s.ray, shears_[shot], *s.hits, NoStats{}, s.mask);
    }

    /// Traces the rays of each instance together.
    void trace_instances() {
        std::stable_sort(placed_.begin(), placed_.end(),
                         [](const Placed& a, const Placed& b) { return a.instance < b.instance; });
        std::vector<Shot> inner;
        std::vector<std::size_t> before;
        for (std::size_t begin = 0, end; begin < placed_.size(); begin = end) {
            const std::uint32_t number = placed_[begin].instance;
            const Instance& instance = group_.table->instances[number];
            inner.clear();
            before.clear();
            for (end = begin; end < placed_.size() && placed_[end].instance == number; ++end) {
                const Shot& shot = shots_[placed_[end].shot];
                inner.push_back({inner_ray(instance, shot.ray), shot.mask, shot.hits});
                before.push_back(shot.hits->size());
            }
            Batch(*group_.inner[number], inner).trace();
            const PrimitiveId id{group_.table->first(kInstanceKind) + number};
            for (std::size_t i = 0; i < inner.size(); ++i) {
                std::vector<Hit>& hits = *inner[i].hits;
                for (std::size_t k = before[i]; k < hits.size(); ++k) hits[k].path.push_back(id);
            }
        }
    }

    struct Placed {
        std::uint32_t instance, shot;
    };

    const Group& group_;
    std::span<const Shot> shots_;
    std::vector<RayShear> shears_;
    std::vector<Line> lines_;
    std::vector<Placed> placed_;
};

void BruteForce::all_hits(std::span<const Shot> shots) const {
    parallel_for(shots.size(), kRaysAtOnce, [&](std::size_t begin, std::size_t end) {
        std::vector<std::size_t> before;
        for (std::size_t i = begin; i < end; ++i) before.push_back(shots[i].hits->size());
        Batch(*root_, shots.subspan(begin, end - begin)).trace();
        for (std::size_t i = begin; i < end; ++i) sort_appended(*shots[i].hits, before[i - begin]);
    });
}

bool BruteForce::shadowed(const Ray& ray, RayMask mask, std::span<const Hit> all,
                          std::vector<Hit>& crossings) const {
    if (root_->table == nullptr) {
        return root_->aggregate->shadowed(ray, crossings, {nullptr, mask});
    }
    const std::size_t before = crossings.size();
    if (shadowed_in(*root_, ray, mask, all, 0, crossings)) return true;
    sort_appended(crossings, before);
    return false;
}

/// `all`: hits within the group, which is `level` instances deep.
bool BruteForce::shadowed_in(const Group& group, const Ray& ray, RayMask mask,
                             std::span<const Hit> all, std::size_t level,
                             std::vector<Hit>& crossings) {
    const PrimitiveTable& table = *group.table;
    const auto id_of = [&](const Hit& hit) {
        return hit.path.size() > level ? hit.path[hit.path.size() - 1 - level] : hit.primitive;
    };
    std::vector<PrimitiveId> ids;
    for (const Hit& hit : all) ids.push_back(id_of(hit));
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const RayShear shear(ray.direction);
    std::vector<Hit> own;
    for (const PrimitiveId id : ids) {
        const std::uint32_t first_instance = table.first(kInstanceKind);
        const std::uint32_t number = static_cast<std::uint32_t>(id) - first_instance;
        if (static_cast<std::uint32_t>(id) < first_instance || group.inner[number] == nullptr) {
            if (table.shadowed(id, ray, shear, crossings, NoStats{}, mask)) return true;
            continue;
        }
        own.clear();
        std::copy_if(all.begin(), all.end(), std::back_inserter(own),
                     [&](const Hit& hit) { return id_of(hit) == id; });
        const std::size_t before = crossings.size();
        if (shadowed_in(*group.inner[number], inner_ray(table.instances[number], ray), mask, own,
                        level + 1, crossings)) {
            return true;
        }
        for (std::size_t i = before; i < crossings.size(); ++i) crossings[i].path.push_back(id);
    }
    return false;
}

}  // namespace alhazen
