#pragma once
/// Parts that some kinds of rays see.

#include "support/scene_maker.h"

namespace alhazen::testing {

/// The last part of the object is visible to these rays only.
inline void show_last_to(SceneMaker& maker, RayMask mask, ObjectIndex object = ObjectIndex{0}) {
    maker.description().objects[static_cast<std::size_t>(object)].parts.back().visible_to = mask;
}

}  // namespace alhazen::testing
