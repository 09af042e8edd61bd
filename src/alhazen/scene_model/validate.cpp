#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/imaging/image/image.h"
#include "alhazen/scene_model/read_pictures.h"
#include "alhazen/scene_model/scene_description.h"
#include "alhazen/scene_model/validate_materials.h"
#include "alhazen/scene_model/validate_solids.h"

namespace alhazen {

namespace {

/// Depth limit of recursion over objects.
constexpr int kMaxSolidNesting = 500;

bool finite(const Rgb& c) {
    return c.is_finite();
}

class Validator {
  public:
    Validator(const SceneDescription& description, Diagnostics& diagnostics)
        : d_(description), out_(diagnostics) {}

    void run() {
        check_cameras();
        check_lights();
        check_environment();
        validate_materials(d_, out_);
        for (const MeshDescription& mesh : d_.meshes) check_mesh(mesh);
        for (const ObjectDescription& object : d_.objects) {
            for (const Part& part : object.parts) check_part(part);
        }
        check_accelerators();
        check_nesting();
        validate_solids(d_, out_);
        check_picture();
        if (out_.error_count() == 0) check_coordinates();
    }

  private:
    void error(const FileLocation& where, std::string message) {
        out_.error(where.file.empty() ? file() : where, std::move(message));
    }
    void warning(const FileLocation& where, std::string message) {
        out_.warning(where.file.empty() ? file() : where, std::move(message));
    }
    [[nodiscard]] FileLocation file() const { return {d_.path.string(), 0, 0}; }

    void check_cameras() {
        for (const CameraDescription& camera : d_.cameras) {
            const PicturePlane plane = picture_plane(camera.camera);
            // The picture plane must not degenerate to a line.
            const bool ok = is_finite(plane.right) && is_finite(plane.up) && is_finite(plane.eye) &&
                            is_finite(plane.forward) && plane.forward != Vec3{} &&
                            length_squared(cross(plane.right, plane.up)) > 0.0;
            check_lens(camera);
            check_angles(camera);
            check_keys(camera.keys, camera.location);
            if (!ok || !(camera.aspect > 0.0) || !std::isfinite(camera.aspect)) {
                error(camera.location,
                      "the camera's vectors must be finite, its view direction not zero and its "
                      "right and up vectors not parallel");
            }
        }
    }

    void check_angles(const CameraDescription& camera) {
        const auto* wide = std::get_if<WideCamera>(&camera.camera);
        if (wide == nullptr) return;
        constexpr double kRounding = 1.0 + 1e-12;
        const double most = kRounding * WideCamera::most_height(wide->projection);
        const bool panorama = wide->projection == WideProjection::Panorama;
        const bool ok = wide->height > 0.0 && wide->height <= most && wide->width > 0.0 &&
                        std::isfinite(wide->width) &&
                        (!panorama || wide->width <= kRounding * 6.2831853071795865);
        if (!ok) {
            error(camera.location,
                  panorama ? "a panorama's height must be above 0 and at most 180 degrees, its "
                             "width above 0 and at most 360"
                           : "a fisheye's angle must be above 0 and at most 360 degrees");
        }
    }

    void check_lens(const CameraDescription& camera) {
        const auto* perspective = std::get_if<PerspectiveCamera>(&camera.camera);
        if (perspective == nullptr) return;
        const Lens& lens = perspective->lens;
        const bool ok = lens.radius >= 0.0 && std::isfinite(lens.radius) &&
                        lens.focus_distance > 0.0 && std::isfinite(lens.focus_distance) &&
                        std::isfinite(lens.turn) && lens.blades != 1 && lens.blades != 2 &&
                        lens.blades >= 0 && lens.blades <= 1000;
        if (!ok) {
            error(camera.location,
                  "the camera's lens must have a radius that is not negative, a focus distance "
                  "above 0 and no blades or 3 to 1000");
        }
    }

    void check_lights() {
        for (const LightDescription& light : d_.lights) {
            const auto need = [&](bool ok, const char* message) {
                if (!ok) error(light.location, message);
            };
            const auto ambient = [&](const Rgb& c) {
                need(finite(c), "the light's ambient colour must be finite");
            };
            const auto color = [&](const Rgb& c) {
                need(finite(c), "the light's colour must be finite");
            };
            const auto direction = [&](const Vec3& v) {
                need(is_finite(v) && v != Vec3{},
                     "the light's direction must be finite and not zero");
            };
            const auto falloff = [&](const auto& l) {
                need(is_finite(l.position), "the light's position must be finite");
                const Attenuation& a = l.attenuation;
                need(a.constant >= 0 && a.linear >= 0 && a.quadratic >= 0 &&
                         std::isfinite(a.constant + a.linear + a.quadratic),
                     "the light's attenuation coefficients must be finite and not negative");
                need(l.range > 0, "the light's range must be positive");
            };
            std::visit(
                Overloaded{
                    [&](const AmbientLight& l) { ambient(l.ambient); },
                    [&](const DirectionalLight& l) {
                        ambient(l.ambient);
                        color(l.color);
                        direction(l.to_light);
                    },
                    [&](const PointLight& l) {
                        ambient(l.ambient);
                        color(l.color);
                        falloff(l);
                    },
                    [&](const SpotLight& l) {
                        ambient(l.ambient);
                        color(l.color);
                        falloff(l);
                        direction(l.direction);
                        need(l.inner_angle >= 0 && l.inner_angle <= l.outer_angle &&
                                 l.outer_angle <= 3.1415926535897936,
                             "the light's angles must satisfy 0 <= inner <= outer <= 180 degrees");
                    },
                    [&](const AreaLight& l) {
                        ambient(l.ambient);
                        color(l.radiance);
                        const char* fault = fault_of(l.extent);
                        need(fault == nullptr, fault);
                    }},
                light.light);
        }
    }

    void check_environment() {
        if (!d_.environment) return;
        const EnvironmentSettings& e = d_.environment->settings;
        const auto need = [&](bool ok, const char* message) {
            if (!ok) error(d_.environment->location, message);
        };
        const auto bright = [](const Rgb& c) {
            return c.is_finite() && c.r >= 0 && c.g >= 0 && c.b >= 0;
        };
        const auto direction = [](const std::optional<Vec3>& v) {
            return !v || (is_finite(*v) && *v != Vec3{});
        };
        need(bright(e.color) && std::isfinite(e.scale) && e.scale >= 0,
             "the environment's color and scale must be finite and not negative");
        need(std::isfinite(e.rotation), "the environment's rotation must be finite");
        need(direction(e.up) && direction(e.to_sun),
             "the environment's 'up' and 'to_sun' must be finite and not zero");
        need(e.turbidity >= kLeastTurbidity && e.turbidity <= kLargestTurbidity,
             "the environment's turbidity must be from 1 (pure air) to 10 (haze)");
        need(bright(e.ground) && e.ground.max() <= 1,
             "the environment's ground is an albedo: from 0 to 1");
        need(e.kind != EnvironmentKind::Picture ||
                 (e.picture && e.picture->width > 0 && e.picture->height > 0),
             "an environment of kind picture needs a picture");
    }

    void check_mesh(const MeshDescription& description) {
        interruption_point();
        if (!description.mesh) {
            error(description.location, fmt::format("{} is missing", in_words(description)));
            return;
        }
        const TriangleMesh& mesh = *description.mesh;
        mesh.validate(description.location, out_);
        if (const char* fault = fault_of(mesh, description.keys); fault != nullptr) {
            error(description.location, fmt::format("{}: {}", in_words(description), fault));
        }
        const auto bad = std::find_if(mesh.vertex_materials.begin(), mesh.vertex_materials.end(),
                                      [&](std::uint32_t m) { return m >= d_.materials.size(); });
        if (bad != mesh.vertex_materials.end()) {
            error(description.location,
                  fmt::format("a vertex of {} refers to material {} of {}", in_words(description),
                              *bad, d_.materials.size()));
        }
    }

    void check_keys(const std::vector<TransformKey>& keys, const FileLocation& where) {
        if (const char* fault = fault_of(keys); fault != nullptr) error(where, fault);
    }

    void check_motion(const Part& part) {
        if (!part.motion) return;
        if (part.motion->keys.empty()) error(part.location, "a motion needs at least one key");
        check_keys(part.motion->keys, part.location);
        if (!is_invertible(part.motion->outer) || !is_invertible(part.motion->inner)) {
            error(part.location, "the transforms around a motion must have an inverse");
        }
    }

    void check_mask(const Part& part) {
        if (part.visible_to == kAllRays || part.visible_to == kLightSurfaceMask) return;
        if ((part.visible_to & ~kRaysOfAllKinds) != 0) {
            error(part.location,
                  fmt::format("is visible to rays of mask {:#x}; known are bits of {:#x}",
                              part.visible_to, kRaysOfAllKinds));
        } else if (part.visible_to == 0) {
            warning(part.location, "is visible to no ray");
        }
    }

    void check_part(const Part& part) {
        interruption_point();
        check_mask(part);
        check_motion(part);
        if (!is_invertible(part.object_from_part)) {
            error(part.location, "the transform is singular or not finite");
        }
        if (const AnyShape* shape = std::get_if<AnyShape>(&part.what)) {
            std::visit([&](const auto& s) { s.validate(part.location, out_); }, *shape);
        } else if (const MeshIndex* mesh = std::get_if<MeshIndex>(&part.what)) {
            if (static_cast<std::uint32_t>(*mesh) >= d_.meshes.size()) {
                error(part.location,
                      fmt::format("refers to mesh {} of {}", static_cast<std::uint32_t>(*mesh),
                                  d_.meshes.size()));
            }
        } else if (static_cast<std::uint32_t>(std::get<ObjectIndex>(part.what)) >=
                   d_.objects.size()) {
            error(part.location,
                  fmt::format("refers to object {} of {}",
                              static_cast<std::uint32_t>(std::get<ObjectIndex>(part.what)),
                              d_.objects.size()));
        }
        if (!std::holds_alternative<ObjectIndex>(part.what) &&
            static_cast<std::uint32_t>(part.material) >= d_.materials.size()) {
            error(part.location,
                  fmt::format("refers to material {} of {}",
                              static_cast<std::uint32_t>(part.material), d_.materials.size()));
        }
    }

    void check_accelerators() {
        for (std::size_t i = 0; i < d_.objects.size(); ++i) {
            const ObjectDescription& object = d_.objects[i];
            if (object.accelerator.empty()) continue;
            if (object.combine != Combine::Group) {
                error(object.location, "a solid made of others has no accelerator of its own");
            } else if (i == static_cast<std::size_t>(d_.root)) {
                error(object.location,
                      "the root of the scene is traced with what the command line says: it has no "
                      "accelerator of its own");
            }
            try {
                check_accelerator(object.accelerator);
            } catch (const Error& e) {
                error(object.location, e.what());
            }
        }
    }

    /// Warns once of each mesh without texture coordinates whose materials have pictures.
    void check_coordinates() {
        if (d_.textures.empty()) return;
        std::vector<bool> told(d_.meshes.size());
        for (const ObjectDescription& object : d_.objects) {
            for (const Part& part : object.parts) {
                const auto* index = std::get_if<MeshIndex>(&part.what);
                if (index == nullptr || told[static_cast<std::size_t>(*index)]) continue;
                const MeshDescription& mesh = d_.meshes[static_cast<std::size_t>(*index)];
                if (!mesh.mesh->uvs.empty()) continue;
                if (!reads_pictures(d_, part.material, *mesh.mesh)) continue;
                told[static_cast<std::size_t>(*index)] = true;
                warning(part.location,
                        fmt::format("{} has no texture coordinates: each of its triangles shows "
                                    "half of the pictures of its material",
                                    in_words(mesh)));
            }
        }
    }

    [[nodiscard]] std::vector<int> object_uses() const {
        std::vector<int> uses(d_.objects.size(), 0);
        for (const ObjectDescription& object : d_.objects) {
            for (const Part& part : object.parts) {
                const auto* child = std::get_if<ObjectIndex>(&part.what);
                if (child == nullptr || static_cast<std::size_t>(*child) >= uses.size()) continue;
                ++uses[static_cast<std::size_t>(*child)];
            }
        }
        return uses;
    }

    /// Computes the depth of every object with an explicit stack: malicious nesting must not
    /// overflow the call stack.
    void check_nesting() {
        enum : std::uint8_t { New, Open, Done };
        const std::size_t n = d_.objects.size();
        if (static_cast<std::size_t>(d_.root) >= n) {
            error({}, "the scene has no root object");
            return;
        }
        std::vector<std::uint8_t> state(n, New);
        std::vector<int> depth(n, 0);
        // Parts of a solid that are placed once are merged into it and take no instance level.
        std::vector<int> nesting(n, 0), uses = object_uses();
        const auto deepen = [&](std::size_t outer, std::size_t inner) {
            const bool joined = d_.objects[outer].combine != Combine::Group && uses[inner] == 1;
            depth[outer] = std::max(depth[outer], depth[inner] + !joined);
            nesting[outer] = std::max(nesting[outer], nesting[inner] + 1);
        };
        struct Frame {
            std::size_t object, next_part;
        };
        std::vector<Frame> stack{{static_cast<std::size_t>(d_.root), 0}};
        state[stack.back().object] = Open;
        while (!stack.empty()) {
            Frame& frame = stack.back();
            const std::size_t object = frame.object;
            const auto& parts = d_.objects[object].parts;
            if (frame.next_part == parts.size()) {
                state[object] = Done;
                stack.pop_back();
                if (!stack.empty()) {
                    deepen(stack.back().object, object);
                }
                continue;
            }
            const Part& part = parts[frame.next_part++];
            const ObjectIndex* child = std::get_if<ObjectIndex>(&part.what);
            if (child == nullptr || static_cast<std::size_t>(*child) >= n) continue;
            const std::size_t c = static_cast<std::size_t>(*child);
            if (state[c] == Open) {
                error(part.location,
                      fmt::format("object '{}' contains itself", d_.objects[c].name));
                return;
            }
            if (state[c] == Done) {
                deepen(object, c);
            } else {
                state[c] = Open;
                stack.push_back({c, 0});
            }
        }
        const int deepest = depth[static_cast<std::size_t>(d_.root)];
        const int nested = nesting[static_cast<std::size_t>(d_.root)];
        // Automatic instances of meshes may add one level.
        if (deepest + 1 > static_cast<int>(kMaxInstanceDepth)) {
            error({}, fmt::format("objects are nested {} deep; at most {} levels are supported",
                                  deepest, kMaxInstanceDepth - 1));
        } else if (nested > kMaxSolidNesting) {
            error({}, fmt::format("solids are nested {} deep; at most {} levels are supported",
                                  nested, kMaxSolidNesting));
        }
        if (d_.objects[static_cast<std::size_t>(d_.root)].parts.empty()) {
            warning({}, "the scene is empty");
        }
    }

    void check_picture() {
        const auto side = [&](const std::optional<int>& pixels, const char* what) {
            if (pixels && (*pixels < 1 || *pixels > kMaxPictureSide)) {
                error({}, fmt::format("picture {} must be 1 to {} pixels, found {}", what,
                                      kMaxPictureSide, *pixels));
            }
        };
        side(d_.picture.width, "width");
        side(d_.picture.height, "height");
        const Shutter& shutter = d_.shutter;
        if (!std::isfinite(shutter.open) || !std::isfinite(shutter.close) ||
            shutter.close < shutter.open) {
            error({}, "the shutter must close at a finite time not before it opens");
        }
        if (!finite(d_.picture.background.value_or(Rgb{}))) {
            error({}, "the background colour must be finite");
        }
    }

    const SceneDescription& d_;
    Diagnostics& out_;
};

}  // namespace

void validate(const SceneDescription& description, Diagnostics& diagnostics) {
    Validator(description, diagnostics).run();
}

}  // namespace alhazen
