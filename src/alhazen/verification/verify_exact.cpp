#include "alhazen/verification/verify_exact.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"
#include "alhazen/verification/exact_solids.h"
#include "alhazen/verification/shared_progress.h"
#include "alhazen/verification/verify_rays.h"

namespace alhazen {

namespace {

constexpr double kEpsilon = 0x1p-53;
/// Limit of the stored solids that are checked; of more, a sample spread over all.
constexpr std::size_t kMostExactSolids = 256;
/// Number of roundings of a ray's own numbers on the way to a crossing.
constexpr double kRayRoundings = 16;

std::string describe_crossings(const std::vector<Hit>& hits) {
    std::string text = fmt::format("{} crossings", hits.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(hits.size(), 6); ++i) {
        text += fmt::format("; t={:.17g}", hits[i].t);
    }
    return text;
}
std::string describe_crossings(const ExactCrossings& crossings) {
    std::string text = fmt::format("{} crossings", crossings.t.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(crossings.t.size(), 6); ++i) {
        text += fmt::format("; t={:.17g}", static_cast<double>(crossings.t[i]));
    }
    return text;
}

class Checker {
  public:
    Checker(const ExactSolid& solid, ExactReport& report) : solid_(solid), report_(report) {
        const Box3 box = solid.aggregate->box();
        reach_ = box.bounded() ? length(Vec3{std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                                             std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
                                             std::max(std::abs(box.lo.z), std::abs(box.hi.z))})
                               : 10.0;
    }

    void check(const VerifyRays::Sample& sample) {
        Ray ray = sample.ray;
        ray.t_min = -kInfinity;
        ray.t_max = kInfinity;
        hits_.clear();
        solid_.aggregate->all_hits(ray, hits_, nullptr);
        const double bound = bound_of(ray);
        const Real128 least = bound / length(ray.direction);
        const ExactLine line{Vec3Of<Real128>(ray.origin), Vec3Of<Real128>(ray.direction)};
        ExactCrossings found;
        found.begins_inside = solid_.begins_inside(ray);
        for (const Hit& hit : hits_) found.t.push_back(hit.t);
        const ExactCrossings truth = solid_.crossings(line, least);
        ++report_.rays;
        report_.crossings += hits_.size();
        switch (compare(found, truth, ray, bound)) {
            case Match::Same:
                break;
            case Match::Grazing:
                ++report_.grazing;
                break;
            case Match::Wrong:
                disagree(sample, "crossings", describe_crossings(hits_), describe_crossings(truth));
        }
        check_points(sample, ray, bound);
    }

  private:
    /// Displacement of the line that explains the crossings found, scene units.
    [[nodiscard]] double bound_of(const Ray& ray) const {
        double largest = 0;
        double t_reach = 0;
        for (const Hit& hit : hits_) {
            largest = std::max(largest, length(surface_at(*solid_.aggregate, ray, hit).error));
            t_reach = std::max(t_reach, std::abs(hit.t) * length(ray.direction));
        }
        const double rounding = kRayRoundings * kEpsilon * (length(ray.origin) + t_reach + reach_);
        const double tolerance = solid_.csg != nullptr ? 4 * solid_.csg->tolerance() : 0.0;
        return 2 * largest + rounding + tolerance;
    }

    enum class Match { Same, Grazing, Wrong };

    /// Compares the two: where they differ about inside and outside for longer than the bound,
    /// points must be nearer to the surface than the bound.
    Match compare(const ExactCrossings& found, const ExactCrossings& truth, const Ray& ray,
                  double bound) {
        const Real128 least = bound / length(ray.direction);
        const Real128 far = 4 * (length(ray.origin) + reach_) / length(ray.direction);
        std::vector<Real128> t{-far, far};
        t.insert(t.end(), found.t.begin(), found.t.end());
        t.insert(t.end(), truth.t.begin(), truth.t.end());
        std::sort(t.begin(), t.end());
        Match match = Match::Same;
        std::vector<ExactCrossings> displaced;
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            const Real128 middle = (t[i] + t[i + 1]) / 2, size = t[i + 1] - t[i];
            const bool inside = found.inside_at(middle);
            if (size == 0 || inside == truth.inside_at(middle)) continue;
            if (!(size > least)) {
                const double share = static_cast<double>(size / least);
                report_.worst_crossing = std::max(report_.worst_crossing, share);
                continue;
            }
            if (displaced.empty()) displaced = displaced_lines(ray, bound);
            for (const double part : {-0.9, 0.0, 0.9}) {
                const Real128 at = middle + part * (size / 2);
                const bool near = std::any_of(
                    displaced.begin(), displaced.end(),
                    [&](const ExactCrossings& other) { return other.inside_at(at) == inside; });
                if (!near) return Match::Wrong;
            }
            match = Match::Grazing;
        }
        return match;
    }

    /// The crossings of lines displaced by the bound in all directions.
    [[nodiscard]] std::vector<ExactCrossings> displaced_lines(const Ray& ray, double bound) const {
        const Vec3 d = unit_or(ray.direction, {0, 0, 1});
        const Vec3 right = perpendicular(d), up = cross(d, right);
        std::vector<ExactCrossings> lines;
        for (int i = 0; i < 16; ++i) {
            const double angle = 0.39269908169872415 * i;
            const Vec3 aside = bound * (std::cos(angle) * right + std::sin(angle) * up);
            const ExactLine line{Vec3Of<Real128>(ray.origin) + Vec3Of<Real128>(aside),
                                 Vec3Of<Real128>(ray.direction)};
            lines.push_back(solid_.crossings(line, 0));
        }
        return lines;
    }

    /// Checks the distance of the points from the true surface along their normals.
    void check_points(const VerifyRays::Sample& sample, const Ray& ray, double line_bound) {
        for (const Hit& hit : hits_) {
            const Surface surface = surface_at(*solid_.aggregate, ray, hit);
            const ExactLine normal{Vec3Of<Real128>(surface.point), Vec3Of<Real128>(surface.normal)};
            const bool is_wall = surface.media.before && surface.media.after;
            const double bound = length(surface.error);
            const double off = static_cast<double>(solid_.nearest(normal, is_wall));
            const double tolerance = solid_.csg != nullptr ? 4 * solid_.csg->tolerance() : 0.0;
            if (off <= bound) {
                report_.worst_point = std::max(report_.worst_point, off / bound);
            } else if (off > bound + tolerance && !is_on_edge(surface, line_bound)) {
                disagree(sample, "error_bound", fmt::format("t={:.17g} off by {:.6g}", hit.t, off),
                         fmt::format("at most {:.6g}", bound));
            }
        }
    }

    /// True if the point is near an edge or a tip. There the normal of one face need not meet any
    /// face, and the point may lie beyond the edge by the ray's error: it is correct if any point
    /// so near is on the surface.
    [[nodiscard]] bool is_on_edge(const Surface& surface, double line_bound) const {
        const bool is_wall = surface.media.before && surface.media.after;
        const Vec3 right = perpendicular(surface.normal), up = cross(surface.normal, right);
        for (const Vec3& along : {surface.normal, right, up}) {
            const Vec3 first = perpendicular(along), second = cross(along, first);
            for (int i = 0; i < 32; ++i) {
                const double angle = 0.78539816339744831 * i;
                const double away = line_bound * (i < 8 ? 1 : i < 16 ? 2 : i < 24 ? 4 : 0.5);
                const Vec3 aside = away * (std::cos(angle) * first + std::sin(angle) * second);
                const ExactLine line{Vec3Of<Real128>(surface.point) + Vec3Of<Real128>(aside),
                                     Vec3Of<Real128>(along)};
                if (solid_.nearest(line, is_wall) <= 16 * line_bound) return true;
            }
        }
        return false;
    }

    void disagree(const VerifyRays::Sample& sample, const char* query, std::string found,
                  std::string expected) {
        ++report_.disagreements;
        if (report_.reported.size() < kMostReported) {
            report_.reported.push_back(
                {sample.kind, query, sample.ray, std::move(found), std::move(expected)});
        }
    }

    const ExactSolid& solid_;
    ExactReport& report_;
    std::vector<Hit> hits_;
    double reach_ = 0;
};

/// Rays of all kinds; every third is nearly tangent to the surface.
class ExactRays {
  public:
    ExactRays(const Aggregate& aggregate, std::uint64_t seed)
        : aggregate_(aggregate),
          usual_(aggregate.box(), nullptr, aggregate.primitives(), seed),
          random_(seed + 99) {}

    VerifyRays::Sample next() {
        if (count_++ % 3 != 0) return usual_.next();
        const VerifyRays::Sample sample = usual_.next();
        Hit hit;
        Ray ray = sample.ray;
        ray.t_min = -kInfinity;
        if (!aggregate_.closest(ray, hit, nullptr)) return sample;
        const Surface surface = surface_at(aggregate_, ray, hit);
        const Vec3 right = perpendicular(surface.normal);
        const double angle = random_.uniform(0, 6.283185307179586);
        const Vec3 along = std::cos(angle) * right + std::sin(angle) * cross(surface.normal, right);
        // Slopes of 0 to a thousandth relative to the tangent.
        const double slope = random_.below(4) == 0 ? 0 : std::pow(10.0, random_.uniform(-17, -3));
        const Vec3 direction = along + slope * surface.normal;
        const double back = random_.below(2) == 0 ? 0 : std::pow(10.0, random_.uniform(-2, 4));
        return {"grazing", {surface.point - back * direction, direction}};
    }

  private:
    const Aggregate& aggregate_;
    VerifyRays usual_;
    RandomStream random_;
    std::uint64_t count_ = 0;
};

/// Adds the results of some rays of one solid.
void add(ExactReport part, ExactReport& report) {
    report.rays += part.rays;
    report.crossings += part.crossings;
    report.grazing += part.grazing;
    report.disagreements += part.disagreements;
    report.worst_crossing = std::max(report.worst_crossing, part.worst_crossing);
    report.worst_point = std::max(report.worst_point, part.worst_point);
    for (Disagreement& one : part.reported) {
        if (report.reported.size() < kMostReported) {
            report.reported.push_back(std::move(one));
        }
    }
}

/// Traces `count` rays at one solid on all cores; the report does not depend on their number.
void check_solid(const ExactSolid& solid, std::uint64_t seed, std::uint64_t count,
                 SharedProgress& progress, ExactReport& report) {
    constexpr std::size_t kRaysOfPart = 64, kMostPartsAtOnce = 256;
    ExactRays rays(*solid.aggregate, seed);
    std::vector<VerifyRays::Sample> samples;
    for (std::uint64_t done = 0; done < count; done += samples.size()) {
        samples.clear();
        while (samples.size() < kRaysOfPart * kMostPartsAtOnce && done + samples.size() < count) {
            samples.push_back(rays.next());
        }
        std::vector<ExactReport> parts((samples.size() + kRaysOfPart - 1) / kRaysOfPart);
        parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t part = begin; part < end; ++part) {
                Checker checker(solid, parts[part]);
                const std::size_t first = part * kRaysOfPart;
                const std::size_t last = std::min(first + kRaysOfPart, samples.size());
                for (std::size_t i = first; i < last; ++i) checker.check(samples[i]);
                progress.add(last - first);
            }
        });
        for (ExactReport& part : parts) add(std::move(part), report);
    }
}

ExactReport check_all(const std::vector<ExactSolid>& all, const VerifyOptions& options) {
    ExactReport report;
    std::vector<const ExactSolid*> checked;
    for (const ExactSolid& solid : all) {
        if (solid.reason.empty()) checked.push_back(&solid);
    }
    const std::size_t count = std::min(checked.size(), kMostExactSolids);
    report.unchecked = all.size() - count;
    report.left_out = checked.size() - count;
    report.solids = count;
    if (count == 0) return report;
    const std::uint64_t share = std::max<std::uint64_t>(100, options.rays / count);
    SharedProgress progress(options.progress, "exact", count * share);
    for (std::size_t i = 0; i < count; ++i) {
        const ExactSolid& solid = *checked[i * checked.size() / count];
        check_solid(solid, options.seed + 7 * i, share, progress, report);
    }
    return report;
}

}  // namespace

ExactReport verify_exact(const SceneDescription& description, const VerifyOptions& options) {
    const Scene scene =
        compile(description, {.accelerator = options.accelerator, .build = options.build});
    const std::vector<ExactSolid> all = exact_solids(scene.aggregate);
    ExactReport report = check_all(all, options);
    report.unchecked_solids = unchecked_solids(all, description, scene);
    report.triangles = scene.census.triangles;
    return report;
}

}  // namespace alhazen
