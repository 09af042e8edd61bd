#pragma once
/// Cameras: a closed variant of plain structs.
///
/// ADD A CAMERA HERE: a struct, and an entry in `Camera`. The compiler then names the other places:
///   - cameras/eye_rays.h: EyeRays (its rays);
///   - cameras/camera.cpp: eye_cone, picture_plane, with_aspect;
///   - formats/native/read/native_view.cpp: blocks_of (names and readers of its blocks);
///   - formats/native/write/native_write_view.cpp: block_of;
///   - session/framing.cpp: headlight; session/info.cpp: camera_json;
///   - tests/support/same_description.h: same;
///   - tests/unit/formats/native/native_writer_test.cpp: one in the round trip.
///
/// Conventions: film coordinates x, y in [0, 1], x to the right, y up; (0, 0) is the lower left
/// corner of the picture. Directions are normalised: eye rays start with unit directions.

#include <string>
#include <variant>

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_cone.h"

namespace alhazen {

/// A thin lens in the plane through the eye that is parallel to the picture (eye_rays.h, LensRays).
/// Renderers that do not distribute rays see through its centre.
struct Lens {
    double radius = 0;          ///< 0: a pinhole
    double focus_distance = 1;  ///< from the eye to what is sharp, along the normal of the picture
    int blades = 0;             ///< sides of the aperture, a regular polygon; 0: a disc
    double turn = 0;            ///< of its first corner from `right`, radians, anticlockwise
};

/// ray = eye + look + (x - 1/2) right + (y - 1/2) up. The three vectors need be neither orthogonal
/// nor unit: the sheared cameras of the old formats are given as they are.
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

/// How a WideCamera shows what lies `angle` away from its axis: at a distance from the middle that
/// grows with the angle (Equidistant) or with the sine of half of it, so that pixels see equal
/// solid angles (Equisolid); or all by longitude and latitude (Panorama).
enum class WideProjection { Equidistant, Equisolid, Panorama };

/// An eye that may see all around: fisheyes and panoramas (wide_view.h). Of the vectors only the
/// directions count; `up` is taken perpendicular to `look`, and `right` says on which side of them
/// right is.
struct WideCamera {
    Vec3 eye{0, 0, 0};
    Vec3 look{0, 0, -1};
    Vec3 right{1, 0, 0};
    Vec3 up{0, 1, 0};
    WideProjection projection = WideProjection::Equidistant;
    /// Angles that the sides of the picture stand for, in radians: across the middle of a fisheye
    /// (whose corners see more), in longitude and latitude of a panorama, whose width is at most a
    /// full turn.
    double width = 3.1415926535897932;
    double height = 3.1415926535897932;

    /// Half a turn of a panorama, a full one of a fisheye.
    [[nodiscard]] static double most_height(WideProjection projection);
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, WideCamera>;

[[nodiscard]] Ray eye_ray(const Camera& camera, double x, double y);

/// The cone of an eye ray of one of `samples_per_pixel` samples of a pixel, in an image of
/// `frame_height` pixels.
[[nodiscard]] RayCone eye_cone(const Camera& camera, int frame_height, int samples_per_pixel);

/// The frame of a camera: `eye` is the centre of projection, or the centre of the rectangle from
/// which parallel rays start; `forward` the direction of view, not normalised; `right` and `up` the
/// sides of the picture. Of a wide camera the frame of a flat one that looks the same way, whose
/// sides see its angles, but at most 90 degrees.
struct PicturePlane {
    Vec3 eye, forward, right, up;
};
[[nodiscard]] PicturePlane picture_plane(const Camera& camera);

/// An orthonormal perspective camera. `fov_y` is the full vertical angle in radians, in (0, pi);
/// `up` need not be perpendicular to `look`.
[[nodiscard]] PerspectiveCamera look_along(const Vec3& eye, const Vec3& look, const Vec3& up,
                                           double fov_y, double aspect);
/// The orthographic counterpart; `height` is the picture's height in scene units.
[[nodiscard]] OrthographicCamera look_along_parallel(const Vec3& origin, const Vec3& look,
                                                     const Vec3& up, double height, double aspect);

/// The wide counterpart; `fov_y` is the angle of the picture's height, `aspect` that of its width
/// over it.
[[nodiscard]] WideCamera look_around(const Vec3& eye, const Vec3& look, const Vec3& up,
                                     WideProjection projection, double fov_y, double aspect);

/// The camera moved by a transform.
[[nodiscard]] Camera transformed(const Affine& to_from, const Camera& camera);

/// The camera widened or narrowed from the aspect ratio (width / height) it was described for to
/// another; the vertical extent is kept. A panorama does not see more than once around.
[[nodiscard]] Camera with_aspect(const Camera& camera, double described_aspect, double aspect);

}  // namespace alhazen
