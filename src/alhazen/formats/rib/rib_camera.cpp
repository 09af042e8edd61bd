#include "alhazen/formats/rib/rib_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alhazen {

namespace {

template <std::size_t N>
std::optional<std::array<double, N>> rib_numbers_of(const RibRequest& request) {
    std::array<double, N> out{};
    if (request.arguments.size() == 1 && request.list(0).size() == N) {
        for (std::size_t k = 0; k < N; ++k) out[k] = request.list(0)[k];
        return out;
    }
    if (request.arguments.size() != N) return std::nullopt;
    for (std::size_t k = 0; k < N; ++k) {
        const std::optional<double> number = request.number(k);
        if (!number) return std::nullopt;
        out[k] = *number;
    }
    return out;
}

}  // namespace

bool RibCamera::read(const RibRequest& request, std::string& problem) {
    if (request.name == "Format") {
        format_ = rib_numbers_of<3>(request);
        const bool good = format_ && (*format_)[0] >= 1 && (*format_)[1] >= 1 &&
                          (*format_)[0] <= kMaxPictureSide && (*format_)[1] <= kMaxPictureSide;
        if (!good) {
            problem = "expected a width, a height (1 to " + std::to_string(kMaxPictureSide) +
                      ") and the aspect of a pixel";
            format_.reset();
        } else if (!((*format_)[2] > 0.0)) {
            (*format_)[2] = 1.0;
        }
    } else if (request.name == "FrameAspectRatio") {
        const auto ratio = rib_numbers_of<1>(request);
        if (ratio && (*ratio)[0] > 1e-3 && (*ratio)[0] < 1e3) {
            frame_aspect_ = (*ratio)[0];
        } else {
            problem = "expected a ratio from 1e-3 to 1e3";
        }
    } else if (request.name == "ScreenWindow") {
        window_ = rib_numbers_of<4>(request);
        if (!window_ || !((*window_)[0] < (*window_)[1]) || !((*window_)[2] < (*window_)[3])) {
            problem = "expected left < right and bottom < top";
            window_.reset();
        }
    } else if (request.name == "Projection") {
        const std::string* kind = request.string(0);
        if (kind == nullptr || (*kind != "perspective" && *kind != "orthographic")) {
            problem = "expected \"perspective\" or \"orthographic\"";
            return true;
        }
        projected_ = true;
        perspective_ = *kind == "perspective";
        for (std::size_t k = 1; k + 1 < request.arguments.size(); k += 2) {
            const std::string* name = request.string(k);
            const std::optional<double> value = request.number(k + 1);
            if (name == nullptr || !name->ends_with("fov")) continue;
            if (value && *value > 0.0 && *value < 180.0) {
                fov_ = *value;
            } else {
                problem = "expected a field of view above 0 and below 180 degrees";
            }
        }
    } else {
        return false;
    }
    return true;
}

double RibCamera::aspect() const {
    if (frame_aspect_) return *frame_aspect_;
    if (format_) return (*format_)[0] * (*format_)[2] / (*format_)[1];
    return 4.0 / 3.0;
}

void RibCamera::add(const Affine& camera_from_world, const FileLocation& where,
                    SceneDescription& scene) const {
    const double ratio = aspect();
    if (format_) {
        // A frame of another aspect than the format is the largest that fits into it.
        const auto [width, height, pixel] = *format_;
        const double fit = ratio * height / (width * pixel);
        const auto part = [](double size) { return std::max(1, int(std::lround(size))); };
        scene.picture.width = fit < 1.0 ? part(width * fit) : int(width);
        scene.picture.height = fit > 1.0 ? part(height / fit) : int(height);
    }
    if (!projected_) return;
    const double x = std::fmax(ratio, 1.0), y = std::fmax(1.0 / ratio, 1.0);
    const auto [left, right, bottom, top] = window_.value_or(std::array{-x, x, -y, y});
    const Affine world = inverse(camera_from_world);
    const double scale = perspective_ ? std::tan(0.5 * fov_ * std::numbers::pi / 180.0) : 1.0;
    const Vec3 middle{0.5 * scale * (left + right), 0.5 * scale * (bottom + top), 0.0};
    const Vec3 wide = world.vector({scale * (right - left), 0, 0});
    const Vec3 high = world.vector({0, scale * (top - bottom), 0});
    CameraDescription camera;
    camera.name = "camera";
    // The screen window fills the picture, whatever the shape of its pixels.
    camera.aspect = format_         ? double(*scene.picture.width) / double(*scene.picture.height)
                    : frame_aspect_ ? ratio
                                    : (right - left) / (top - bottom);
    camera.location = where;
    if (perspective_) {
        camera.camera = PerspectiveCamera{world.point({0, 0, 0}),
                                          world.vector(middle + Vec3{0, 0, 1}), wide, high};
    } else {
        camera.camera =
            OrthographicCamera{world.point(middle), world.vector({0, 0, 1}), wide, high};
    }
    scene.cameras.push_back(std::move(camera));
}

}  // namespace alhazen
