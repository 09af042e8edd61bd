#include "alhazen/formats/rib/rib_interpreter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "alhazen/formats/core/homogeneous_matrix.h"
#include "alhazen/formats/rib/rib_camera.h"
#include "alhazen/formats/rib/rib_geometry.h"

namespace alhazen {

namespace {

constexpr std::size_t kMaxRibNesting = 10'000;
constexpr std::size_t kMaxListedRequests = 40;

class RibInterpreter {
  public:
    RibInterpreter(const ImportSource& source, SceneDescription& description,
                   Diagnostics& diagnostics)
        : file_(source.path.string()),
          reader_(source.bytes, file_, diagnostics),
          scene_(source, description, diagnostics) {}

    void run() {
        while (scene_.errors() < 50 && reader_.read(request_)) carry_out();
        if (!blocks_.empty()) {
            scene_.error(blocks_.back().place,
                         std::string(blocks_.back().name) + "Begin has no end");
        }
        if (!ignored_.empty()) {
            std::string names;
            for (const std::string& name : ignored_) names += (names.empty() ? "" : ", ") + name;
            scene_.warning(first_ignored_, "ignored: " + names);
        }
        scene_.finish();
    }

  private:
    struct Block {
        std::string_view name;  ///< "Attribute" of AttributeBegin
        RibPlace place;
        RibState state;
    };
    using Action = void (RibInterpreter::*)();
    struct Known {
        std::string_view name;
        Action action;
    };

    void carry_out() {
        if (skipped_world_ && request_.name != "WorldEnd") return;
        if (in_motion_ && request_.name != "MotionEnd" && motion_requests_++ > 0) return;
        static constexpr std::array kKnown{
            Known{"Translate", &RibInterpreter::translate},
            Known{"Rotate", &RibInterpreter::rotate},
            Known{"Scale", &RibInterpreter::scale},
            Known{"Skew", &RibInterpreter::skew},
            Known{"Identity", &RibInterpreter::identity},
            Known{"Transform", &RibInterpreter::transform},
            Known{"ConcatTransform", &RibInterpreter::transform},
            Known{"Color", &RibInterpreter::color},
            Known{"Basis", &RibInterpreter::basis},
            Known{"ReverseOrientation", &RibInterpreter::reverse},
            Known{"Orientation", &RibInterpreter::orientation},
            Known{"TrimCurve", &RibInterpreter::trims},
            Known{"Attribute", &RibInterpreter::attribute},
            Known{"ObjectInstance", &RibInterpreter::instance},
            Known{"MotionBegin", &RibInterpreter::motion_begin},
            Known{"MotionEnd", &RibInterpreter::motion_end},
        };
        const auto* known = std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& entry) {
            return entry.name == request_.name;
        });
        if (known != kKnown.end()) {
            (this->*known->action)();
        } else if (!block() && !view() && !read_rib_geometry(request_, state_, scene_)) {
            ignore(std::string(request_.name));
        }
    }

    /// Executes a request of a pair NAMEBegin, NAMEEnd.
    bool block() {
        static constexpr std::array<std::string_view, 5> kBlocks{"Attribute", "Transform", "World",
                                                                 "Frame", "Object"};
        for (const std::string_view name : kBlocks) {
            if (!request_.name.starts_with(name)) continue;
            const std::string_view rest = request_.name.substr(name.size());
            if (rest == "Begin") begin(name);
            if (rest == "End") end(name);
            if (rest == "Begin" || rest == "End") return true;
        }
        return false;
    }
    void begin(std::string_view name) {
        if (name == "World" && !begin_world()) return;
        if (blocks_.size() >= kMaxRibNesting) {
            throw Error(ErrorKind::Resource,
                        "blocks are nested deeper than " + std::to_string(kMaxRibNesting),
                        location());
        }
        blocks_.push_back({name, request_.place, state_});
        if (name == "World") state_.transform = {};
        if (name != "Object") return;
        const std::string object = handle();
        if (object.empty() || !scene_.begin_object(object, request_.place)) {
            fail("expected a number or name, outside of other objects");
        }
        state_.transform = {};
        state_.inherits_color = true;
    }
    void end(std::string_view name) {
        if (name == "World" && skipped_world_) {
            skipped_world_ = false;
            return;
        }
        if (blocks_.empty() || blocks_.back().name != name) {
            fail(blocks_.empty()
                     ? "no block is open"
                     : "the open block is " + std::string(blocks_.back().name) + "Begin of line " +
                           std::to_string(blocks_.back().place.line));
            return;
        }
        if (name == "Object") (void)scene_.end_object();
        if (name == "Transform") {
            state_.transform = blocks_.back().state.transform;
        } else {
            state_ = std::move(blocks_.back().state);
        }
        blocks_.pop_back();
    }
    /// Begins a world; false for all but the first.
    bool begin_world() {
        if (std::exchange(had_world_, true)) {
            scene_.warning(request_.place, "only the first world of the file is read");
            skipped_world_ = true;
            return false;
        }
        camera_.add(state_.transform, location(), scene_.description());
        return true;
    }
    /// The number or name of an object.
    [[nodiscard]] std::string handle() const {
        if (const std::string* name = request_.string(0)) return *name;
        const std::optional<double> number = request_.number(0);
        if (!number || !(std::abs(*number) < 1e15)) return {};
        return std::to_string(static_cast<std::int64_t>(*number));
    }
    void instance() {
        if (!scene_.add_instance(state_, handle(), request_.place)) fail("there is no such object");
    }

    bool view() {
        std::string problem;
        if (!camera_.read(request_, problem)) return false;
        if (!problem.empty()) fail(problem);
        if (request_.name == "Projection") state_.transform = {};
        return true;
    }

    // --- Transforms.

    template <std::size_t N>
    bool numbers(std::array<double, N>& out) {
        if (request_.numbers.size() != N || !request_.strings.empty()) {
            fail("expected " + std::to_string(N) + " numbers, found " +
                 std::to_string(request_.numbers.size()));
            return false;
        }
        std::copy(request_.numbers.begin(), request_.numbers.end(), out.begin());
        return true;
    }
    void concat(const Affine& more) {
        const Affine product = state_.transform * more;
        if (is_invertible(product)) {
            state_.transform = product;
        } else {
            fail("the transform has no inverse");
        }
    }
    void translate() {
        std::array<double, 3> n{};
        if (numbers(n)) concat(Affine::translate({n[0], n[1], n[2]}));
    }
    void scale() {
        std::array<double, 3> n{};
        if (numbers(n)) concat(Affine::scale({n[0], n[1], n[2]}));
    }
    void rotate() {
        std::array<double, 4> n{};
        if (!numbers(n)) return;
        const Vec3 axis{n[1], n[2], n[3]};
        if (axis == Vec3{}) {
            fail("the axis is zero");
        } else {
            concat(Affine::rotate(axis, n[0] * std::numbers::pi / 180.0));
        }
    }
    /// Moves points along the second axis so that the first one turns towards it by an angle.
    void skew() {
        std::array<double, 7> n{};
        if (!numbers(n)) return;
        const Vec3 turned = unit_or({n[1], n[2], n[3]}, {}),
                   along = unit_or({n[4], n[5], n[6]}, {});
        const double between = std::atan2(length(cross(turned, along)), dot(turned, along));
        const double angle = n[0] * std::numbers::pi / 180.0, sine = std::sin(between);
        if (turned == Vec3{} || along == Vec3{} || !(sine > 1e-9)) {
            return fail("the axes are zero or parallel");
        }
        if (!(angle < between && angle > between - std::numbers::pi)) {
            return fail(
                "the angle must be less than that between the axes, and more than 180 "
                "degrees less than it");
        }
        const double share = std::sin(angle) / (std::sin(between - angle) * sine * sine);
        const Vec3 across = share * (turned - dot(turned, along) * along);
        concat({{Vec3{1, 0, 0} + across.x * along, Vec3{0, 1, 0} + across.y * along,
                 Vec3{0, 0, 1} + across.z * along},
                {}});
    }
    void identity() { state_.transform = {}; }
    /// Reads a matrix for row vectors. Transform replaces the current one within the world.
    void transform() {
        std::array<double, 16> n{}, columns{};
        if (!numbers(n)) return;
        for (std::size_t k = 0; k < 16; ++k) columns[k] = n[k % 4 * 4 + k / 4];
        const HomogeneousMatrix matrix(columns);
        if (matrix.last_row == LastRow::Perspective) {
            fail("the matrix is not affine");
            return;
        }
        if (request_.name == "Transform") state_.transform = {};
        concat(matrix.transform);
    }

    // --- Attributes.

    void color() {
        std::array<double, 3> n{};
        if (!numbers(n)) return;
        for (const double channel : n) {
            if (channel < 0.0) return fail("a colour is not negative");
        }
        state_.color = {n[0], n[1], n[2]};
        state_.inherits_color = false;
    }
    void basis() {
        CubicBasis bases[2];
        int steps[2]{};
        for (std::size_t k = 0; k < 2; ++k) {
            const std::string* name = request_.string(2 * k);
            const std::span<const double> matrix = request_.list(2 * k);
            const std::optional<double> step = request_.number(2 * k + 1);
            std::optional<CubicBasis> found;
            if (name != nullptr) found = CubicBasis::named(*name);
            if (matrix.size() == 16) {
                std::array<double, 16> m{};
                std::copy(matrix.begin(), matrix.end(), m.begin());
                found = CubicBasis(m);
            }
            if (!found || !step || !(*step >= 1 && *step <= 4) || *step != int(*step)) {
                return fail(
                    "expected for u and v a basis (bezier, b-spline, catmull-rom, hermite, power "
                    "or 16 numbers) and a step from 1 to 4");
            }
            bases[k] = *found;
            steps[k] = int(*step);
        }
        state_.basis_u = bases[0];
        state_.basis_v = bases[1];
        state_.step_u = steps[0];
        state_.step_v = steps[1];
    }
    void reverse() { state_.reversed = !state_.reversed; }
    void orientation() {
        const std::string* side = request_.string(0);
        if (side == nullptr) return fail("expected \"outside\", \"inside\", \"lh\" or \"rh\"");
        if (*side == "outside") state_.reversed = false;
        if (*side == "inside") state_.reversed = true;
    }
    void trims() { state_.trims = read_rib_trims(request_, scene_); }
    void attribute() {
        const std::string *what = request_.string(0), *name = request_.string(1);
        if (what == nullptr || *what != "trimcurve") return ignore("Attribute");
        const std::string* sense = request_.string(2);
        if (name != nullptr && name->ends_with("sense") && sense != nullptr) {
            state_.keeps_inside = *sense == "outside";
        }
    }

    void motion_begin() {
        if (in_motion_) return;
        scene_.warning(request_.place, "of a motion block the first request is read");
        in_motion_ = true;
        motion_requests_ = 0;
    }
    void motion_end() { in_motion_ = false; }

    void ignore(const std::string& name) {
        if (ignored_.empty()) first_ignored_ = request_.place;
        if (std::find(ignored_.begin(), ignored_.end(), name) != ignored_.end()) return;
        if (ignored_.size() < kMaxListedRequests) {
            ignored_.push_back(name.substr(0, 40));
        } else if (ignored_.back() != "...") {
            ignored_.emplace_back("...");
        }
    }
    void fail(const std::string& what) {
        scene_.error(request_.place, std::string(request_.name) + ": " + what);
    }
    [[nodiscard]] FileLocation location() const {
        return {file_, request_.place.line, request_.place.column};
    }

    const std::string file_;
    RibRequestReader reader_;
    RibScene scene_;
    RibCamera camera_;
    RibRequest request_;
    RibState state_;
    std::vector<Block> blocks_;
    std::vector<std::string> ignored_;
    RibPlace first_ignored_;
    bool had_world_ = false, skipped_world_ = false;
    bool in_motion_ = false;
    int motion_requests_ = 0;
};

}  // namespace

void interpret_rib(const ImportSource& source, SceneDescription& scene, Diagnostics& diagnostics) {
    RibInterpreter(source, scene, diagnostics).run();
}

}  // namespace alhazen
