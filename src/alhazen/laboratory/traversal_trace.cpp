#include "alhazen/laboratory/traversal_trace.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "alhazen/accel/bounds/goldsmith_salmon.h"
#include "alhazen/accel/bounds/hierarchy.h"
#include "alhazen/accel/bounds/kay_kajiya.h"
#include "alhazen/accel/bounds/list.h"
#include "alhazen/accel/cells/kd_tree.h"
#include "alhazen/accel/cells/octree.h"
#include "alhazen/accel/cells/uniform_grid.h"
#include "alhazen/accel/directions/ray_classification.h"
#include "alhazen/base/error.h"
#include "alhazen/laboratory/plane_corners.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {
namespace {

using StepKind = TraversalStep::Kind;

/// Records the steps of a traversal.
struct TracingStats : NoStats {
    std::vector<TraversalStep>* steps = nullptr;
    void cell(std::size_t number) const {
        steps->push_back({StepKind::Cell, true, static_cast<std::uint32_t>(number), {}});
    }
    void bound(std::size_t node, bool met) const {
        steps->push_back({StepKind::Bound, met, static_cast<std::uint32_t>(node), {}});
    }
};

/// Queries the closest hit, as an aggregate does.
class TracingVisitor {
  public:
    TracingVisitor(const PrimitiveTable& table, const BoundedPrimitives& bounded,
                   TraversalTrace& trace)
        : table_(table),
          bounded_(bounded),
          trace_(trace),
          ray_(trace.ray),
          shear_(ray_.direction) {}

    [[nodiscard]] static AsksFor asks_for() { return AsksFor::Closest; }
    [[nodiscard]] double t_max() const { return ray_.t_max; }
    bool visit(std::uint32_t i) {
        test(PrimitiveId{bounded_.id(i)});
        return false;
    }
    void test(PrimitiveId id) {
        Hit alone;
        Ray whole = trace_.ray;
        table_.closest(id, whole, shear_, alone, NoStats{}, kAllRays);
        trace_.steps.push_back(
            {StepKind::Primitive, alone.found(), static_cast<std::uint32_t>(id), {}});
        table_.closest(id, ray_, shear_, trace_.hit, NoStats{}, kAllRays);
    }

  private:
    const PrimitiveTable& table_;
    const BoundedPrimitives& bounded_;
    TraversalTrace& trace_;
    Ray ray_;
    RayShear shear_;
};

std::vector<Vec3> corners_of(const Box3& box) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(box.corner(i));
    return corners;
}

std::vector<Vec3> shape_of(const UniformGrid& grid, const TraversalStep& step) {
    const CellGrid& cells = grid.cells();
    const auto nx = static_cast<std::uint32_t>(cells.cells[0]);
    const auto ny = static_cast<std::uint32_t>(cells.cells[1]);
    return corners_of(
        cells.cell_box({static_cast<int>(step.number % nx), static_cast<int>(step.number / nx % ny),
                        static_cast<int>(step.number / nx / ny)}));
}

std::vector<Vec3> shape_of(const Octree& octree, const TraversalStep& step) {
    const OctreeCells& cells = octree.cells();
    const OctreeCells::Node& node = cells.nodes()[step.number];
    Box3 box;
    for (int k = 0; k < 3; ++k) {
        const std::int32_t from = node.origin[static_cast<std::size_t>(k)];
        box.lo[k] = cells.plane(k, from);
        box.hi[k] = cells.plane(k, from + cells.span(node));
    }
    return corners_of(box);
}

/// Descends to the leaf: nodes are stored depth first, the lower child first.
std::vector<Vec3> shape_of(const KdTree& tree, const TraversalStep& step) {
    Box3 box = tree.box();
    std::uint32_t at = 0;
    while (at != step.number) {
        const KdTree::Node& node = tree.nodes()[at];
        const bool upper = step.number >= node.index;
        (upper ? box.lo : box.hi)[node.axis] = node.plane;
        at = upper ? node.index : at + 1;
    }
    return corners_of(box);
}

/// A sphere has no corners.
std::vector<Vec3> shape_of(const SphereBound&) {
    return {};
}
template <int K>
std::vector<Vec3> shape_of(const SlabBound<K>& bound) {
    std::vector<HalfSpaceOfPoints> sides;
    for (std::size_t k = 0; k < static_cast<std::size_t>(K); ++k) {
        const Vec3& n = SlabDirections<K>::all()[k];
        sides.push_back({n, bound.range[k].hi});
        sides.push_back({-n, -bound.range[k].lo});
    }
    return plane_corners(sides);
}

template <class Tree>
requires requires(const Tree& tree) {
    std::visit([](const auto&) {}, tree.tree());
}
std::vector<Vec3> shape_of(const Tree& accelerator, const TraversalStep& step) {
    return std::visit([&](const auto& tree) { return shape_of(tree.nodes[step.number].bound); },
                      accelerator.tree());
}
std::vector<Vec3> shape_of(const GoldsmithSalmon& accelerator, const TraversalStep& step) {
    return shape_of(accelerator.tree().nodes[step.number].bound);
}
/// All steps are tests of primitives.
std::vector<Vec3> shape_of(const List&, const TraversalStep&) {
    return {};
}

/// Sets the shape of every step.
template <class A>
void add_shapes(const A& accelerator, TraversalTrace& result) {
    for (TraversalStep& step : result.steps) {
        if (step.kind != StepKind::Primitive) step.corners = shape_of(accelerator, step);
    }
}

/// The cell is the origin region of the class; the beam is its swept region up to the end of the
/// primitives.
void add_shapes(const RayClassification& made, TraversalTrace& result) {
    for (std::size_t i = 0; i < result.steps.size(); ++i) {
        if (result.steps[i].kind != StepKind::Cell) continue;
        const Box3& box = made.classes()->space().box;
        const RaySpan span(box, result.ray, result.ray.t_max);
        const ClassifiedRay ray(result.ray, span.begin);
        Hypercube cube{{box.lo.x, box.lo.y, box.lo.z, -1, -1},
                       {box.hi.x, box.hi.y, box.hi.z, 1, 1}};
        for (std::uint32_t depth = 1; depth < result.steps[i].number; ++depth) {
            cube = cube.child(cube.child_of(ray.point));
        }
        const Box3 from{{cube.lo[0], cube.lo[1], cube.lo[2]}, {cube.hi[0], cube.hi[1], cube.hi[2]}};
        result.steps[i].corners = corners_of(from);
        const int axis = ray.direction / 2;
        Vec3 forward;
        forward[axis] = ray.direction % 2 == 0 ? 1 : -1;
        std::vector<HalfSpaceOfPoints> sides;
        const auto keep = [&](const Vec3& normal, const Box3& all) {
            sides.push_back({normal, extent(all, normal).hi});
        };
        keep(-forward, from);
        for (int k = 0; k < 3; ++k) {
            Vec3 along;
            along[k] = 1;
            keep(along, box);
            keep(-along, box);
        }
        for (int k = 1; k < 3; ++k) {
            Vec3 across;
            across[(axis + k) % 3] = 1;
            const auto slope = static_cast<std::size_t>(2 + k);
            keep(across - cube.hi[slope] * forward, from);
            keep(cube.lo[slope] * forward - across, from);
        }
        TraversalStep beam{StepKind::Beam, true, 0, plane_corners(sides)};
        result.steps.insert(result.steps.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                            std::move(beam));
        return;
    }
}

template <class A>
void trace(const Scene& scene, const AcceleratorChoice& choice, TraversalTrace& result) {
    const PrimitiveTable& table = scene.aggregate->primitives();
    const BoundedPrimitives bounded(table);
    SettingsReader reader(choice.name, choice.settings);
    const typename A::Config config = A::configure(reader);
    reader.finish();
    const A accelerator = A::build(bounded, config);
    TracingVisitor visitor(table, bounded, result);
    for (const PrimitiveId id : bounded.unbounded()) visitor.test(id);
    TracingStats stats;
    stats.steps = &result.steps;
    Ray ray = result.ray;
    accelerator.traverse(ray, visitor, stats);
    add_shapes(accelerator, result);
}

struct Traceable {
    const char* name;
    void (*trace)(const Scene&, const AcceleratorChoice&, TraversalTrace&);
};
constexpr Traceable kTraceable[] = {{List::kName, &trace<List>},
                                    {Hierarchy::kName, &trace<Hierarchy>},
                                    {GoldsmithSalmon::kName, &trace<GoldsmithSalmon>},
                                    {KayKajiya::kName, &trace<KayKajiya>},
                                    {UniformGrid::kName, &trace<UniformGrid>},
                                    {Octree::kName, &trace<Octree>},
                                    {RayClassification::kName, &trace<RayClassification>},
                                    {KdTree::kName, &trace<KdTree>}};

}  // namespace

std::string traceable_accelerators() {
    std::string names;
    for (const Traceable& entry : kTraceable) {
        names += names.empty() ? entry.name : std::string(", ") + entry.name;
    }
    return names;
}

TraversalTrace trace_traversal(const Scene& scene, const std::string& accelerator, const Ray& ray) {
    const AcceleratorChoice choice = parse_accelerator(accelerator);
    TraversalTrace result;
    result.accelerator = accelerator;
    result.ray = ray;
    for (const Traceable& entry : kTraceable) {
        if (choice.name != entry.name) continue;
        entry.trace(scene, choice, result);
        return result;
    }
    throw Error(ErrorKind::Usage, fmt::format("'{}' cannot be traced; traceable accelerators: {}",
                                              choice.name, traceable_accelerators()));
}

}  // namespace alhazen
