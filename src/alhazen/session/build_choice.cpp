#include "alhazen/session/build_choice.h"

namespace alhazen {

namespace {

double expected_rays(const LoadedScene& loaded, const RenderOptions& options) {
    constexpr double kAspect = 4.0 / 3.0;  // as of scenes that are framed later
    const Scene& scene = loaded.scene;
    const double aspect = scene.cameras.empty() ? kAspect : chosen_camera(scene, options).aspect;
    const FrameSize frame = frame_size(loaded.description.picture, options, aspect);
    const double pixels = options.crop ? static_cast<double>(options.crop->area())
                                       : static_cast<double>(frame.width) * frame.height;
    return pixels * options.samples_per_pixel * (1.0 + static_cast<double>(scene.lights.size()));
}

}  // namespace

BuildQuality quality_for(std::size_t triangles, double rays) {
    return rays < kRaysOfDefaultBuild * static_cast<double>(triangles) ? BuildQuality::Fast
                                                                       : BuildQuality::Default;
}

BuildQuality quality_for_picture(const LoadedScene& loaded, const RenderOptions& options) {
    if (options.antialias) return BuildQuality::Default;  // many rays for some pixels
    std::size_t triangles = 0;
    for (const MeshDescription& mesh : loaded.description.meshes) {
        if (mesh.mesh) triangles += mesh.mesh->triangles.size();
    }
    return quality_for(triangles, expected_rays(loaded, options));
}

}  // namespace alhazen
