#include "embree/embree_tree_cost.h"

#include <algorithm>
#include <limits>

namespace alhazen::bench {

namespace {

constexpr unsigned kWidth = 8;

struct Node {
    std::size_t primitives = 0;  ///< in a leaf; 0: inner node
    unsigned children = 0;
    RTCBounds bounds[kWidth];
    Node* child[kWidth];
};

double half_area(const RTCBounds& b) {
    const double x = static_cast<double>(b.upper_x) - static_cast<double>(b.lower_x);
    const double y = static_cast<double>(b.upper_y) - static_cast<double>(b.lower_y);
    const double z = static_cast<double>(b.upper_z) - static_cast<double>(b.lower_z);
    return x * y + y * z + z * x;
}

RTCBounds nothing() {
    const float inf = std::numeric_limits<float>::infinity();
    return {inf, inf, inf, 0, -inf, -inf, -inf, 0};
}

void include(RTCBounds& b, const Vec3& p) {
    const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y),
               z = static_cast<float>(p.z);
    b.lower_x = std::min(b.lower_x, x);
    b.lower_y = std::min(b.lower_y, y);
    b.lower_z = std::min(b.lower_z, z);
    b.upper_x = std::max(b.upper_x, x);
    b.upper_y = std::max(b.upper_y, y);
    b.upper_z = std::max(b.upper_z, z);
}

void clip(RTCBounds& b, const RTCBuildPrimitive& to) {
    b.lower_x = std::max(b.lower_x, to.lower_x);
    b.lower_y = std::max(b.lower_y, to.lower_y);
    b.lower_z = std::max(b.lower_z, to.lower_z);
    b.upper_x = std::min(b.upper_x, to.upper_x);
    b.upper_y = std::min(b.upper_y, to.upper_y);
    b.upper_z = std::min(b.upper_z, to.upper_z);
}

void* create_node(RTCThreadLocalAllocator allocator, unsigned count, void*) {
    Node* node = new (rtcThreadLocalAlloc(allocator, sizeof(Node), 16)) Node;
    node->children = count;
    return node;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) {
        static_cast<Node*>(node)->child[i] = static_cast<Node*>(children[i]);
    }
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<Node*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive*, std::size_t count,
                  void*) {
    Node* node = new (rtcThreadLocalAlloc(allocator, sizeof(Node), 16)) Node;
    node->primitives = count;
    return node;
}

/// Computes the boxes of the parts of a triangle on both sides of a plane.
void split(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
           RTCBounds* right, void* user) {
    const auto& mesh = *static_cast<const TriangleMesh*>(user);
    const auto& triangle = mesh.triangles[primitive->primID];
    *left = *right = nothing();
    const auto at = static_cast<double>(position);
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& a = mesh.positions[triangle[i]];
        const Vec3& b = mesh.positions[triangle[(i + 1) % 3]];
        const double da = a[static_cast<int>(axis)] - at, db = b[static_cast<int>(axis)] - at;
        if (da <= 0) include(*left, a);
        if (da >= 0) include(*right, a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
            const Vec3 crossing = a + (da / (da - db)) * (b - a);
            include(*left, crossing);
            include(*right, crossing);
        }
    }
    clip(*left, *primitive);
    clip(*right, *primitive);
}

double cost_below(const Node& node, std::size_t width, double block_cost) {
    double cost = 0;
    for (unsigned i = 0; i < node.children; ++i) {
        const Node& child = *node.child[i];
        const auto blocks = static_cast<double>((child.primitives + width - 1) / width);
        cost += half_area(node.bounds[i]) * (child.primitives > 0 ? block_cost * blocks : 1.0);
        cost += cost_below(child, width, block_cost);
    }
    return cost;
}

}  // namespace

double embree_tree_cost(const TriangleMesh& mesh, RTCBuildQuality quality, std::size_t width,
                        double block_cost) {
    std::vector<RTCBuildPrimitive> primitives(mesh.triangles.size());
    RTCBounds all = nothing();
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        RTCBounds box = nothing();
        for (const std::uint32_t v : mesh.triangles[i]) {
            include(box, mesh.positions[v]);
            include(all, mesh.positions[v]);
        }
        primitives[i] = {box.lower_x, box.lower_y, box.lower_z, 0,
                         box.upper_x, box.upper_y, box.upper_z, static_cast<unsigned>(i)};
    }
    const std::size_t count = primitives.size();
    primitives.resize(2 * count);  // capacity for spatial splits
    RTCDevice device = rtcNewDevice(nullptr);
    RTCBVH bvh = rtcNewBVH(device);
    RTCBuildArguments args = rtcDefaultBuildArguments();
    args.buildQuality = quality;
    args.maxBranchingFactor = kWidth;
    args.maxDepth = 1024;
    args.sahBlockSize = 4;
    args.minLeafSize = 4;
    args.maxLeafSize = 28;
    args.bvh = bvh;
    args.primitives = primitives.data();
    args.primitiveCount = count;
    args.primitiveArrayCapacity = primitives.size();
    args.createNode = create_node;
    args.setNodeChildren = set_children;
    args.setNodeBounds = set_bounds;
    args.createLeaf = create_leaf;
    args.splitPrimitive = split;
    args.userPtr = const_cast<TriangleMesh*>(&mesh);
    const auto* root = static_cast<const Node*>(rtcBuildBVH(&args));
    const double cost =
        root == nullptr ? 0 : 1.0 + cost_below(*root, width, block_cost) / half_area(all);
    rtcReleaseBVH(bvh);
    rtcReleaseDevice(device);
    return cost;
}

}  // namespace alhazen::bench
