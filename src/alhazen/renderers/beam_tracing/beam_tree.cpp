#include "alhazen/renderers/beam_tracing/beam_tree.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "alhazen/base/overloaded.h"
#include "alhazen/cameras/projection.h"
#include "alhazen/renderers/core/refraction.h"

namespace alhazen {

namespace {

/// Apex of the shadow beams to a light.
BeamApex apex_of(const Light& light) {
    return std::visit(Overloaded{[](const AmbientLight&) { return BeamApex{}; },
                                 [](const DirectionalLight& l) {
                                     return BeamApex{l.to_light, 0};
                                 },
                                 [](const PointLight& l) {
                                     return BeamApex{l.position, 1};
                                 },
                                 [](const SpotLight& l) {
                                     return BeamApex{l.position, 1};
                                 },
                                 [](const AreaLight& l) {
                                     return BeamApex{l.surface->center(), 1};
                                 }},
                      light);
}

/// Upper bounds of a material's reflection and transmission, independent of the point.
struct BeamMaterial {
    Rgb reflects, passes;
    double index = 1;
    bool thin = false;
};

BeamMaterial beam_material(const Scene& scene, MaterialId id) {
    const Material& material = scene.materials[static_cast<std::size_t>(id)];
    const MaterialSample sample = evaluate(material, scene.textures, Vec2{0.5, 0.5});
    BeamMaterial result{sample.reflective, sample.transmissive, sample.index, sample.thin};
    if (material.metallic_roughness) {
        if (!sample.unlit) result.reflects = {1, 1, 1};
        if (material.metallic_roughness->transmission.value > 0.0) result.passes = {1, 1, 1};
    } else {
        if (material.reflective.texture != kNoTexture) result.reflects = material.reflective.color;
        if (material.transmissive.texture != kNoTexture) {
            result.passes = material.transmissive.color;
        }
    }
    return result;
}

class BeamTreeMaker {
  public:
    BeamTreeMaker(const RenderJob& job, const BeamScene& scene, const BeamTreeOptions& options)
        : job_(job), scene_(scene), options_(options), eye_(job.camera) {
        for (std::size_t k = 0; k < job.scene.materials.size(); ++k) {
            materials_.push_back(
                beam_material(job.scene, MaterialId{static_cast<std::uint32_t>(k)}));
        }
        tree_.beams_of_kind.resize(kRayKindCount);
    }

    BeamTree make(const PolygonSet& region) {
        BeamNode eye;
        eye.view = eye_view(job_.camera);
        std::vector<PolygonSet> regions{region};
        tree_.beams.push_back(std::move(eye));
        std::size_t first = 0;
        while (first < tree_.beams.size() && !job_.stop_requested()) {
            const std::size_t end = tree_.beams.size();
            const std::size_t first_piece = tree_.pieces.size();
            const std::uint64_t before = tests();
            see(first, regions);
            std::vector<std::vector<BeamNode>> onward = finish_pieces(first_piece);
            // A beam that leaves a piece of the eye is as large as that, but sees several pieces.
            const double alike = first == 0 ? double(onward.size()) / 3 : double(end - first);
            keep_most(double(tests() - before) / alike, onward);
            regions = add_beams(onward);
            first = end;
        }
        return std::move(tree_);
    }

  private:
    /// Finds the pieces of the beams from `first` on.
    void see(std::size_t first, std::vector<PolygonSet>& regions) {
        std::vector<std::vector<SeenFacet>> seen(regions.size());
        in_parallel(regions.size(), [&](BeamCaster& caster, std::size_t k) {
            caster.see(tree_.beams[first + k].view, std::move(regions[k]), seen[k]);
        });
        for (std::size_t k = 0; k < seen.size(); ++k) {
            const auto beam = static_cast<std::uint32_t>(first + k);
            ++tree_.beams_of_kind[static_cast<std::size_t>(tree_.beams[beam].view.kind)];
            for (SeenFacet& s : seen[k]) tree_.pieces.push_back({beam, std::move(s), {}});
        }
    }

    /// Hulls that all beams have tested.
    [[nodiscard]] std::uint64_t tests() const {
        return tree_.counts.seen.hulls + tree_.counts.shadow.hulls;
    }

    /// Computes the lit parts of the pieces. Returns the beams that leave them [piece].
    std::vector<std::vector<BeamNode>> finish_pieces(std::size_t first) {
        const std::size_t count = tree_.pieces.size() - first;
        std::vector<std::vector<BeamNode>> onward(count);
        in_parallel(count, [&](BeamCaster& caster, std::size_t k) {
            BeamPiece& piece = tree_.pieces[first + k];
            if (piece.seen.facet == kNoFacet) return;
            light(caster, piece);
            leave(static_cast<std::uint32_t>(first + k), onward[k]);
        });
        return onward;
    }

    /// Adds beams to the tree; returns their regions.
    std::vector<PolygonSet> add_beams(std::vector<std::vector<BeamNode>>& onward) {
        std::vector<PolygonSet> regions;
        for (std::vector<BeamNode>& nodes : onward) {
            for (BeamNode& node : nodes) {
                regions.push_back(tree_.pieces[node.piece].seen.region);
                tree_.beams.push_back(std::move(node));
            }
        }
        return regions;
    }

    /// Keeps as many beams as the limit of tests permits if they test as many hulls each as those
    /// of this generation: `each`.
    void keep_most(double each, std::vector<std::vector<BeamNode>>& onward) {
        const std::uint64_t most = options_.most_tests;
        if (most == 0) return;
        std::vector<std::pair<double, std::size_t>> weights;  // of the beams, with their places
        for (const std::vector<BeamNode>& nodes : onward) {
            for (const BeamNode& node : nodes) {
                const auto area =
                    static_cast<double>(twice_area(tree_.pieces[node.piece].seen.region));
                weights.emplace_back(-area * node.contribution.max(), weights.size());
            }
        }
        if (weights.empty()) return;
        const std::uint64_t left = most - std::min(most, tests());
        const auto kept = static_cast<std::size_t>(double(left) / std::max(each, 1.0));
        if (weights.size() <= kept) return;
        std::sort(weights.begin(), weights.end());
        std::vector<bool> keeps(weights.size(), false);
        for (std::size_t k = 0; k < kept; ++k) keeps[weights[k].second] = true;
        tree_.left_out += weights.size() - kept;
        std::size_t place = 0;
        for (std::vector<BeamNode>& nodes : onward) {
            std::erase_if(nodes, [&](const BeamNode&) { return !keeps[place++]; });
        }
    }

    void in_parallel(std::size_t count, const std::function<void(BeamCaster&, std::size_t)>& work) {
        std::mutex mutex;
        parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
            BeamCaster caster(scene_, options_.cast);
            for (std::size_t k = begin; k < end && !job_.stop_requested(); ++k) work(caster, k);
            const std::lock_guard lock(mutex);
            tree_.counts += caster.counts();
        });
    }

    void light(BeamCaster& caster, BeamPiece& piece) const {
        using ShadowTint = ShadingConventions::ShadowTint;
        const ShadowTint tint = job_.scene.conventions.shading.shadow_tint;
        const BeamView& view = tree_.beams[piece.beam].view;
        const FacetPlane& plane = scene_.plane(piece.seen.facet);
        const bool smooth = scene_.sources[scene_.facets[piece.seen.facet].source].smooth;
        for (std::uint32_t k = 0; k < job_.scene.lights.size(); ++k) {
            if (!illuminates(job_.scene.lights[k])) continue;
            const BeamApex apex = apex_of(job_.scene.lights[k]);
            const bool faces = (apex.side(plane) > 0.0) == (view.apex.side(plane) > 0.0);
            if (!faces && !smooth) continue;
            if (tint == ShadowTint::None) {
                piece.lights.push_back({k, {piece.seen.region, {}}});
                continue;
            }
            for (LitPart& part : caster.lit(view, piece.seen, apex, tint == ShadowTint::Opaque)) {
                piece.lights.push_back({k, std::move(part)});
            }
        }
    }

    [[nodiscard]] BeamMaterial material_of(std::uint32_t facet) const {
        const BeamFacet& f = scene_.facets[facet];
        const BeamSource& source = scene_.sources[f.source];
        if (source.shape || source.mesh.mesh->vertex_materials.empty()) {
            return materials_[static_cast<std::size_t>(source.material)];
        }
        BeamMaterial result;
        const TriangleMesh& mesh = *source.mesh.mesh;
        for (std::size_t k = 0; k < 3; ++k) {
            const BeamMaterial& m = materials_[mesh.vertex_materials[mesh.triangles[f.part][k]]];
            const auto most = [](const Rgb& a, const Rgb& b) {
                return Rgb{std::max(a.r, b.r), std::max(a.g, b.g), std::max(a.b, b.b)};
            };
            result.reflects = most(result.reflects, m.reflects);
            result.passes = most(result.passes, m.passes);
            if (k == 0) result.index = m.index;
            if (k == 0) result.thin = m.thin;
        }
        return result;
    }

    void leave(std::uint32_t number, std::vector<BeamNode>& onward) const {
        const ShadingConventions& conventions = job_.scene.conventions.shading;
        const BeamPiece& piece = tree_.pieces[number];
        const BeamNode& beam = tree_.beams[piece.beam];
        if (beam.depth >= conventions.max_depth) return;
        const double share =
            static_cast<double>(twice_area(piece.seen.region)) / (8.0 * kBeamFilm * kBeamFilm);
        if (share < options_.least_area) return;
        const BeamMaterial material = material_of(piece.seen.facet);
        const double least = std::max(conventions.min_contribution, options_.least_contribution);
        const auto goes_on = [&](const Rgb& by) {
            return !by.is_black() && (beam.contribution * by).max() >= least;
        };
        BeamNode next;
        next.piece = number;
        next.depth = beam.depth + 1;
        next.view.from = piece.seen.facet;
        next.view.has_start = true;
        const FacetPlane& outer = scene_.plane(piece.seen.facet);
        const bool outside = beam.view.apex.side(outer) > 0.0;
        const FacetPlane plane = outside ? outer : outer.reversed();
        if (conventions.trace_reflections && goes_on(material.reflects)) {
            BeamNode mirrored = next;
            mirrored.view.kind = RayKind::Reflection;
            mirrored.view.start = plane;
            mirrored.contribution = beam.contribution * material.reflects;
            mirrored.inside = beam.inside;
            map_space(beam, SpaceMap::mirror(plane), SpaceMap::mirror(plane), mirrored);
            onward.push_back(std::move(mirrored));
        }
        double factor = 1.0;
        if (conventions.trace_refractions && goes_on(material.passes) &&
            (material.thin || refracts(piece, beam, plane, outside, material.index, factor))) {
            BeamNode refracted = next;
            refracted.view.kind = RayKind::Refraction;
            refracted.view.start = plane.reversed();
            refracted.contribution = beam.contribution * material.passes;
            refracted.inside = material.thin ? beam.inside : outside;
            map_space(beam, SpaceMap::stretch(plane, factor),
                      SpaceMap::stretch(plane, 1.0 / factor), refracted);
            onward.push_back(std::move(refracted));
        }
    }

    static void map_space(const BeamNode& beam, const SpaceMap& map, const SpaceMap& inverse,
                          BeamNode& next) {
        next.view.projection = beam.view.projection.after(map);
        next.view.apex = inverse(beam.view.apex);
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) {
                next.back.m[i][j] = 0.0;
                for (std::size_t k = 0; k < 4; ++k) {
                    next.back.m[i][j] += inverse.m[i][k] * beam.back.m[k][j];
                }
            }
        }
    }

    /// Stretch of space along the normal behind the plane, for the ray through the middle of the
    /// piece; false if that ray is totally reflected or the factor is too large.
    [[nodiscard]] bool refracts(const BeamPiece& piece, const BeamNode& beam,
                                const FacetPlane& plane, bool outside, double index,
                                double& factor) const {
        const LatticeBox& box = piece.seen.region.bounds();
        const Ray ray =
            space_ray(beam.back, window_ray(eye_, {0.5 * (double(box.lo.x) + box.hi.x),
                                                   0.5 * (double(box.lo.y) + box.hi.y)}));
        const double air = job_.scene.conventions.shading.air_index;
        const double eta = outside ? air / index : index / air;
        Vec3 direction;
        if (!refract(ray.direction, plane.normal, eta, direction)) return false;
        const auto tangent = [&](const Vec3& d) {
            return length(cross(d, plane.normal)) / std::abs(dot(d, plane.normal));
        };
        const double before = tangent(ray.direction);
        factor = before > 1e-6 ? tangent(direction) / before : eta;
        return factor < 1e3;
    }

    const RenderJob& job_;
    const BeamScene& scene_;
    const BeamTreeOptions& options_;
    EyeRays eye_;
    std::vector<BeamMaterial> materials_;
    BeamTree tree_;
};

}  // namespace

BeamView eye_view(const Camera& camera) {
    if (std::holds_alternative<WideCamera>(camera)) throw flat_pictures_only("beams");
    const PicturePlane frame = picture_plane(camera);
    const bool from_eye = std::holds_alternative<PerspectiveCamera>(camera);
    // p - eye = w * forward + x * right / 2 + y * up / 2, solved by Cramer's rule.
    const Vec3 a = 0.5 * frame.right, b = 0.5 * frame.up, c = frame.forward;
    const double volume = dot(a, cross(b, c));
    const auto row = [&](const Vec3& n, double factor) {
        const Vec3 scaled = (factor / volume) * n;
        return std::array<double, 4>{scaled.x, scaled.y, scaled.z, -dot(scaled, frame.eye)};
    };
    BeamView view;
    view.projection.rows = {row(cross(b, c), kBeamFilm), row(cross(c, a), kBeamFilm),
                            from_eye ? row(cross(a, b), 1.0) : std::array<double, 4>{0, 0, 0, 1}};
    view.apex = from_eye ? BeamApex{frame.eye, 1} : BeamApex{-normalize(frame.forward), 0};
    if (!from_eye) {
        // Parallel rays start in the rectangle of the camera.
        const Vec3 n = normalize(cross(a, b));
        const Vec3 forward = dot(n, c) > 0.0 ? n : -n;
        view.has_start = true;
        view.start = {forward, dot(forward, frame.eye)};
    }
    return view;
}

Ray window_ray(const EyeRays& eye, const Vec2& at) {
    const double x = 0.5 + at.x / (2 * kBeamFilm), y = 0.5 + at.y / (2 * kBeamFilm);
    return eye.ray(eye.column(x) + eye.row(y));
}

Ray space_ray(const SpaceMap& back, const Ray& ray) {
    const BeamApex at = back({ray.origin, 1}), along = back({ray.direction, 0});
    return {at.at / at.weight, normalize(along.at)};
}

BeamTree beam_tree(const RenderJob& job, const BeamScene& scene, const PolygonSet& region,
                   const BeamTreeOptions& options) {
    return BeamTreeMaker(job, scene, options).make(region);
}

}  // namespace alhazen
