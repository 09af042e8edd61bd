#pragma once
/// Irradiance at sparse points of matt surfaces, interpolated between them.
///
/// Source: Ward, Rubinstein and Clear, "A Ray Tracing Solution for Diffuse Interreflection",
/// SIGGRAPH 1988 (weights, distances); Christensen, "Photon Mapping Tricks", SIGGRAPH 2002 course
/// 43 (records before the picture).
/// Differs: records are stored in hashed cells of the size of their reach instead of an octree; the
/// smallest reach is two pixels. No gradients.
/// Conventions: irradiance on the side of the normal. Results depend on the order of `add`.
/// Threads: const functions may be called concurrently.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

struct IrradianceRecord {
    Vec3 point, normal;
    Spectrum irradiance;
    double distance = 0;  ///< harmonic mean of the distances to the surrounding surfaces
};

class IrradianceCache {
  public:
    /// `error`: Ward's a, above 0: the reach of a record is `error` times its distance.
    explicit IrradianceCache(double error) : error_(error) {}

    void add(const IrradianceRecord& record);
    /// Empty if no record is near enough.
    [[nodiscard]] std::optional<Spectrum> irradiance(const Vec3& point, const Vec3& normal) const;
    [[nodiscard]] double error() const { return error_; }
    [[nodiscard]] std::size_t size() const { return records_.size(); }

  private:
    using Cell = std::array<std::int64_t, 3>;
    /// Cells of one size, and the records that overlap them.
    struct Level {
        std::map<Cell, std::vector<std::uint32_t>> cells;
    };
    /// Relative error of the record at the point; infinite if it is not applicable.
    [[nodiscard]] static double error_at(const IrradianceRecord& record, const Vec3& point,
                                         const Vec3& normal);

    double error_;
    std::vector<IrradianceRecord> records_;
    std::map<int, Level> levels_;  ///< key: binary logarithm of the side of the cells
};

}  // namespace alhazen
