#include "alhazen/formats/obj/obj_smoothing.h"

#include <algorithm>

#include "alhazen/formats/obj/obj_vertex_table.h"
#include "alhazen/geometry/polygon/triangulate.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxNormals = 0x7FFFFFFE;

/// The normal of a polygon; its length is twice the area.
Vec3 face_normal(const ObjStatements& in, std::uint32_t begin, std::uint32_t end) {
    const auto position = [&](std::uint32_t corner) {
        return in.positions[std::size_t(in.corners.position[corner])];
    };
    const Vec3 origin = position(begin);
    Vec3 sum;
    for (std::uint32_t c = begin + 1; c + 1 < end; ++c) {
        sum += cross(position(c) - origin, position(c + 1) - origin);
    }
    return sum;
}

std::int32_t add_normal(ObjStatements& in, const Vec3& normal, const std::string& file) {
    if (in.normals.size() >= kMaxNormals) {
        throw Error(ErrorKind::Resource, "too many generated normals", {file, 0, 0});
    }
    in.normals.push_back(normal);
    return std::int32_t(in.normals.size() - 1);
}

bool lacks_normal(const ObjCorners& corners, std::uint32_t corner) {
    return corners.normal.empty() || corners.normal[corner] < 0;
}

}  // namespace

void smooth_obj_normals(ObjStatements& in, const std::string& file) {
    bool needed = false;
    in.for_each_face([&](const ObjRun& run, std::uint32_t begin, std::uint32_t end, std::uint32_t) {
        if (run.smoothing == 0 || needed) return;
        for (std::uint32_t c = begin; c < end; ++c) {
            needed = needed || lacks_normal(in.corners, c);
        }
    });
    if (!needed) return;
    in.corners.need_normals();
    // One normal per pair of position and group, created at its first use.
    ObjVertexTable pairs;
    const std::size_t first = in.normals.size();
    in.for_each_face([&](const ObjRun& run, std::uint32_t begin, std::uint32_t end, std::uint32_t) {
        if (run.smoothing == 0) return;
        const Vec3 normal = face_normal(in, begin, end);
        for (std::uint32_t c = begin; c < end; ++c) {
            const std::uint32_t pair =
                pairs.find_or_add({in.corners.position[c], std::int32_t(run.smoothing), 0});
            if (first + pair == in.normals.size()) add_normal(in, {}, file);
            in.normals[first + pair] += normal;
            if (in.corners.normal[c] < 0) in.corners.normal[c] = std::int32_t(first + pair);
        }
    });
}

void flatten_obj_normals(ObjStatements& in, const std::string& file,
                         const std::vector<bool>& wanted) {
    if (in.corners.normal.empty()) return;
    for (std::size_t r = 0; r < in.runs.size(); ++r) {
        if (!wanted[r]) continue;
        in.for_each_face_in(
            r, [&](const ObjRun&, std::uint32_t begin, std::uint32_t end, std::uint32_t) {
                std::int32_t normal = -1;
                for (std::uint32_t c = begin; c < end; ++c) {
                    if (in.corners.normal[c] >= 0) continue;
                    if (normal < 0) normal = add_normal(in, face_normal(in, begin, end), file);
                    in.corners.normal[c] = normal;
                }
            });
    }
}

}  // namespace alhazen
