#pragma once
/// The order in which the pixels of a tile are rendered: by blocks of 8 x 8 pixels, in each by
/// cells of 4 x 2 pixels, whose rays form a packet.

#include <algorithm>
#include <vector>

namespace alhazen {

/// A pixel, relative to the corner of the tile.
struct TilePixel {
    int i, j;
};

/// Lists the pixels of a tile.
inline void list_pixels_of_tile(int width, int height, std::vector<TilePixel>& pixels) {
    constexpr int kBlock = 8, kCellWidth = 4, kCellHeight = 2;
    pixels.clear();
    const auto for_parts = [](int begin, int end, int step, auto&& f) {
        for (int at = begin; at < end; at += step) f(at, std::min(at + step, end));
    };
    const auto add_cells = [&](int x0, int x1, int y0, int y1) {
        for_parts(y0, y1, kCellHeight, [&](int cell_y0, int cell_y1) {
            for_parts(x0, x1, kCellWidth, [&](int cell_x0, int cell_x1) {
                for (int j = cell_y0; j < cell_y1; ++j) {
                    for (int i = cell_x0; i < cell_x1; ++i) pixels.push_back({i, j});
                }
            });
        });
    };
    for_parts(0, height, kBlock, [&](int y0, int y1) {
        for_parts(0, width, kBlock, [&](int x0, int x1) { add_cells(x0, x1, y0, y1); });
    });
}

}  // namespace alhazen
