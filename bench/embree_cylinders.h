#pragma once
/// Circular cylinders with caps as Embree user geometry: what a user of Embree writes in float.
///
/// Source: the meeting of an interval of the infinite cylinder with one of the slab between the
/// caps (Kay and Kajiya, SIGGRAPH 1986); the discriminant by Lagrange's identity.
/// Differs: in float and without branches but the accepting one; constants of a cylinder are
/// computed once.
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

    /// Not committed. Refers to this object, which must stay where it is.
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
