#pragma once
/// Eye rays distributed over the lens and the shutter time.

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/renderers/light_transport/path_randomness.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/volumes/media_finder.h"

namespace alhazen {

class CameraRays {
  public:
    explicit CameraRays(const RenderJob& job)
        : lens_(job.camera),
          follows_volumes_(ScatteringMedia(job.scene).are_followed()),
          motion_(job.camera_motion),
          moves_(job.scene.has_motion || job.camera_motion != nullptr),
          finder_(job.scene),
          parallel_(std::holds_alternative<OrthographicCamera>(job.camera)) {
        if (motion_ != nullptr) camera_from_world_ = motion_->at(0.0).inner_from_outer;
        const PicturePlane plane = picture_plane(job.camera);
        up_ = plane.up;
        mirrored_ = dot(cross(plane.right, plane.up), plane.forward) > 0.0;
        if (!parallel_) media_ = around(picture_plane(job.camera).eye, 0.0f);
    }

    /// ScatteringMedia::are_followed.
    [[nodiscard]] bool follows_volumes() const { return follows_volumes_; }
    /// The volumes around the origin of an eye ray that eye rays see: those of the eye when the
    /// shutter opens; for parallel cameras those of each ray.
    [[nodiscard]] MediumStack media(const Ray& ray, float time) const {
        return parallel_ ? around(ray.origin, time) : media_;
    }

    /// The time of a sample.
    [[nodiscard]] float time(const PathRandomness& random, const SampleId& id) const {
        return moves_ ? random.time(id) : 0.0f;
    }
    /// The up direction of the picture at a time.
    [[nodiscard]] Vec3 up(float time) const {
        if (motion_ == nullptr) return up_;
        return (motion_->at(time).outer_from_inner * camera_from_world_).vector(up_);
    }
    /// True if left and right are exchanged in the picture.
    [[nodiscard]] bool is_mirrored() const { return mirrored_; }
    /// The ray of a sample; `ray`: that through the centre of the lens.
    [[nodiscard]] Ray through_lens(const PathRandomness& random, const SampleId& id, const Ray& ray,
                                   float time) const {
        Ray drawn = lens_.open() ? lens_.through(ray, random.draw(id, PathRandomness::kLens)) : ray;
        if (motion_ == nullptr) return drawn;
        drawn = transformed(motion_->at(time).outer_from_inner * camera_from_world_, drawn);
        drawn.direction = normalize(drawn.direction);
        return drawn;
    }

  private:
    /// The volumes around a point that eye rays see.
    [[nodiscard]] MediumStack around(const Vec3& point, float time) const {
        MediumStack media = finder_.around(point, time);
        media.keep_seen_by(mask_of(RayKind::Eye));
        return media;
    }

    LensRays lens_;
    bool follows_volumes_;
    const TransformMotion* motion_;
    bool moves_;
    MediaFinder finder_;
    bool parallel_;
    bool mirrored_ = false;
    Vec3 up_;
    MediumStack media_;
    Affine camera_from_world_;  ///< when the shutter opens
};

}  // namespace alhazen
