#include "alhazen/renderers/lane_carpenter/crack_count.h"

#include <vector>

#include "alhazen/renderers/lane_carpenter/patch_tables.h"
#include "alhazen/renderers/lane_carpenter/scan_polygon.h"

namespace alhazen {

std::uint64_t count_crack_samples(const ScanScene& scene, const ScreenView& view,
                                  const SampleGrid& grid, ScanLineOptions options) {
    const auto columns = static_cast<std::size_t>(grid.columns());
    const auto rows = static_cast<std::size_t>(grid.rows());
    std::vector<std::uint64_t> steps(rows * (columns + 1));
    PatchTables patches(scene, view, grid, options, true);
    ScanLineReport ignored;
    ScanQuad quad;
    const bool chords = options.cracks == Cracks::Clark;
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
                    const int column = line.first_right(grid, grid.y(j));
                    steps[static_cast<std::size_t>(j) * (columns + 1) +
                          static_cast<std::size_t>(column)] += weight;
                }
            }
        });
    }
    std::uint64_t found = 0;
    for (std::size_t j = 0; j < rows; ++j) {
        std::uint64_t sum = 0, base = 0;
        for (std::size_t i = 0; i < columns; ++i) {
            sum += steps[j * (columns + 1) + i];
            if (i == 0) base = sum;
            found += sum != base;
        }
    }
    return found;
}

}  // namespace alhazen
