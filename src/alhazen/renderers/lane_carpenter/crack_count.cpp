#include "alhazen/renderers/lane_carpenter/crack_count.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "alhazen/renderers/lane_carpenter/patch_tables.h"
#include "alhazen/renderers/lane_carpenter/scan_polygon.h"

namespace alhazen {

namespace {

/// What an edge adds to the sum of a row from a column on.
struct Step {
    int column = 0;
    std::uint64_t weight = 0;
};

/// Number of samples of a row whose sum is not that of the first one.
std::uint64_t differing_samples(std::vector<Step>& steps, int columns) {
    std::sort(steps.begin(), steps.end(),
              [](const Step& a, const Step& b) { return a.column < b.column; });
    std::uint64_t found = 0, sum = 0;  // relative to that of the first sample
    int begin = 0;
    for (const Step& step : steps) {
        if (sum != 0) found += static_cast<std::uint64_t>(step.column - begin);
        begin = step.column;
        if (step.column > 0) sum += step.weight;
    }
    if (sum != 0) found += static_cast<std::uint64_t>(columns - begin);
    return found;
}

}  // namespace

std::uint64_t count_crack_samples(const ScanScene& scene, const ScreenView& view,
                                  const SampleGrid& grid, ScanLineOptions options) {
    std::vector<std::vector<Step>> steps(static_cast<std::size_t>(grid.rows()));
    PatchTables patches(scene, view, grid, options, true);
    ScanLineReport ignored;
    ScanQuad quad;
    const bool chords = options.cracks == Cracks::Clark;
    std::uint64_t found = 0;
    for (int row = 0; row < grid.rows(); ++row) {
        patches.advance(row, ignored, [&](const SubPatch& patch) {
            const PatchDegrees degrees = patches.degrees(patch);
            set_quad(view, grid, degrees.u, degrees.v, patch, chords, quad);
            for (std::size_t side = 0; side < 4; ++side) {
                const EdgeLine& line = quad.lines[side];
                if (quad.seams[side] == 0 || line.dy == 0) continue;
                const std::uint64_t weight = line.turned ? ~quad.seams[side] + 1 : quad.seams[side];
                for (int j = quad.first_row; j < quad.end_row; ++j) {
                    if (!(line.y0 < grid.y(j) && grid.y(j) <= line.y0 + line.dy)) continue;
                    steps[static_cast<std::size_t>(j)].push_back(
                        {line.first_right(grid, grid.y(j)), weight});
                }
            }
        });
        // No further polygon begins here.
        std::vector<Step> here = std::move(steps[static_cast<std::size_t>(row)]);
        found += differing_samples(here, grid.columns());
    }
    return found;
}

}  // namespace alhazen
