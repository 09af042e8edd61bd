#include "alhazen/session/shutter.h"

#include <fmt/format.h>

#include <algorithm>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/formats/importer_list.h"

namespace alhazen {

namespace {

/// Number of times at which an animated file is read, ends of the shutter included.
constexpr int kPoses = 9;

/// Converts the differences between poses of one scene to motion.
class PoseMotion {
  public:
    PoseMotion(SceneDescription& first, std::span<const SceneDescription> later,
               std::span<const double> times)
        : d_(first), later_(later), times_(times) {}

    void run() {
        for (const SceneDescription& pose : later_) {
            require(pose.objects.size() == d_.objects.size() &&
                        pose.meshes.size() == d_.meshes.size() &&
                        pose.cameras.size() == d_.cameras.size(),
                    "objects");
        }
        for (std::size_t i = 0; i < d_.objects.size(); ++i) move_parts(i);
        for (std::size_t i = 0; i < d_.meshes.size(); ++i) move_vertices(i);
        for (std::size_t i = 0; i < d_.cameras.size(); ++i) move_camera(i);
    }

  private:
    /// `what` differs between two times, unless `same`.
    void require(bool same, const std::string& what) const {
        if (same) return;
        throw Error(ErrorKind::Scene,
                    fmt::format("{}: its {} differ between times; --shutter requires a scene in "
                                "which objects move and none appear, vanish or are mirrored",
                                d_.path.string(), escape_controls(what)));
    }

    /// The parts of an object, and if one of them has changed its number among them the first.
    [[nodiscard]] std::string differing_parts(std::size_t object,
                                              const SceneDescription& pose) const {
        const std::vector<Part>& mine = d_.objects[object].parts;
        const std::vector<Part>& others = pose.objects[object].parts;
        const std::size_t common = std::min(mine.size(), others.size());
        for (std::size_t i = 0; i < std::max(mine.size(), others.size()); ++i) {
            if (i < common && mine[i].name == others[i].name) continue;
            const std::string& name = i < mine.size() ? mine[i].name : others[i].name;
            if (!name.empty()) return fmt::format("objects (first '{}')", name);
        }
        return "objects";
    }

    /// Keys with the transform `of(pose)` at each time.
    template <class Of>
    [[nodiscard]] std::vector<TransformKey> keys(Of&& of) const {
        std::vector<TransformKey> keys{{times_[0], of(d_)}};
        for (std::size_t k = 0; k < later_.size(); ++k) {
            keys.push_back({times_[k + 1], of(later_[k])});
        }
        const Affine& rest = keys[0].outer_from_inner;
        const bool moves = std::any_of(keys.begin(), keys.end(), [&](const TransformKey& key) {
            return key.outer_from_inner != rest;
        });
        return moves ? keys : std::vector<TransformKey>{};
    }

    void move_parts(std::size_t object) {
        std::vector<Part>& parts = d_.objects[object].parts;
        for (const SceneDescription& pose : later_) {
            require(pose.objects[object].parts.size() == parts.size(),
                    differing_parts(object, pose));
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            std::vector<TransformKey> path = keys([&](const SceneDescription& pose) {
                return pose.objects[object].parts[i].object_from_part;
            });
            if (path.empty()) continue;
            parts[i].motion =
                std::make_shared<const PartMotion>(PartMotion{{}, std::move(path), {}});
        }
    }

    void move_vertices(std::size_t i) {
        const TriangleMesh& mesh = *d_.meshes[i].mesh;
        bool moves = false;
        for (const SceneDescription& pose : later_) {
            const TriangleMesh& other = *pose.meshes[i].mesh;
            require(other.positions.size() == mesh.positions.size() &&
                        other.triangles == mesh.triangles,
                    fmt::format("triangles of mesh '{}'", d_.meshes[i].name));
            moves = moves || other.positions != mesh.positions || other.normals != mesh.normals;
        }
        if (!moves) return;
        std::vector<MeshKey>& keys = d_.meshes[i].keys;
        keys.push_back({times_[0], mesh.positions, mesh.normals});
        for (std::size_t k = 0; k < later_.size(); ++k) {
            const TriangleMesh& other = *later_[k].meshes[i].mesh;
            keys.push_back({times_[k + 1], other.positions, other.normals});
        }
    }

    void move_camera(std::size_t i) {
        const auto frame = [&](const SceneDescription& pose) {
            const PicturePlane p = picture_plane(pose.cameras[i].camera);
            return Affine{{p.right, p.up, p.forward}, p.eye};
        };
        const Affine first_from_world = inverse(frame(d_));
        d_.cameras[i].keys = keys([&](const SceneDescription& pose) {
            return &pose == &d_ ? Affine{} : frame(pose) * first_from_world;
        });
    }

    SceneDescription& d_;
    std::span<const SceneDescription> later_;
    std::span<const double> times_;
};

/// True if directions or positions of lights differ.
bool lights_move(const SceneDescription& a, const SceneDescription& b) {
    if (a.lights.size() != b.lights.size()) return true;
    for (std::size_t i = 0; i < a.lights.size(); ++i) {
        const auto here = [](const Light& light) {
            return place_of(light) == LightPlace::None
                       ? Vec3{}
                       : sample(ready_to_sample(light), {1e3, 2e3, 3e3}, false).to_light;
        };
        if (here(a.lights[i].light) != here(b.lights[i].light)) return true;
    }
    return false;
}

}  // namespace

void open_shutter_of(SceneDescription& description, const ImportOptions& options,
                     const Shutter& shutter, Diagnostics& diagnostics) {
    if (description.animations.empty()) {
        open_shutter(description, shutter);
    } else {
        std::vector<SceneDescription> poses;
        std::vector<double> times;
        for (int k = 0; k < kPoses; ++k) {
            const double share = static_cast<double>(k) / (kPoses - 1);
            const double time = (1.0 - share) * shutter.open + share * shutter.close;
            if (k > 0 && !(time > times.back())) break;
            times.push_back(time);
            ImportOptions then = options;
            then.time = time;
            Diagnostics repeated;
            poses.push_back(import_scene(description.path, then, repeated));
        }
        description = std::move(poses.front());
        description.shutter = shutter;
        const std::span<const SceneDescription> later = std::span(poses).subspan(1);
        PoseMotion(description, later, times).run();
        if (!later.empty() && lights_move(description, later.back())) {
            diagnostics.warning({description.path.string(), 0, 0},
                                "a light moves while the shutter is open; it is shown where it is "
                                "as the shutter opens");
        }
    }
    if (!has_motion(description)) {
        diagnostics.warning({description.path.string(), 0, 0},
                            "nothing in this scene moves while the shutter is open");
    }
}

}  // namespace alhazen
