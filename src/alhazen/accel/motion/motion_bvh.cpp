#include "alhazen/accel/motion/motion_bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/accel/wide_bvh/build/binary_builder.h"

namespace alhazen {

namespace {

/// Margin, relative to the size of the scene and the distance of the origin, for the error of a
/// box's plane: seven roundings and that of the time (the change, its product with the time, the
/// sum; the inverse, its product with the origin, that with the plane, the difference), each by
/// 2^-24 of at most 2 (1 + distance).
constexpr double kMargin = 0x1p-20;
/// Margin, relative to the offset of the frame, for the rounding of local coordinates and of the
/// tests in double.
constexpr double kExactMargin = 0x1p-38;
/// Lower bound of a direction's components relative to the largest one.
constexpr double kLeastDirection = 0x1p-60;
/// Rays from farther away, or with another scale, enter every box, as exponents could leave the
/// range of float.
constexpr double kFarthest = 0x1p40;
constexpr double kLeastScale = 1e-200, kMostScale = 1e200;
/// A coordinate far outside of the frame, and well below kNowhere.
constexpr float kOutside = 1e20f;
/// Larger coordinates count as unbounded.
constexpr double kReach = 1e150;

/// A box from here to its negative is met by no ray. Finite, because it is interpolated.
constexpr float kNowhere = 1e30f;

/// A node of the binary tree with its boxes at shutter open and close.
struct EndBoxes {
    FloatBox open, close;
    void include(const EndBoxes& b) {
        open.include(b.open);
        close.include(b.close);
    }
};

/// Converts the binary tree to wide nodes.
class Collapse {
  public:
    Collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
             std::span<const EndBoxes> things)
        : binary_(binary), references_(references), things_(things), boxes_(binary.index_count) {
        find_boxes(0);
    }

    std::vector<MotionBvh::Node> run(std::uint32_t leaf_bit) {
        struct Open {
            std::uint32_t binary, wide;
        };
        std::vector<MotionBvh::Node> nodes(1);
        std::vector<Open> open{{0, 0}};
        while (!open.empty()) {
            const Open next = open.back();
            open.pop_back();
            const std::vector<std::uint32_t> children = opened(next.binary);
            for (std::size_t c = 0; c < MotionBvh::kWidth; ++c) {
                if (c >= children.size()) {
                    set_no_child(nodes[next.wide], c);
                    continue;
                }
                const BinaryNode& node = binary_.nodes[children[c]];
                std::uint32_t child = references_[node.begin].id | leaf_bit;
                if (!node.is_leaf()) {
                    child = static_cast<std::uint32_t>(nodes.size());
                    nodes.emplace_back();
                    open.push_back({children[c], child});
                }
                set_child(nodes[next.wide], c, boxes_[children[c]], child);
            }
        }
        return nodes;
    }

  private:
    /// Recursive; the builder bounds the depth.
    const EndBoxes& find_boxes(std::uint32_t index) {
        const BinaryNode& node = binary_.nodes[index];
        EndBoxes box;
        if (node.is_leaf()) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                box.include(things_[references_[i].id]);
            }
        } else {
            box = find_boxes(index + 1);
            box.include(find_boxes(node.right));
        }
        return boxes_[index] = box;
    }

    [[nodiscard]] float area(std::uint32_t index) const {
        float d[3];
        const EndBoxes& b = boxes_[index];
        for (std::size_t k = 0; k < 3; ++k) {
            d[k] = 0.5f * (b.open.hi[k] - b.open.lo[k] + b.close.hi[k] - b.close.lo[k]);
        }
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }

    /// Descendants of a node, up to the width, by repeatedly opening the largest.
    [[nodiscard]] std::vector<std::uint32_t> opened(std::uint32_t root) const {
        std::vector<std::uint32_t> children{root};
        while (children.size() < MotionBvh::kWidth) {
            auto largest = children.end();
            for (auto i = children.begin(); i != children.end(); ++i) {
                if (binary_.nodes[*i].is_leaf()) continue;
                if (largest == children.end() || area(*i) > area(*largest)) largest = i;
            }
            if (largest == children.end()) break;
            const std::uint32_t node = *largest;
            *largest = node + 1;
            children.push_back(binary_.nodes[node].right);
        }
        return children;
    }

    static void set_child(MotionBvh::Node& node, std::size_t c, const EndBoxes& box,
                          std::uint32_t child) {
        for (std::size_t k = 0; k < 3; ++k) {
            node.open[0][k][c] = box.open.lo[k];
            node.open[1][k][c] = box.open.hi[k];
            node.change[0][k][c] = box.close.lo[k] - box.open.lo[k];
            node.change[1][k][c] = box.close.hi[k] - box.open.hi[k];
        }
        node.child[c] = child;
    }

    static void set_no_child(MotionBvh::Node& node, std::size_t c) {
        for (std::size_t k = 0; k < 3; ++k) {
            node.open[0][k][c] = kNowhere;
            node.open[1][k][c] = -kNowhere;
            node.change[0][k][c] = node.change[1][k][c] = 0.0f;
        }
        node.child[c] = 0;
    }

    const BinaryBvh& binary_;
    std::span<const BuildReference> references_;
    std::span<const EndBoxes> things_;
    std::vector<EndBoxes> boxes_;  ///< [binary node]
};

bool is_bounded(const MovingBox& box) {
    for (const Box3* end : {&box.at_open, &box.at_close}) {
        const double reach = std::max(max_component(abs(end->lo)), max_component(abs(end->hi)));
        if (!(reach <= kReach)) return false;
    }
    return true;
}

}  // namespace

MotionBvh::MotionBvh(std::span<const MovingBox> boxes) {
    Box3 all;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty()) continue;
        if (is_bounded(boxes[i])) {
            all.include(boxes[i].swept());
        } else {
            unbounded_.push_back(i);
        }
    }
    if (all.empty()) return;
    traversals_ = motion_bvh_traversals();
    frame_ = LocalFrame(all);
    std::vector<EndBoxes> things(boxes.size());
    std::vector<BuildReference> references;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (boxes[i].empty() || !is_bounded(boxes[i])) continue;
        things[i] = {frame_.local(boxes[i].at_open), frame_.local(boxes[i].at_close)};
        references.emplace_back(frame_.local(boxes[i].at(0.5)), i, 0);
    }
    const BinaryBvh binary = build_binary(references, LeafKinds{});
    nodes_ = Collapse(binary, references, things).run(kLeafBit);
}

MotionBvh::RaySlabs MotionBvh::slabs(const Ray& ray, double time) const {
    RaySlabs slabs;
    slabs.time = static_cast<float>(time);
    const Vec3 origin = frame_.local(ray.origin);
    const double away = max_component(abs(origin)), largest = max_component(abs(ray.direction));
    slabs.scale = frame_.scale * largest;
    if (!(away <= kFarthest && slabs.scale >= kLeastScale && slabs.scale <= kMostScale)) {
        for (std::size_t k = 0; k < 3; ++k) {
            slabs.inverse[k] = 1.0f;
            slabs.near[k] = kOutside;
            slabs.far[k] = -kOutside;
            slabs.near_side[k] = 0;
        }
        slabs.t_min = -std::numeric_limits<float>::infinity();
        slabs.scale = std::numeric_limits<double>::quiet_NaN();
        return slabs;
    }
    const double margin = kMargin * (1.0 + away) + kExactMargin * frame_.offset;
    slabs.t_min = round_down(slabs.scale * ray.t_min);
    for (int k = 0; k < 3; ++k) {
        const double d = ray.direction[k];
        const double inverse = std::abs(d) >= kLeastDirection * largest
                                   ? largest / d
                                   : std::copysign(1.0 / kLeastDirection, d);
        const double aside = std::copysign(margin, d);
        slabs.near_side[k] = std::signbit(d);  // as copysign: -0 points down
        slabs.inverse[k] = static_cast<float>(inverse);
        slabs.near[k] = static_cast<float>((origin[k] + aside) * inverse);
        slabs.far[k] = static_cast<float>((origin[k] - aside) * inverse);
    }
    return slabs;
}

}  // namespace alhazen
