#pragma once
/// Cameras: a closed variant of plain structs.
///
/// ADD A CAMERA HERE: a struct, and an entry in `Camera`. The compiler then names the places that
/// visit every alternative:
///   - cameras/eye_rays.h: EyeRays (its rays);
///   - cameras/camera.cpp: picture_plane, with_aspect; cameras/pixel_cones.cpp: central_cone;
///   - renderers/lane_carpenter/screen_view.cpp: ScreenView;
///   - formats/native/read/native_cameras.cpp (names and readers of its blocks);
///   - formats/native/write/native_write_view.cpp: block_of;
///   - session/framing/framing.cpp: headlight; session/scene_info/info.cpp: camera_json;
///   - tests/support/same_description.h: same;
///   - tests/unit/formats/native/native_writer_test.cpp: one in the round trip.
/// It does not name the places that ask for one alternative (std::get_if, std::holds_alternative):
/// cameras/camera.cpp and pixel_cones.cpp; scene_model/validate.cpp; explain/explanation.cpp;
/// session/render.cpp; renderers/light_transport/camera_rays.h and camera_lens.cpp,
/// renderers/core/aov_geometry.h, renderers/antialias/picture_grid.h,
/// renderers/beam_tracing/beam_tree.cpp; formats/brlcad/brlcad_lights.cpp;
/// apps/viewer/view_menus.cpp.
///
/// Conventions: film coordinates x, y in [0, 1], x to the right, y up; (0, 0) is the lower left
/// corner of the picture. Directions are normalised: eye rays start with unit directions.

#include <string>
#include <variant>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_cone.h"

namespace alhazen {

/// A thin lens in the plane through the eye that is parallel to the picture (eye_rays.h, LensRays).
/// Renderers that do not distribute rays use its centre only.
struct Lens {
    double radius = 0;          ///< 0: a pinhole
    double focus_distance = 1;  ///< from the eye to the plane in focus, along the normal
    int blades = 0;             ///< sides of the aperture, a regular polygon; 0: a disc
    double turn = 0;            ///< of its first corner from `right`: radians, anticlockwise
};

/// ray = eye + look + (x - 1/2) right + (y - 1/2) up. The three vectors need be neither orthogonal
/// nor unit: the sheared cameras of the old formats are kept as they are.
struct PerspectiveCamera {
    Vec3 eye{0, 0, 0};
    Vec3 look{0, 0, -1};
    Vec3 right{1, 0, 0};
    Vec3 up{0, 1, 0};
    Lens lens{};
};

/// ray = origin + (x - 1/2) right + (y - 1/2) up, along `direction`.
struct OrthographicCamera {
    Vec3 origin{0, 0, 0};
    Vec3 direction{0, 0, -1};
    Vec3 right{1, 0, 0};
    Vec3 up{0, 1, 0};
};

/// The projection of a WideCamera. In a fisheye the distance from the middle grows with the angle
/// from the axis (Equidistant) or with the sine of half of it, so that pixels cover equal solid
/// angles (Equisolid). A Panorama maps longitude and latitude.
enum class WideProjection { Equidistant, Equisolid, Panorama };

/// A camera whose view may exceed a half-space: fisheyes and panoramas (wide_view.h). Only the
/// directions of the vectors count; `up` is made perpendicular to `look`, and `right` selects the
/// right side of the two.
struct WideCamera {
    Vec3 eye{0, 0, 0};
    Vec3 look{0, 0, -1};
    Vec3 right{1, 0, 0};
    Vec3 up{0, 1, 0};
    WideProjection projection = WideProjection::Equidistant;
    /// Angles that the sides of the picture span, in radians: across the middle of a fisheye (whose
    /// corners lie farther from the axis); in longitude and latitude of a panorama, whose width is
    /// at most a full turn.
    double width = 3.1415926535897932;
    double height = 3.1415926535897932;

    /// The largest height in radians: half a turn of a panorama, a full turn of a fisheye.
    [[nodiscard]] static double most_height(WideProjection projection);
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, WideCamera>;

[[nodiscard]] Ray eye_ray(const Camera& camera, double x, double y);

/// The cone of an eye ray for one of `samples_per_pixel` samples of a pixel, in an image of
/// `frame_height` pixels.
[[nodiscard]] RayCone eye_cone(const Camera& camera, int frame_height, int samples_per_pixel);

/// The frame of a camera: `eye` is the centre of projection, or the centre of the rectangle from
/// which parallel rays start; `forward` the direction of view, not normalised; `right` and `up` the
/// sides of the picture. For a wide camera, the frame of a perspective camera with the same
/// direction of view, whose sides span its angles, limited to 90 degrees.
struct PicturePlane {
    Vec3 eye, forward, right, up;
};
[[nodiscard]] PicturePlane picture_plane(const Camera& camera);

/// An orthonormal perspective camera. `fov_y` is the full vertical angle in radians, in (0, pi);
/// `up` need not be perpendicular to `look`.
[[nodiscard]] PerspectiveCamera look_along(const Vec3& eye, const Vec3& look, const Vec3& up,
                                           double fov_y, double aspect);
/// An orthonormal orthographic camera; `height` is the picture's height in scene units.
[[nodiscard]] OrthographicCamera look_along_parallel(const Vec3& origin, const Vec3& look,
                                                     const Vec3& up, double height, double aspect);

/// An orthonormal wide camera; `fov_y` is the angle of the picture's height, `aspect` the ratio of
/// the angles of width and height.
[[nodiscard]] WideCamera look_around(const Vec3& eye, const Vec3& look, const Vec3& up,
                                     WideProjection projection, double fov_y, double aspect);

/// The camera transformed from one space to another.
[[nodiscard]] Camera transformed(const Affine& to_from, const Camera& camera);

/// The camera with its picture widened or narrowed from the aspect ratio (width / height) that it
/// was described for to another; the vertical extent is kept. The width of a panorama stays at most
/// a full turn.
[[nodiscard]] Camera with_aspect(const Camera& camera, double described_aspect, double aspect);

}  // namespace alhazen
