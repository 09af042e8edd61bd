#include "alhazen/renderers/core/antialias_settings.h"

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/renderer_settings.h"

namespace alhazen {

AntialiasSettings parse_antialias(const std::string& text) {
    static constexpr const char* kSwitch[] = {"off", "on"};
    RendererSettings given(text, "--antialias");
    AntialiasSettings settings;
    if (given.name() == "exact") {
        settings.exact = true;
        given.finish();
        return settings;
    }
    if (given.name() != "whitted") {
        throw Error(ErrorKind::Usage,
                    "--antialias '" + given.name() + "': unknown; known: whitted, exact");
    }
    settings.threshold = given.number("threshold", settings.threshold, 0.0, 1.0);
    settings.depth = given.whole("depth", settings.depth, 0, AntialiasSettings::kDeepest);
    settings.guarantee = given.choice("guarantee", 1, kSwitch) == 1;
    given.finish();
    return settings;
}

}  // namespace alhazen
