#include "alhazen/renderers/lane_carpenter/patch_tables.h"

#include <algorithm>
#include <array>
#include <memory>

#include "alhazen/renderers/lane_carpenter/boundary_seams.h"

namespace alhazen {

namespace {

std::size_t largest_net(const ScanScene& scene) {
    int most = 4;
    for (const ScanPiece& piece : scene.pieces) most = std::max(most, piece.net.count());
    return static_cast<std::size_t>(most);
}

}  // namespace

PatchTables::PatchTables(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
                         const ScanLineOptions& options, bool keeps_seams)
    : scene_(scene),
      view_(view),
      subdivision_(view, grid, options, options.flatness, keeps_seams),
      pool_(largest_net(scene)),
      buckets_(static_cast<std::size_t>(grid.rows()), kNoPatch) {
    std::unique_ptr<BoundarySeams> seams;
    if (keeps_seams) seams = std::make_unique<BoundarySeams>(scene);
    for (std::uint32_t k = 0; k < scene.pieces.size(); ++k) add_piece(k, seams.get());
}

void PatchTables::add_piece(std::uint32_t piece, const BoundarySeams* seams) {
    const BezierNet& net = scene_.pieces[piece].net;
    const std::uint32_t index = pool_.take();
    SubPatch& patch = pool_.at(index);
    patch = {.piece = piece, .points = patch.points};
    if (seams != nullptr) patch.seams = seams->of(piece);
    for (int k = 0; k < net.count(); ++k) {
        patch.points[k] = view_.on_screen(net.points[static_cast<std::size_t>(k)]);
    }
    subdivision_.judge({net.degree_u, net.degree_v}, patch);
    place(index, -1);
}

void PatchTables::split(const SubPatch& patch, int row, ScanLineReport& report) {
    report.split_u += patch.step != PatchStep::SplitV;
    report.split_v += patch.step != PatchStep::SplitU;
    std::array<std::uint32_t, 4> indices;
    std::array<SubPatch*, 4> children;
    const std::size_t count = patch.step == PatchStep::SplitBoth ? 4 : 2;
    for (std::size_t k = 0; k < count; ++k) {
        indices[k] = pool_.take();
        children[k] = &pool_.at(indices[k]);
    }
    const PatchDegrees own = degrees(patch);
    subdivision_.split(own, patch, children);
    for (std::size_t k = 0; k < count; ++k) {
        subdivision_.judge(own, *children[k]);
        place(indices[k], row);
    }
}

void PatchTables::place(std::uint32_t index, int row) {
    SubPatch& patch = pool_.at(index);
    if (patch.step == PatchStep::None) {
        pool_.give_back(index);
    } else if (patch.first_row <= row) {
        active_.push_back(index);
    } else {
        std::uint32_t& first = buckets_[static_cast<std::size_t>(patch.first_row)];
        patch.next = first;
        first = index;
        ++waiting_;
    }
}

}  // namespace alhazen
