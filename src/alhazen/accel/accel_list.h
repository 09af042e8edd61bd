#pragma once
/// The list of the accelerators that visit one primitive at a time. ADD AN ACCELERATOR HERE: one
/// include, one entry. The wide BVH tests primitives in blocks and has its own aggregate.

#include <tuple>

#include "alhazen/accel/bounds/bounding_volumes.h"
#include "alhazen/accel/bounds/goldsmith_salmon.h"
#include "alhazen/accel/bounds/hierarchy.h"
#include "alhazen/accel/bounds/kay_kajiya.h"
#include "alhazen/accel/bounds/list.h"
#include "alhazen/accel/cells/bsp.h"
#include "alhazen/accel/cells/kd_tree.h"
#include "alhazen/accel/cells/nested_grid.h"
#include "alhazen/accel/cells/octree.h"
#include "alhazen/accel/cells/uniform_grid.h"
#include "alhazen/accel/directions/light_buffer.h"
#include "alhazen/accel/directions/ray_classification.h"
#include "alhazen/accel/directions/ray_coherence.h"

namespace alhazen {

// Each list is compiled in its own file (aggregates/accelerators_of_*.cpp).

/// Bounds around primitives.
using BoundAccelerators = std::tuple<List, BoundingVolumes, Hierarchy, KayKajiya, GoldsmithSalmon>;
/// Subdivisions of space.
using CellAccelerators = std::tuple<UniformGrid, NestedGrid, Octree, KdTree, Bsp>;
/// Subdivisions of directions.
using DirectionAccelerators = std::tuple<RayClassification, LightBuffer, RayCoherence>;

}  // namespace alhazen
