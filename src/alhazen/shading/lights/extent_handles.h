#pragma once
/// What can be set of a light's surface: its middle, where it faces, its sizes.
///
/// Conventions: the middle is that of LightSurface::center. The direction is the normal of what is
/// flat, from the base to the top of a tube; spheres and meshes have none. A surface turns about
/// its middle by the least rotation. What is set to what it is stays, bit for bit.

#include <optional>
#include <span>
#include <vector>

#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

struct ExtentSize {
    /// "radius", "inner radius", "width" (of edge_u), "height" (of edge_v), "length", or "scale",
    /// which is 1 for a surface as it is.
    const char* name = "";
    double value = 0;
};

struct ExtentHandles {
    Vec3 position;
    std::optional<Vec3> direction;
    std::vector<ExtentSize> sizes;
};
/// Of an extent without a fault (`fault_of`).
[[nodiscard]] ExtentHandles handles_of(const LightExtent& extent);

/// What is set of the handles; the rest is as it is. `direction` must not be 0; there are no sizes
/// or as many as there are handles.
struct ExtentChange {
    std::optional<Vec3> position, direction;
    std::span<const double> sizes;

    [[nodiscard]] bool changes_something() const { return position || direction || !sizes.empty(); }
};
/// May have a fault, which `fault_of` tells.
[[nodiscard]] LightExtent changed(const LightExtent& extent, const ExtentChange& change);

}  // namespace alhazen
