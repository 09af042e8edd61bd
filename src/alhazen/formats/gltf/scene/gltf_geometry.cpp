#include "alhazen/formats/gltf/scene/gltf_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "alhazen/math/unit_vector.h"

namespace alhazen::gltf {

namespace {

/// Values of an attribute with its morph targets.
struct Values {
    std::vector<double> numbers;  ///< [vertex][width]
    std::size_t width = 0;        ///< 0: the primitive lacks the attribute

    [[nodiscard]] Vec3 vec3(std::size_t vertex) const {
        const double* p = numbers.data() + vertex * width;
        return {p[0], p[1], p[2]};
    }
    [[nodiscard]] Vec2 vec2(std::size_t vertex) const {
        return {numbers[vertex * width], numbers[vertex * width + 1]};
    }
};

class PrimitiveReader {
  public:
    PrimitiveReader(const Document& document, const Primitive& primitive,
                    std::span<const double> weights, Budget& budget)
        : document_(document), primitive_(primitive), weights_(weights), budget_(budget) {}

    PrimitiveGeometry read(bool with_joints) {
        PrimitiveGeometry result;
        const auto position = primitive_.attributes.find("POSITION");
        if (!makes_surface(primitive_.mode) || position == primitive_.attributes.end()) {
            return result;
        }
        vertex_count_ = document_.accessors[position->second].count;
        const std::vector<std::uint32_t> order = read_order();
        const bool list = primitive_.mode == PrimitiveMode::Triangles;
        budget_.make(list ? order.size() / 3 : order.size(), sizeof result.mesh.triangles.front());
        result.mesh.triangles = triangles_of(primitive_.mode, order);
        number_used_vertices(result.mesh.triangles);
        read_mesh(result.mesh);
        if (with_joints) read_joints(result.joints);
        return result;
    }

  private:
    std::vector<std::uint32_t> read_order() {
        if (primitive_.indices) {
            budget_.take(document_.accessors[*primitive_.indices].count);
            return read_integers(document_, *primitive_.indices);
        }
        budget_.take(vertex_count_);
        std::vector<std::uint32_t> order(vertex_count_);
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }

    /// Drops unused vertices: otherwise primitives that share one large vertex buffer would each
    /// carry all of it. The other vertices keep their order.
    void number_used_vertices(std::vector<std::array<std::uint32_t, 3>>& triangles) {
        constexpr std::uint32_t kUnused = 0xFFFFFFFFu;
        std::vector<std::uint32_t> new_number(vertex_count_, kUnused);
        for (const auto& triangle : triangles) {
            for (const std::uint32_t vertex : triangle) new_number[vertex] = 0;
        }
        for (std::uint32_t i = 0; i < vertex_count_; ++i) {
            if (new_number[i] == kUnused) continue;
            new_number[i] = std::uint32_t(used_.size());
            used_.push_back(i);
        }
        if (used_.size() == vertex_count_) return;
        for (auto& triangle : triangles) {
            for (std::uint32_t& vertex : triangle) vertex = new_number[vertex];
        }
    }

    /// The attribute plus the weighted morph targets.
    Values read(const std::string& semantic) {
        Values values = read_accessor(primitive_.attributes, semantic);
        const std::size_t targets = std::min(weights_.size(), primitive_.targets.size());
        for (std::size_t t = 0; values.width > 0 && t < targets; ++t) {
            if (weights_[t] == 0.0) continue;
            const Values deltas = read_accessor(primitive_.targets[t], semantic);
            if (deltas.width == 0) continue;
            // A tangent target has no handedness; a colour target may lack alpha.
            const std::size_t width = std::min(values.width, deltas.width);
            const std::size_t count = std::min(vertex_count_, deltas.numbers.size() / deltas.width);
            for (std::size_t v = 0; v < count; ++v) {
                for (std::size_t c = 0; c < width; ++c) {
                    values.numbers[v * values.width + c] +=
                        weights_[t] * deltas.numbers[v * deltas.width + c];
                }
            }
        }
        return values;
    }

    Values read_accessor(const Attributes& attributes, const std::string& semantic) {
        const auto found = attributes.find(semantic);
        if (found == attributes.end()) return {};
        const Accessor& accessor = document_.accessors[found->second];
        budget_.take(accessor.count);
        if (accessor.count < vertex_count_) return {};
        return {read_numbers(document_, found->second), component_count(accessor.type)};
    }

    void read_mesh(TriangleMesh& mesh) {
        fill(mesh.positions, "POSITION", 3,
             [](const Values& v, std::size_t i) { return v.vec3(i); });
        fill(mesh.normals, "NORMAL", 3,
             [](const Values& v, std::size_t i) { return unit_or(v.vec3(i), {}); });
        const auto upward = [](const Values& v, std::size_t i) {
            const Vec2 p = v.vec2(i);
            return Vec2{p.x, 1.0 - p.y};
        };
        fill(mesh.uvs, "TEXCOORD_0", 2, upward);
        fill(mesh.uvs2, "TEXCOORD_1", 2, upward);
        fill(mesh.colors, "COLOR_0", 3, [](const Values& v, std::size_t i) {
            const auto number = [&](std::size_t c) {
                return float(std::clamp(v.numbers[i * v.width + c], 0.0, 1.0));
            };
            return VertexColor{number(0), number(1), number(2), v.width > 3 ? number(3) : 1.0f};
        });
        // Without normals the shading is flat, and the specification ignores tangents.
        if (mesh.normals.empty()) return;
        fill(mesh.tangents, "TANGENT", 4, [](const Values& v, std::size_t i) {
            const Vec3 t = unit_or(v.vec3(i), {});
            return VertexTangent{float(t.x), float(t.y), float(t.z),
                                 v.numbers[4 * i + 3] < 0.0 ? -1.0f : 1.0f};
        });
    }

    template <class T, class Make>
    void fill(std::vector<T>& array, const std::string& semantic, std::size_t width, Make make) {
        const Values values = read(semantic);
        if (values.width < width) return;
        budget_.make(used_.size(), sizeof(T));
        array.reserve(used_.size());
        for (const std::uint32_t vertex : used_) array.push_back(make(values, vertex));
    }

    void read_joints(VertexJoints& out) {
        const std::size_t vertices = used_.size();
        for (int set = 0;; ++set) {
            const auto joints = primitive_.attributes.find(fmt::format("JOINTS_{}", set));
            const Values weights =
                read_accessor(primitive_.attributes, fmt::format("WEIGHTS_{}", set));
            if (joints == primitive_.attributes.end() || weights.width != 4) break;
            const Accessor& accessor = document_.accessors[joints->second];
            if (accessor.count < vertex_count_ || accessor.type != ElementType::Vec4) break;
            const std::vector<std::uint32_t> numbers = read_integers(document_, joints->second);
            // Interleaves the sets, so that the joints of a vertex are contiguous.
            const std::size_t old = out.per_vertex;
            budget_.make(vertices, 4 * (sizeof(std::uint32_t) + sizeof(double)));
            VertexJoints wider{old + 4, {}, {}};
            wider.joints.reserve(vertices * wider.per_vertex);
            wider.weights.reserve(vertices * wider.per_vertex);
            for (std::size_t i = 0; i < vertices; ++i) {
                for (std::size_t k = 0; k < wider.per_vertex; ++k) {
                    const bool known = k < old;
                    const std::size_t from =
                        known ? i * old + k : std::size_t{4} * used_[i] + k - old;
                    wider.joints.push_back(known ? out.joints[from] : numbers[from]);
                    wider.weights.push_back(known ? out.weights[from] : weights.numbers[from]);
                }
            }
            out = std::move(wider);
        }
    }

    const Document& document_;
    const Primitive& primitive_;
    std::span<const double> weights_;
    Budget& budget_;
    std::size_t vertex_count_ = 0;
    std::vector<std::uint32_t> used_;  ///< indices of the kept vertices in the file, ascending
};

}  // namespace

bool makes_surface(PrimitiveMode mode) {
    return mode == PrimitiveMode::Triangles || mode == PrimitiveMode::TriangleStrip ||
           mode == PrimitiveMode::TriangleFan;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(PrimitiveMode mode,
                                                       std::span<const std::uint32_t> order) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    if (mode == PrimitiveMode::Triangles) {
        triangles.reserve(order.size() / 3);
        for (std::size_t i = 0; i + 2 < order.size(); i += 3) {
            triangles.push_back({order[i], order[i + 1], order[i + 2]});
        }
        return triangles;
    }
    if (order.size() < 3) return triangles;
    triangles.reserve(order.size() - 2);
    for (std::size_t i = 0; i + 2 < order.size(); ++i) {
        if (mode == PrimitiveMode::TriangleFan) {
            triangles.push_back({order[i + 1], order[i + 2], order[0]});
        } else {
            // Every second triangle of a strip is reversed, so that all face the same way.
            const std::size_t odd = i % 2;
            triangles.push_back({order[i], order[i + 1 + odd], order[i + 2 - odd]});
        }
    }
    return triangles;
}

PrimitiveGeometry read_primitive(const Document& document, const Primitive& primitive,
                                 std::span<const double> weights, bool with_joints,
                                 Budget& budget) {
    return PrimitiveReader(document, primitive, weights, budget).read(with_joints);
}

}  // namespace alhazen::gltf
