#include "solid_queries.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/base/stopwatch.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/solids/measure_report.h"
#include "alhazen/solids/section_outlines.h"
#include "array_making.h"
#include "interruptible.h"
#include "ray_array.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

/// More solids are measured only if named.
constexpr std::uint64_t kMostSolids = 64;

/// Finds the solids on first use; Ctrl-C ends the search.
const SolidScene& found_solids(const BuiltScene& scene) {
    if (const SolidScene* found = scene.found_solids()) return *found;
    run_interruptible([&] { static_cast<void>(scene.solids()); });
    return scene.solids();
}

/// A list of items for each of `count` rays or points, concatenated.
template <class Item>
class Lists {
  public:
    explicit Lists(std::size_t count) : items_(count) {}

    std::vector<Item>& operator[](std::size_t i) { return items_[i]; }

    /// The ends of all lists, starting with 0; `ids`: for each item the number of its list.
    [[nodiscard]] std::pair<py::array, py::array> splits_and_ids() const {
        const PlainArray<std::int64_t> splits(length(items_.size() + 1));
        splits[0] = 0;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            splits[i + 1] = splits[i] + static_cast<std::int64_t>(items_[i].size());
        }
        const PlainArray<std::int64_t> ids(length(static_cast<std::size_t>(splits[items_.size()])));
        std::size_t at = 0;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            for (std::size_t k = 0; k < items_[i].size(); ++k) {
                ids[at++] = static_cast<std::int64_t>(i);
            }
        }
        return {splits.array(), ids.array()};
    }
    /// Calls set(i, item) for all items in order.
    template <class Set>
    std::size_t for_each(const Set& set) const {
        std::size_t at = 0;
        for (const auto& list : items_) {
            for (const Item& item : list) set(at++, item);
        }
        return at;
    }
    [[nodiscard]] std::size_t total() const {
        return for_each([](std::size_t, const Item&) {});
    }

  private:
    std::vector<std::vector<Item>> items_;
};

std::vector<SolidId> chosen_solids(const SolidScene& scene, const std::vector<std::string>& words) {
    if (scene.solids().count() == 0) {
        std::string message =
            "the scene has no solid: " + std::to_string(scene.solids().open_surfaces()) +
            " surfaces bound no volume";
        for (const std::string& line : scene.open_meshes()) message += "\n" + line;
        throw Error(ErrorKind::Scene, message);
    }
    if (words.empty() && scene.solids().count() > kMostSolids) {
        throw Error(ErrorKind::Usage, "the scene has " + std::to_string(scene.solids().count()) +
                                          " solids: name those to measure");
    }
    return scene.select(words);
}

}  // namespace

py::dict spans(const BuiltScene& scene, const py::object& rays_object, int threads) {
    const RayArray rays(rays_object);
    const SolidQueries& queries = found_solids(scene).queries();
    Lists<SolidSpan> lists(rays.count());
    run_in_blocks(rays.count(), threads, [&](std::size_t begin, std::size_t end) {
        thread_local std::vector<Ray> scratch;
        thread_local SpanList list;
        const std::span<const Ray> range = rays.rays(begin, end, scratch);
        for (std::size_t i = 0; i < range.size(); ++i) {
            queries.spans(range[i], list);
            lists[begin + i] = list.spans;
        }
    });
    const std::size_t total = lists.total();
    const PlainArray<std::uint64_t> solids(length(total));
    const RealArray enter(rays.single(), length(total), 0), exit(rays.single(), length(total), 0);
    lists.for_each([&](std::size_t i, const SolidSpan& span) {
        solids[i] = static_cast<std::uint64_t>(span.solid);
        enter.set(i, span.entry.t);
        exit.set(i, span.exit.t);
    });
    const auto [splits, ids] = lists.splits_and_ids();
    py::dict result;
    result["ray_splits"] = splits;
    result["ray_ids"] = ids;
    result["solid_ids"] = solids.array();
    result["t_enter"] = enter.array();
    result["t_exit"] = exit.array();
    return result;
}

py::object thickness(const BuiltScene& scene, const py::object& rays_object, int threads) {
    const RayArray rays(rays_object);
    const SolidQueries& queries = found_solids(scene).queries();
    const RealArray result(rays.single(), rays.shape(), 0);
    run_in_blocks(rays.count(), threads, [&](std::size_t begin, std::size_t end) {
        thread_local std::vector<Ray> scratch;
        thread_local SpanList list;
        const std::span<const Ray> range = rays.rays(begin, end, scratch);
        for (std::size_t i = 0; i < range.size(); ++i) {
            result.set(begin + i, queries.thickness(range[i], list).inside_any);
        }
    });
    return result.array();
}

py::object inside(const BuiltScene& scene, const py::object& points_object, int threads) {
    const NumberArray points(points_object, {3}, "points");
    const SolidQueries& queries = found_solids(scene).queries();
    const PlainArray<bool> result(points.shape());
    run_in_blocks(points.count(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            result[i] = !queries.inside(points.vector(i, 0)).empty();
        }
    });
    return result.array();
}

py::dict solids_at(const BuiltScene& scene, const py::object& points_object, int threads) {
    const NumberArray points(points_object, {3}, "points");
    const SolidQueries& queries = found_solids(scene).queries();
    Lists<Containment> lists(points.count());
    run_in_blocks(points.count(), threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) lists[i] = queries.inside(points.vector(i, 0));
    });
    const std::size_t total = lists.total();
    const PlainArray<std::uint64_t> solids(length(total));
    const PlainArray<bool> on_surface(length(total));
    lists.for_each([&](std::size_t i, const Containment& c) {
        solids[i] = static_cast<std::uint64_t>(c.solid);
        on_surface[i] = c.on_surface;
    });
    const auto [splits, ids] = lists.splits_and_ids();
    py::dict result;
    result["point_splits"] = splits;
    result["point_ids"] = ids;
    result["solid_ids"] = solids.array();
    result["on_surface"] = on_surface.array();
    return result;
}

std::vector<std::string> solid_names(const BuiltScene& scene) {
    const SolidScene& solids = found_solids(scene);
    const std::uint64_t count = solids.solids().count();
    constexpr std::uint64_t kMostNames = 1'000'000;
    if (count > kMostNames) {
        throw Error(ErrorKind::Resource, "the scene has " + std::to_string(count) +
                                             " solids; at most " + std::to_string(kMostNames) +
                                             " are listed");
    }
    std::vector<std::string> names;
    for (std::uint64_t i = 0; i < count; ++i) names.push_back(solids.name(SolidId{i}));
    return names;
}

std::string measure_json(const BuiltScene& scene, const std::vector<std::string>& words,
                         double error, double seconds, std::uint64_t seed, int threads) {
    const SolidScene& solids = found_solids(scene);
    const std::vector<SolidId> chosen = chosen_solids(solids, words);
    StopFlag stop;
    MeasureReport report;
    report.open_surfaces = solids.solids().open_surfaces();
    report.open_meshes = solids.open_meshes();
    const MeasureOptions options{.relative_error = error, .seconds = seconds, .seed = seed};
    run_watched(stop, py::none(), [&](ProgressSink&) {
        const Interruptible ends(&stop);
        ThreadLimit(threads).run([&] {
            for (const SolidId id : chosen) {
                interruption_point();
                const Stopwatch time;
                SolidReport one{.solid = id, .name = solids.name(id)};
                one.measures = measure(IsolatedSolid(solids.solids(), id), options);
                one.densities = solids.densities(id);
                one.seconds = time.seconds();
                report.solids.push_back(std::move(one));
            }
        });
    });
    return alhazen::measure_json(report).dump(-1, ' ', false,
                                              nlohmann::ordered_json::error_handler_t::replace);
}

py::list section(const BuiltScene& scene, const Vec3& normal, double offset,
                 const std::vector<std::string>& words, double tolerance, int cells, int threads) {
    const SolidScene& solids = found_solids(scene);
    const std::vector<SolidId> chosen = chosen_solids(solids, words);
    const PlaneFrame frame = frame_of({normal, offset});
    const OutlineOptions options{.cells = cells, .tolerance = tolerance};
    std::vector<SectionOutlines> cuts(chosen.size());
    StopFlag stop;
    run_watched(stop, py::none(), [&](ProgressSink&) {
        const Interruptible ends(&stop);
        ThreadLimit(threads).run([&] {
            for (std::size_t i = 0; i < chosen.size(); ++i) {
                interruption_point();
                cuts[i] = trace_section(IsolatedSolid(solids.solids(), chosen[i]), frame, options);
            }
        });
    });
    py::list result;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        if (cuts[i].loops.empty()) continue;
        py::list loops, points;
        for (const Polyline& loop : cuts[i].loops) {
            const PlainArray<double> flat({static_cast<py::ssize_t>(loop.size()), 2});
            const RealArray placed(false, length(loop.size()), 3);
            for (std::size_t k = 0; k < loop.size(); ++k) {
                flat[2 * k] = loop[k].x;
                flat[2 * k + 1] = loop[k].y;
                placed.set(k, frame.origin + loop[k].x * frame.right + loop[k].y * frame.up);
            }
            loops.append(flat.array());
            points.append(placed.array());
        }
        py::dict cut;
        cut["solid"] = static_cast<std::uint64_t>(chosen[i]);
        cut["name"] = solids.name(chosen[i]);
        cut["loops"] = loops;
        cut["points"] = points;
        cut["area"] = cuts[i].area();
        cut["unresolved"] = cuts[i].unresolved;
        result.append(cut);
    }
    return result;
}

}  // namespace alhazen::python
