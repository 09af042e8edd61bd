#include "alhazen/formats/patch_files/patch_export.h"

#include <algorithm>

#include "alhazen/formats/mesh_files/mesh_export_text.h"

namespace alhazen {

namespace {

/// A surface as control points and, for each patch, indices of them.
struct PatchList {
    std::uint32_t degree_u = 1, degree_v = 1;
    std::vector<Vec3> points;
    std::vector<double> weights;  ///< or empty
    std::vector<std::uint32_t> patches;
};

std::optional<PatchList> patches_of(const AnyShape& shape) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) {
        return PatchList{mesh->degree_u, mesh->degree_v, mesh->points, mesh->weights,
                         mesh->patches};
    }
    PatchList list;
    if (const auto* patch = std::get_if<BezierPatch>(&shape)) {
        list = {patch->degree_u, patch->degree_v, patch->points, patch->weights, {}};
    } else if (const auto* flat = std::get_if<BilinearPatch>(&shape)) {
        list.points = {flat->p00, flat->p01, flat->p10, flat->p11};
    } else {
        return std::nullopt;
    }
    for (std::size_t k = 0; k < list.points.size(); ++k) list.patches.push_back(std::uint32_t(k));
    return list;
}

bool all_one(const std::vector<double>& weights) {
    return std::all_of(weights.begin(), weights.end(), [](double w) { return w == 1.0; });
}

Vec3 placed_point(const Affine& placement, const Vec3& p) {
    return placement == Affine{} ? p : placement.point(p);
}

/// u-major indices of one patch with its rows, of constant u, in reverse order.
std::vector<std::uint32_t> reversed_rows(std::span<const std::uint32_t> patch, std::size_t rows) {
    const std::size_t columns = patch.size() / rows;
    std::vector<std::uint32_t> out;
    for (std::size_t i = rows; i-- > 0;) {
        const auto row = patch.subspan(i * columns, columns);
        out.insert(out.end(), row.begin(), row.end());
    }
    return out;
}

void append_bpt(const NamedSurface& surface, const PatchList& list, std::string& out) {
    const std::size_t rows = list.degree_u + 1, size = rows * (list.degree_v + 1);
    const bool mirrored = is_mirroring(surface.placement);
    for (std::size_t at = 0; at + size <= list.patches.size(); at += size) {
        std::span<const std::uint32_t> patch(&list.patches[at], size);
        std::vector<std::uint32_t> other;
        if (mirrored) patch = other = reversed_rows(patch, rows);
        out += std::to_string(list.degree_u) + ' ' + std::to_string(list.degree_v) + '\n';
        for (const std::uint32_t index : patch) {
            const Vec3 p = placed_point(surface.placement, list.points[index]);
            const std::size_t begin = out.size();
            for (const double c : {p.x, p.y, p.z}) append_number(out, c);
            out.erase(begin, 1);  // the blank before the first number
            out += '\n';
        }
    }
}

// --- OBJ.

void append_obj_points(const NamedSurface& surface, const std::vector<Vec3>& points,
                       const std::vector<double>& weights, std::string& out) {
    if (const std::string material = one_name(surface.material); !material.empty()) {
        out += "usemtl " + material + '\n';
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec3 p = placed_point(surface.placement, points[k]);
        out += 'v';
        for (const double c : {p.x, p.y, p.z}) append_number(out, c);
        if (!weights.empty()) append_number(out, weights[k]);
        out += '\n';
    }
}

void append_obj_numbers(const char* words, const std::vector<double>& numbers, std::string& out) {
    out += words;
    for (const double number : numbers) append_number(out, number);
    out += '\n';
}

/// Appends a u-major net with u fastest; indices are relative to the last of `count` points.
void append_obj_net(std::span<const std::uint32_t> net, std::size_t rows, std::size_t columns,
                    std::size_t count, std::string& out) {
    for (std::size_t j = 0; j < columns; ++j) {
        for (std::size_t i = 0; i < rows; ++i) {
            out += " -" + std::to_string(count - net[i * columns + j]);
        }
    }
    out += '\n';
}

void append_obj_patches(const NamedSurface& surface, const PatchList& list, std::string& out) {
    append_obj_points(surface, list.points, list.weights, out);
    const std::size_t rows = list.degree_u + 1, columns = list.degree_v + 1;
    const std::size_t size = rows * columns;
    const bool mirrored = is_mirroring(surface.placement);
    out += list.weights.empty() ? "cstype bezier\n" : "cstype rat bezier\n";
    out += "deg " + std::to_string(rows - 1) + ' ' + std::to_string(columns - 1) + '\n';
    for (std::size_t at = 0; at + size <= list.patches.size(); at += size) {
        std::span<const std::uint32_t> patch(&list.patches[at], size);
        std::vector<std::uint32_t> other;
        if (mirrored) patch = other = reversed_rows(patch, rows);
        out += "surf 0 1 0 1";
        append_obj_net(patch, rows, columns, list.points.size(), out);
        out += "parm u 0 1\nparm v 0 1\nend\n";
    }
}

/// The knots of a curve; computed if it has none.
std::vector<double> all_knots(const TrimCurve& curve) {
    if (!curve.knots.empty()) return curve.knots;
    const std::size_t degree = curve.degree;
    std::vector<double> knots(degree, 0.0);
    for (std::size_t k = 0; k + degree <= curve.points.size(); ++k) {
        if (k + degree == curve.points.size() || k == 0 || degree == 1) knots.push_back(double(k));
    }
    knots.insert(knots.end(), degree, knots.back());
    return knots;
}

void append_obj_curve(const TrimCurve& curve, bool mirrored, std::string& out) {
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
        Vec2 p = curve.points[k];
        if (mirrored) p.x = -p.x;
        out += "vp";
        append_number(out, p.x);
        append_number(out, p.y);
        if (!curve.weights.empty()) append_number(out, curve.weights[k]);
        out += '\n';
    }
    out += curve.weights.empty() ? "cstype bspline\n" : "cstype rat bspline\n";
    out += "deg " + std::to_string(curve.degree) + "\ncurv2";
    for (std::size_t k = curve.points.size(); k > 0; --k) out += " -" + std::to_string(k);
    append_obj_numbers("\nparm u", all_knots(curve), out);
    out += "end\n";
}

/// Writes the loops; returns the `trim` and `hole` statements of the surface that follows.
std::string append_obj_loops(const std::vector<TrimLoop>& trims, bool mirrored, std::string& out) {
    std::size_t curves = 0;
    for (const TrimLoop& loop : trims) {
        for (const TrimCurve& curve : loop) append_obj_curve(curve, mirrored, out);
        curves += loop.size();
    }
    std::string uses;
    for (std::size_t k = 0; k < trims.size(); ++k) {
        uses += k == 0 ? "trim" : "hole";
        for (const TrimCurve& curve : trims[k]) {
            const std::vector<double> knots = all_knots(curve);
            append_number(uses, knots[curve.degree]);
            append_number(uses, knots[curve.points.size()]);
            uses += " -" + std::to_string(curves--);
        }
        uses += '\n';
    }
    return uses;
}

void append_obj_nurbs(const NamedSurface& surface, const NurbsSurface& s, std::string& out) {
    append_obj_points(surface, s.points, s.weights, out);
    const bool mirrored = is_mirroring(surface.placement);
    const std::string trims = append_obj_loops(s.trims, mirrored, out);
    const std::size_t rows = s.knots_u.size() - s.degree_u - 1;
    const std::size_t columns = s.knots_v.size() - s.degree_v - 1;
    std::vector<std::uint32_t> net;
    for (std::size_t k = 0; k < s.points.size(); ++k) net.push_back(std::uint32_t(k));
    std::vector<double> knots_u = s.knots_u;
    if (mirrored) {
        net = reversed_rows(net, rows);
        std::reverse(knots_u.begin(), knots_u.end());
        for (double& knot : knots_u) knot = -knot;
    }
    out += s.weights.empty() ? "cstype bspline\n" : "cstype rat bspline\n";
    out += "deg " + std::to_string(s.degree_u) + ' ' + std::to_string(s.degree_v) + "\nsurf";
    for (const double c :
         {knots_u[s.degree_u], knots_u[rows], s.knots_v[s.degree_v], s.knots_v[columns]}) {
        append_number(out, c);
    }
    append_obj_net(net, rows, columns, s.points.size(), out);
    append_obj_numbers("parm u", knots_u, out);
    append_obj_numbers("parm v", s.knots_v, out);
    out += trims + "end\n";
}

}  // namespace

bool is_mirroring(const Affine& placement) {
    return determinant(placement.linear) < 0.0;
}

bool fits_bpt(const AnyShape& shape) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) return all_one(mesh->weights);
    if (const auto* patch = std::get_if<BezierPatch>(&shape)) return all_one(patch->weights);
    return std::holds_alternative<BilinearPatch>(shape);
}

bool fits_obj_surface(const AnyShape& shape) {
    return std::holds_alternative<PatchMesh>(shape) || std::holds_alternative<BezierPatch>(shape) ||
           std::holds_alternative<BilinearPatch>(shape) ||
           std::holds_alternative<NurbsSurface>(shape);
}

std::size_t control_points_of(const AnyShape& shape) {
    if (const auto* mesh = std::get_if<PatchMesh>(&shape)) return mesh->patches.size();
    if (const auto* patch = std::get_if<BezierPatch>(&shape)) return patch->points.size();
    if (const auto* nurbs = std::get_if<NurbsSurface>(&shape)) return nurbs->points.size();
    return std::holds_alternative<BilinearPatch>(shape) ? 4 : 0;
}

std::string bpt_text(std::span<const NamedSurface> surfaces) {
    std::string patches;
    std::size_t count = 0;
    for (const NamedSurface& surface : surfaces) {
        const std::optional<PatchList> list = patches_of(*surface.shape);
        if (!list) continue;
        append_bpt(surface, *list, patches);
        count += list->patches.size() / ((list->degree_u + 1) * (list->degree_v + 1));
    }
    return std::to_string(count) + '\n' + patches;
}

std::string obj_surfaces_text(std::span<const NamedSurface> surfaces) {
    std::string out;
    const std::vector<std::string> names = object_names(surfaces, "surface");
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const NamedSurface& surface = surfaces[i];
        out += "o " + names[i] + '\n';
        if (const auto* nurbs = std::get_if<NurbsSurface>(surface.shape)) {
            append_obj_nurbs(surface, *nurbs, out);
        } else if (const std::optional<PatchList> list = patches_of(*surface.shape)) {
            append_obj_patches(surface, *list, out);
        }
    }
    return out;
}

}  // namespace alhazen
