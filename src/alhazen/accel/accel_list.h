#pragma once
/// The closed list of the accelerators that visit one primitive at a time. ADD AN ACCELERATOR HERE:
/// one include, one entry. The wide BVH tests primitives in blocks and has an aggregate of its own.

#include <tuple>

#include "alhazen/accel/list.h"

namespace alhazen {

using ScalarAccelerators = std::tuple<List>;

}  // namespace alhazen
