#include "alhazen/renderers/core/renderer.h"

#include <array>

#include "alhazen/base/error.h"
#include "alhazen/renderers/ray_casting/ray_casting.h"
#include "alhazen/renderers/whitted/whitted.h"

namespace alhazen {

std::span<const RendererEntry> renderers() {
    static constexpr std::array<RendererEntry, 2> table{{
        {"whitted", "recursive ray tracing: shadows, reflection, refraction (Whitted 1980)",
         [] { return std::unique_ptr<Renderer>(std::make_unique<Whitted>()); }},
        {"ray_casting", "visible surfaces with local shading, no further rays (Appel 1968)",
         [] { return std::unique_ptr<Renderer>(std::make_unique<RayCasting>()); }},
    }};
    return table;
}

std::unique_ptr<Renderer> make_renderer(const std::string& name) {
    std::string known;
    for (const RendererEntry& entry : renderers()) {
        if (name == entry.name) return entry.make();
        known += known.empty() ? "" : ", ";
        known += entry.name;
    }
    throw Error(ErrorKind::Usage, "unknown renderer '" + name + "'; known: " + known);
}

}  // namespace alhazen
