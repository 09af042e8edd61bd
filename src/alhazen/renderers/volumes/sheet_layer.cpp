#include "alhazen/renderers/volumes/sheet_layer.h"

namespace alhazen {

namespace {

/// Adds a highlight; of more than there is room for the faintest is left out.
void add_highlight(const SheetHighlight& added, ShadingPoint& point) {
    if (added.specular.is_black()) return;
    auto& highlights = point.highlights;
    if (!highlights.full()) return highlights.push_back(added);
    std::size_t faintest = 0;
    for (std::size_t k = 1; k < highlights.size(); ++k) {
        if (highlights[k].specular.max() < highlights[faintest].specular.max()) faintest = k;
    }
    if (added.specular.max() > highlights[faintest].specular.max()) highlights[faintest] = added;
}

}  // namespace

void lay_below(const MaterialSample& sheet, bool sheet_is_behind, ShadingPoint& point) {
    MaterialSample& below = point.own_material();
    if (below.reflective.is_black()) below.roughness = sheet.roughness;
    below.unlit = false;
    SheetHighlight added{sheet.specular, sheet.shininess, sheet.physical};
    Rgb seen{1, 1, 1};  // of the light that what is below reflects
    for (int i = 0; i < 3; ++i) {
        const double on_top = sheet.reflective[i], through = sheet.transmissive[i];
        const double once = 1.0 - on_top * below.reflective[i];
        const double passes = once > 0.0 ? through / once : 0.0, passed = point.passing[i];
        point.passing[i] = passes * passed;
        point.sheets[i] *= passes;
        if (sheet_is_behind) {
            const double leaves = once > 0.0 ? passed / once : 0.0, back = passed * leaves;
            added.specular[i] *= back;
            below.reflective[i] += back * on_top;
            below.diffuse[i] += back * sheet.diffuse[i];
            below.ambient[i] += leaves * sheet.ambient[i];
            below.emission[i] += leaves * sheet.emission[i];
            continue;
        }
        seen[i] = through * passes;
        below.reflective[i] = on_top + seen[i] * below.reflective[i];
        below.diffuse[i] = sheet.diffuse[i] + seen[i] * below.diffuse[i];
        below.ambient[i] = sheet.ambient[i] + passes * below.ambient[i];
        below.emission[i] = sheet.emission[i] + passes * below.emission[i];
    }
    below.specular = seen * below.specular;
    for (std::size_t k = 0; k < point.highlights.size(); ++k) {
        point.highlights[k].specular = seen * point.highlights[k].specular;
    }
    add_highlight(added, point);
}

}  // namespace alhazen
