// Checks of the numbers in the buffers: bounds, indices, unit vectors, times, matrices. Values that
// would be misread or are out of range are errors; other deviations are warnings.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "alhazen/formats/gltf/document/gltf_accessor_extent.h"
#include "alhazen/formats/gltf/document/gltf_accessors.h"
#include "alhazen/formats/gltf/document/gltf_matrix.h"
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

/// Tolerances for the length of unit vectors stored in few bits, those of Khronos' validator.
constexpr double kUnitVectorTolerance = 0.00674, kUnitQuaternionTolerance = 0.00769;

/// Tolerances for sums of weights: four bytes round by less than the first.
constexpr double kWeightTolerance = 0.01, kWeightRounding = 1e-6;

/// True if the declared number equals the number found after rounding to the stored type.
bool agrees(double declared, double found, ComponentType type) {
    if (type == ComponentType::Float) {
        return static_cast<float>(declared) == static_cast<float>(found);
    }
    return declared == found;
}

class DataChecker {
  public:
    explicit DataChecker(const Loading& loading)
        : loading_(loading),
          document_(loading.document),
          found_(loading.document.accessors.size()) {}

    void run() {
        for (std::size_t i = 0; i < document_.accessors.size(); ++i) bounds(i);
        for (std::size_t i = 0; i < document_.meshes.size(); ++i) {
            for (std::size_t j = 0; j < document_.meshes[i].primitives.size(); ++j) {
                primitive(document_.meshes[i].primitives[j],
                          pointer_to("meshes", i, "primitives", j));
            }
        }
        skinned_nodes();
        for (std::size_t i = 0; i < document_.skins.size(); ++i) {
            const auto& matrices = document_.skins[i].inverse_bind_matrices;
            if (matrices && checked_matrices_.insert(*matrices).second) {
                bind_matrices(*matrices, pointer_to("skins", i) + "/inverseBindMatrices");
            }
        }
        for (std::size_t i = 0; i < document_.animations.size(); ++i) animation(i);
    }

  private:
    /// The parts of an extent that later checks use; kept small, since there may be many accessors.
    struct Found {
        std::array<double, 4> max{};
        bool within_unit = false;  ///< all numbers are in 0..1
    };

    void bounds(std::size_t position) {
        const Accessor& accessor = document_.accessors[position];
        const Extent extent = extent_of(document_, accessor);
        Found& found = found_[position];
        std::copy_n(extent.max.begin(), found.max.size(), found.max.begin());
        found.within_unit = true;
        for (std::size_t i = 0; i < component_count(accessor.type); ++i) {
            found.within_unit = found.within_unit && extent.min[i] >= 0 && extent.max[i] <= 1;
        }
        const std::string place = pointer_to("accessors", position);
        if (!extent.is_finite) {
            loading_.error(place, "there are infinite or NaN numbers");
            return;
        }
        if (!has_data(static_cast<Index>(position))) return;
        declared(accessor.min, extent.min, accessor.component, place + "/min");
        declared(accessor.max, extent.max, accessor.component, place + "/max");
    }

    /// False for accessors without data, whose numbers an extension may supply.
    [[nodiscard]] bool has_data(Index index) const {
        const Accessor& accessor = document_.accessors[index];
        return accessor.view || accessor.sparse;
    }

    void declared(const std::vector<double>& declared, const std::array<double, 16>& found,
                  ComponentType type, const std::string& place) const {
        for (std::size_t i = 0; i < declared.size(); ++i) {
            if (agrees(declared[i], found[i], type)) continue;
            loading_.error(place + "/" + std::to_string(i),
                           "declared " + written(declared[i]) + ", found " + written(found[i]));
        }
    }

    void primitive(const Primitive& primitive, const std::string& place) {
        std::uint64_t vertices = 0;
        for (const auto& [name, index] : primitive.attributes) {
            vertices = document_.accessors[index].count;
            const std::string at = place + "/attributes/" + name;
            if (name == "NORMAL" || name == "TANGENT") unit_vectors(index, at);
            if (name.starts_with("COLOR_")) zero_to_one(index, at);
        }
        weights(primitive, place + "/attributes");
        if (primitive.indices) indices(*primitive.indices, vertices, place + "/indices");
    }

    void indices(Index index, std::uint64_t vertices, const std::string& place) const {
        const Accessor& accessor = document_.accessors[index];
        const double largest = found_[index].max[0];
        const std::size_t bits = 8 * component_size(accessor.component);
        const double restart = static_cast<double>((std::uint64_t{1} << bits) - 1);
        if (largest >= static_cast<double>(vertices)) {
            loading_.error(place, "index " + written(largest) + " is beyond the " +
                                      std::to_string(vertices) + " vertices");
        } else if (largest == restart) {
            loading_.error(place, "index " + written(largest) +
                                      " is reserved (primitive restart); not allowed");
        }
    }

    /// Checks that weights are not negative and add up to 1, and that no joint has two of them.
    void weights(const Primitive& primitive, const std::string& place) {
        std::vector<Index> joints, weights;
        for (std::size_t set = 0;; ++set) {
            const auto joint = primitive.attributes.find("JOINTS_" + std::to_string(set));
            const auto weight = primitive.attributes.find("WEIGHTS_" + std::to_string(set));
            const auto end = primitive.attributes.end();
            if (joint == end || weight == end) break;
            if (!has_data(weight->second) || !has_data(joint->second)) return;
            joints.push_back(joint->second);
            weights.push_back(weight->second);
        }
        if (weights.empty() || !checked_weights_.insert({joints, weights}).second) return;
        // Primitives may share accessors in any combination.
        const std::uint64_t count = document_.accessors[weights.front()].count;
        const std::uint64_t numbers = 8 * weights.size() * count;
        if (numbers > weight_budget_) return;
        weight_budget_ -= numbers;
        std::vector<std::vector<double>> weight_sets;
        std::vector<std::vector<std::uint32_t>> joint_sets;
        for (std::size_t set = 0; set < weights.size(); ++set) {
            weight_sets.push_back(read_numbers(document_, weights[set]));
            joint_sets.push_back(read_integers(document_, joints[set]));
        }
        bool rounded = false;
        std::vector<std::uint32_t> used;
        for (std::size_t i = 0; i < count; ++i) {
            double sum = 0;
            used.clear();
            for (std::size_t k = 0; k < 4 * weight_sets.size(); ++k) {
                const double weight = weight_sets[k / 4][4 * i + k % 4];
                if (weight < 0) {
                    loading_.error(place, "weight " + std::to_string(k % 4) + " of vertex " +
                                              std::to_string(i) + " is negative");
                    return;
                }
                if (weight == 0) continue;
                sum += weight;
                used.push_back(joint_sets[k / 4][4 * i + k % 4]);
            }
            std::sort(used.begin(), used.end());
            const auto twice = std::adjacent_find(used.begin(), used.end());
            if (twice != used.end()) {
                loading_.error(place, "vertex " + std::to_string(i) + " has two weights of joint " +
                                          std::to_string(*twice));
                return;
            }
            const double error = std::abs(sum - 1);
            if (error > kWeightTolerance) {
                loading_.error(place, "the weights of vertex " + std::to_string(i) + " sum up to " +
                                          written(sum) + ", not to 1");
                return;
            }
            rounded = rounded || error > kWeightRounding;
        }
        if (rounded) loading_.warning(place, "weights do not sum up to 1; they are divided by it");
    }

    void zero_to_one(Index index, const std::string& place) const {
        const Accessor& accessor = document_.accessors[index];
        if (accessor.component != ComponentType::Float) return;
        if (found_[index].within_unit) return;
        loading_.error(place, "there are numbers outside 0 to 1");
    }

    void unit_vectors(Index index, const std::string& place) {
        const Accessor& accessor = document_.accessors[index];
        if (accessor.component != ComponentType::Float || !has_data(index)) return;
        if (!checked_vectors_.insert(index).second) return;
        std::uint64_t zeros = 0, others = 0, signs = 0;
        each_run(document_, accessor, [&](const ElementRun& run) {
            if (run.data == nullptr) {
                zeros += run.count;
                return;
            }
            for (std::uint64_t i = 0; i < run.count; ++i) {
                std::array<float, 4> v{0, 0, 0, 1};
                std::memcpy(v.data(), run.data + i * run.stride,
                            accessor.type == ElementType::Vec4 ? 16 : 12);
                const double length =
                    std::sqrt(double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2]);
                if (std::abs(length - 1) > kUnitVectorTolerance) ++(length == 0 ? zeros : others);
                if (std::abs(v[3]) != 1 && length != 0) ++signs;
            }
        });
        if (zeros != 0) {
            loading_.warning(place, std::to_string(zeros) + " vectors have length 0");
        }
        if (others != 0) {
            loading_.warning(place, std::to_string(others) + " vectors are not of unit length");
        }
        if (signs != 0) {
            loading_.error(place, std::to_string(signs) + " tangents have a w that is not 1 or -1");
        }
    }

    /// Checks that the joints of the vertices exist in the skin. Runs per mesh, not per node, since
    /// many nodes may share a mesh of many primitives.
    void skinned_nodes() const {
        std::vector<double> largest(document_.meshes.size(), -1);
        for (std::size_t i = 0; i < document_.meshes.size(); ++i) {
            for (const Primitive& primitive : document_.meshes[i].primitives) {
                for (const auto& [name, index] : primitive.attributes) {
                    if (!name.starts_with("JOINTS_")) continue;
                    for (std::size_t k = 0; k < 4; ++k) {
                        largest[i] = std::max(largest[i], found_[index].max[k]);
                    }
                }
            }
        }
        for (std::size_t i = 0; i < document_.nodes.size(); ++i) {
            const Node& node = document_.nodes[i];
            if (!node.skin || !node.mesh) continue;
            const std::size_t joints = document_.skins[*node.skin].joints.size();
            if (largest[*node.mesh] < static_cast<double>(joints)) continue;
            loading_.error(pointer_to("nodes", i), "the mesh uses joint " +
                                                       written(largest[*node.mesh]) +
                                                       ", the skin has " + std::to_string(joints));
        }
    }

    void bind_matrices(Index index, const std::string& place) {
        if (!has_data(index)) return;
        const std::vector<double> m = read_numbers(document_, index);
        bool rounded = false;
        for (std::size_t i = 0; i + 16 <= m.size(); i += 16) {
            const LastRow last_row = matrix_of(&m[i]).last_row;
            rounded = rounded || last_row == LastRow::Rounded;
            if (last_row != LastRow::Perspective) continue;
            loading_.error(
                place, "the last row of matrix " + std::to_string(i / 16) + " is not 0, 0, 0, 1");
            return;
        }
        if (rounded && !std::exchange(reported_rounding_, true)) {
            loading_.warning(place, kRoundedMatrices);
        }
    }

    void animation(std::size_t position) {
        const Animation& animation = document_.animations[position];
        for (std::size_t i = 0; i < animation.samplers.size(); ++i) {
            if (checked_times_.insert(animation.samplers[i].input).second) {
                times(animation.samplers[i].input,
                      pointer_to("animations", position, "samplers", i) + "/input");
            }
        }
        for (std::size_t i = 0; i < animation.channels.size(); ++i) {
            const AnimationChannel& channel = animation.channels[i];
            if (!channel.node || channel.path != AnimationPath::Rotation) continue;
            const AnimationSampler& sampler = animation.samplers[channel.sampler];
            const bool cubic = sampler.interpolation == Interpolation::CubicSpline;
            if (checked_quaternions_.insert({sampler.output, cubic}).second) {
                quaternions(sampler.output, cubic,
                            pointer_to("animations", position, "channels", i) + "/sampler");
            }
        }
    }

    void times(Index index, const std::string& place) const {
        if (!has_data(index)) return;
        double last = -1;
        std::size_t position = 0;
        for (const double time : read_numbers(document_, index)) {
            if (time < 0 || time <= last) {
                loading_.error(place, "time " + std::to_string(position) + ", " + written(time) +
                                          ", is negative or not greater than the previous one");
                return;
            }
            last = time;
            ++position;
        }
    }

    void quaternions(Index index, bool cubic, const std::string& place) const {
        if (!has_data(index)) return;
        const std::vector<double> q = read_numbers(document_, index);
        // A key of a cubic spline has three values; the middle one is the rotation, the others
        // tangents.
        for (std::size_t i = cubic ? 4 : 0; i + 4 <= q.size(); i += cubic ? 12 : 4) {
            const double length = std::sqrt(q[i] * q[i] + q[i + 1] * q[i + 1] +
                                            q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3]);
            if (std::abs(length - 1) <= tolerance_of(document_.accessors[index].component))
                continue;
            loading_.error(place, "quaternion " + std::to_string(i / 4) +
                                      " is not of unit length: " + written(length));
            return;
        }
    }

    /// Half a quantisation step in each of four components, for bytes.
    static double tolerance_of(ComponentType type) {
        const bool is_byte = type == ComponentType::Byte || type == ComponentType::UnsignedByte;
        return is_byte ? 2 * kUnitQuaternionTolerance : kUnitQuaternionTolerance;
    }

    const Loading& loading_;
    const Document& document_;
    std::vector<Found> found_;
    // Accessors already checked.
    std::set<Index> checked_vectors_, checked_matrices_, checked_times_;
    bool reported_rounding_ = false;
    std::set<std::pair<Index, bool>> checked_quaternions_;
    std::set<std::pair<std::vector<Index>, std::vector<Index>>> checked_weights_;
    std::uint64_t weight_budget_ = std::uint64_t{1} << 30;  ///< values left to read
};

}  // namespace

void check_data(const Loading& loading) {
    DataChecker(loading).run();
}

}  // namespace alhazen::gltf
