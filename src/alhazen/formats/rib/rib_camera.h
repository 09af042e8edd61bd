#pragma once
/// The camera options of a RIB file.
///
/// Source: Pixar, "The RenderMan Interface", version 3.2, 2000, section 4.1.
/// Conventions: without ScreenWindow the shorter side of the picture spans -1 to 1, for a
/// perspective camera at the distance 1 / tan(fov / 2).

#include <array>
#include <optional>

#include "alhazen/formats/rib/rib_requests.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

class RibCamera {
  public:
    /// Reads Format, FrameAspectRatio, ScreenWindow or Projection. False for other requests; true
    /// with a message in `problem` if the arguments are wrong.
    bool read(const RibRequest& request, std::string& problem);

    /// Adds the camera and the size of the picture, if the file defines them.
    void add(const Affine& camera_from_world, const FileLocation& where,
             SceneDescription& scene) const;

  private:
    [[nodiscard]] double aspect() const;

    std::optional<std::array<double, 3>> format_;
    std::optional<double> frame_aspect_;
    std::optional<std::array<double, 4>> window_;  ///< left, right, bottom, top
    bool projected_ = false, perspective_ = false;
    double fov_ = 90.0;  ///< degrees
};

}  // namespace alhazen
