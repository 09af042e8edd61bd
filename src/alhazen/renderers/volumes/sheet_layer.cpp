#include "alhazen/renderers/volumes/sheet_layer.h"

namespace alhazen {

namespace {

/// Gives the highlights of two samples the shape of the broader one. Each keeps its energy, which
/// is proportional to ks / (ns + 2).
void join_highlights(MaterialSample& a, MaterialSample& b) {
    const bool as_b =
        a.specular.is_black() || (!b.specular.is_black() && b.shininess < a.shininess);
    const MaterialSample& broader = as_b ? b : a;
    MaterialSample& other = as_b ? a : b;
    other.specular = (broader.shininess + 2.0) / (other.shininess + 2.0) * other.specular;
    other.shininess = broader.shininess;
    other.highlight_by_cosine = broader.highlight_by_cosine;
}

}  // namespace

void lay_below(const MaterialSample& evaluated, bool sheet_is_behind, ShadingPoint& point) {
    MaterialSample& below = point.own_material();
    MaterialSample sheet = evaluated;
    if (below.reflective.is_black()) below.roughness = sheet.roughness;
    join_highlights(sheet, below);
    below.unlit = false;
    for (int i = 0; i < 3; ++i) {
        const double on_top = sheet.reflective[i], through = sheet.transmissive[i];
        const double once = 1.0 - on_top * below.reflective[i];
        const double passes = once > 0.0 ? through / once : 0.0, passed = point.passing[i];
        point.passing[i] = passes * passed;
        point.sheets[i] *= passes;
        if (sheet_is_behind) {
            const double leaves = once > 0.0 ? passed / once : 0.0, back = passed * leaves;
            below.reflective[i] += back * on_top;
            below.specular[i] += back * sheet.specular[i];
            below.diffuse[i] += back * sheet.diffuse[i];
            below.ambient[i] += leaves * sheet.ambient[i];
            below.emission[i] += leaves * sheet.emission[i];
            continue;
        }
        below.reflective[i] = on_top + through * passes * below.reflective[i];
        below.specular[i] = sheet.specular[i] + through * passes * below.specular[i];
        below.diffuse[i] = sheet.diffuse[i] + through * passes * below.diffuse[i];
        below.ambient[i] = sheet.ambient[i] + passes * below.ambient[i];
        below.emission[i] = sheet.emission[i] + passes * below.emission[i];
    }
}

}  // namespace alhazen
