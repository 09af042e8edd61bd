#pragma once
/// Circular cylinders with caps as Embree user geometry in float.
///
/// Source: the intersection of an interval of the infinite cylinder with one of the slab between
/// the caps (Kay and Kajiya, SIGGRAPH 1986); the discriminant by Lagrange's identity.
/// Differs: in float, with the accepting branch only; constants of a cylinder are precomputed.
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

    /// Not committed. Refers to this object, which must keep its address.
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
