#pragma once
/// The closed list of the accelerators that visit one primitive at a time. ADD AN ACCELERATOR HERE:
/// one include, one entry. The wide BVH tests primitives in blocks and has an aggregate of its own.

#include <tuple>

#include "alhazen/accel/bounding_volumes.h"
#include "alhazen/accel/bsp.h"
#include "alhazen/accel/goldsmith_salmon.h"
#include "alhazen/accel/hierarchy.h"
#include "alhazen/accel/kay_kajiya.h"
#include "alhazen/accel/kd_tree.h"
#include "alhazen/accel/light_buffer.h"
#include "alhazen/accel/list.h"
#include "alhazen/accel/nested_grid.h"
#include "alhazen/accel/octree.h"
#include "alhazen/accel/ray_classification.h"
#include "alhazen/accel/ray_coherence.h"
#include "alhazen/accel/uniform_grid.h"

namespace alhazen {

// Each list is compiled in a file of its own (scene/accelerators_of_*.cpp).

/// Bounds around primitives.
using BoundAccelerators = std::tuple<List, BoundingVolumes, Hierarchy, KayKajiya, GoldsmithSalmon>;
/// Space, divided.
using CellAccelerators = std::tuple<UniformGrid, NestedGrid, Octree, KdTree, Bsp>;
/// Directions, divided.
using DirectionAccelerators = std::tuple<RayClassification, LightBuffer, RayCoherence>;

}  // namespace alhazen
