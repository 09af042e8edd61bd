#pragma once
/// Circular cylinders with caps as Embree user geometry in float.
/// Method: intersection of the interval of the infinite cylinder with that of the slab between the
/// caps (Kay and Kajiya, SIGGRAPH 1986); discriminant by Lagrange's identity; constants of each
/// cylinder are precomputed.
/// Conventions: both the entry and the exit are crossings; the nearest in [tnear, tfar] is
/// reported.

#include <embree3/rtcore.h>

#include <vector>

#include "alhazen/shapes/quadrics/cylinder.h"

namespace alhazen::bench {

class EmbreeCylinders {
  public:
    EmbreeCylinders() = default;
    explicit EmbreeCylinders(const std::vector<Cylinder>& cylinders);

    /// Returns an uncommitted geometry that refers to this object, which must keep its address.
    [[nodiscard]] RTCGeometry make_geometry(RTCDevice device);

    struct Entry {
        float center[3];
        float axis[3];  ///< unit
        float half_height;
        float radius;
    };

  private:
    std::vector<Entry> entries_;
};

}  // namespace alhazen::bench
