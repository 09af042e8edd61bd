#pragma once
/// Rays by kind of a generated database, for tests of their independence of the accelerator.

#include <gtest/gtest.h>

#include <string>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/session/generators/generate.h"
#include "alhazen/session/render.h"

namespace alhazen::testing {

/// `side`: pixels per side of the square image; 0: as in the databases' protocol.
inline RayCounters spd_counters(const SceneDescription& description, const std::string& accelerator,
                                int side) {
    RenderOptions options;
    if (side == 0) {
        options.protocol = Protocol::Spd;
    } else {
        options.width = options.height = side;
    }
    const Scene scene = compile(description, {.accelerator = accelerator});
    return render(scene, description.picture, options).counters;
}

inline void expect_same_counters(const RayCounters& found, const RayCounters& expected,
                                 const std::string& what) {
    for (std::size_t i = 0; i < expected.rays.size(); ++i) {
        EXPECT_EQ(found.rays[i].cast, expected.rays[i].cast) << what << " " << kRayKindNames[i];
        EXPECT_EQ(found.rays[i].hit, expected.rays[i].hit) << what << " " << kRayKindNames[i];
    }
    EXPECT_EQ(found.total_internal, expected.total_internal) << what;
}

inline bool tests_everything(const std::string& accelerator) {
    return accelerator == "list" || accelerator == "bounding_volumes";
}

inline const std::vector<std::string>& databases() {
    static const std::vector<std::string> names{"balls",  "gears", "jacks",  "lattice",
                                                "mount",  "rings", "shells", "sombrero",
                                                "teapot", "tetra", "tree"};
    return names;
}

}  // namespace alhazen::testing
