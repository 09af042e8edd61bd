#pragma once
/// Irradiance at few points of matt surfaces, interpolated between them.
///
/// Source: Ward, Rubinstein and Clear, "A Ray Tracing Solution for Diffuse Interreflection",
/// SIGGRAPH 1988 (weights, distances); Christensen, "Photon Mapping Tricks", SIGGRAPH 2002 course
/// 43 (records before the picture).
/// Differs: records lie in hashed cells of the size of their reach instead of an octree; the
/// smallest reach is that of two pixels. No gradients.
/// Conventions: irradiance of the side of the normal. Answers depend on the order of `add`.
/// Threads: const functions may be called from many.

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
    double distance = 0;  ///< harmonic mean of those to the surfaces around
};

class IrradianceCache {
  public:
    /// `error`: Ward's a, above 0: a record serves as far as `error` times its distance.
    explicit IrradianceCache(double error) : error_(error) {}

    void add(const IrradianceRecord& record);
    /// None where no record is near enough.
    [[nodiscard]] std::optional<Spectrum> irradiance(const Vec3& point, const Vec3& normal) const;
    [[nodiscard]] double error() const { return error_; }
    [[nodiscard]] std::size_t size() const { return records_.size(); }

  private:
    using Cell = std::array<std::int64_t, 3>;
    /// Cells of one size, and the records that reach into them.
    struct Level {
        std::map<Cell, std::vector<std::uint32_t>> cells;
    };
    /// Error of the record at the point over its irradiance; infinite where it does not serve.
    [[nodiscard]] static double error_at(const IrradianceRecord& record, const Vec3& point,
                                         const Vec3& normal);

    double error_;
    std::vector<IrradianceRecord> records_;
    std::map<int, Level> levels_;  ///< by the binary logarithm of the side of their cells
};

}  // namespace alhazen
