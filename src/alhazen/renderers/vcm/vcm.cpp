#include "alhazen/renderers/vcm/vcm.h"

#include <utility>

#include "alhazen/renderers/bidirectional/bidirectional.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "alhazen/renderers/vcm/pilot.h"

namespace alhazen {

namespace {

/// Number of passes from which a pilot run takes at most an eighth of the picture's light paths.
constexpr int kPassesForPilot = 32;

}  // namespace

RenderReport Vcm::render(const RenderJob& job, Film& film) const {
    const Bidirectional joining(settings_.paths);
    if (!settings_.merge) return joining.render(job, film);
    refuse_stop_rules(job, "vcm");
    const VcmSettings settings = resolved(settings_, job, film);
    PilotFinding pilot;
    if (settings.pilot == Pilot::Choose ||
        (settings.pilot == Pilot::Say && job.samples_per_pixel >= kPassesForPilot)) {
        pilot = make_pilot_run(job, film, settings);
        if (settings.pilot == Pilot::Choose) {
            pilot.sentence += pilot.pays ? "; vertices are merged" : "; none are merged";
        }
    }
    MergeWork work;
    const bool merge = pilot.pays || settings.pilot != Pilot::Choose;
    RenderReport report =
        merge ? render_merging(job, film, settings, work) : joining.render(job, film);
    if (!pilot.sentence.empty() && pilot.complete) {
        report.remarks.push_back(std::move(pilot.sentence));
    }
    return report;
}

}  // namespace alhazen
