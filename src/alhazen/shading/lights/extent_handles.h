#pragma once
/// The editable properties of a light's surface: centre, direction, sizes.
///
/// Conventions: the centre is LightSurface::center. The direction is the normal of a flat surface,
/// or runs from the base to the top of a tube; spheres and meshes have none. A surface turns about
/// its centre by the least rotation. Setting a property to its present value changes no bit.

#include <optional>
#include <span>
#include <vector>

#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

struct ExtentSize {
    /// "radius", "inner radius", "width" (of edge_u), "height" (of edge_v), "length", or "scale",
    /// which is 1 for the present size.
    const char* name = "";
    double value = 0;
};

struct ExtentHandles {
    Vec3 position;
    std::optional<Vec3> direction;
    std::vector<ExtentSize> sizes;
};
/// The handles of an extent without a fault (`fault_of`).
[[nodiscard]] ExtentHandles handles_of(const LightExtent& extent);

/// New values of handles; empty ones stay unchanged. `direction` must not be 0; `sizes` is empty or
/// has one entry for each handle.
struct ExtentChange {
    std::optional<Vec3> position, direction;
    std::span<const double> sizes;

    [[nodiscard]] bool changes_something() const { return position || direction || !sizes.empty(); }
};
/// The result may have a fault; see `fault_of`.
[[nodiscard]] LightExtent changed(const LightExtent& extent, const ExtentChange& change);

}  // namespace alhazen
