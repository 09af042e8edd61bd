#include "alhazen/renderers/lane_carpenter/scan_shading.h"

#include <cmath>

#include "alhazen/imaging/film/finite_mean.h"
#include "alhazen/primitives/placed_surface.h"
#include "alhazen/renderers/lane_carpenter/patch_surface.h"

namespace alhazen {

namespace {

/// The weights of the second and third corner at the intersection of a ray with a triangle's plane.
Hit triangle_hit(const std::array<Vec3, 3>& corners, const Ray& ray) {
    const Vec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
    const Vec3 p = cross(ray.direction, e2);
    const Vec3 s = ray.origin - corners[0];
    const Vec3 q = cross(s, e1);
    const double share = 1.0 / dot(e1, p);
    Hit hit;
    hit.t = share * dot(e2, q);
    hit.u = std::fmin(1.0, std::fmax(0.0, share * dot(s, p)));
    hit.v = std::fmin(1.0 - hit.u, std::fmax(0.0, share * dot(ray.direction, q)));
    return hit;
}

/// The crossing nearest to `t`; false if there is none.
bool nearest_crossing(const AnyShape& shape, const Ray& ray, double t, ShapeHits& hits, Hit& hit) {
    hits.clear();
    std::visit([&](const auto& s) { append_hits(s, ray, hits); }, shape);
    double best = std::numeric_limits<double>::infinity();
    for (const ShapeHit& h : hits) {
        if (std::abs(h.t - t) >= best) continue;
        best = std::abs(h.t - t);
        static_cast<ShapeHit&>(hit) = h;
    }
    return best < std::numeric_limits<double>::infinity();
}

/// Resets optional fields to those before the first hit.
void reset_extras(Surface& surface) {
    surface = Surface{};
}

}  // namespace

ScanShading::ScanShading(const RenderJob& job, const ScanScene& scene, const ScreenView& view,
                         const SampleGrid& grid, double flatness)
    : job_(job),
      scene_(scene),
      view_(view),
      grid_(grid),
      flatness_(flatness),
      eye_(job.camera),
      ambient_(ambient_terms(job.scene.lights)),
      constant_(job.scene),
      depth_(job.camera) {
    for (int i = 0; i < grid.columns() && !grid.several(); ++i) {
        columns_.push_back(eye_.column(grid.film_at(i, 0, 0).x));
    }
    sums_.resize(columns_.size());
    rays_.resize(columns_.size());
}

double ScanShading::distance(double nearness, const Ray& ray) const {
    if (view_.parallel()) return -nearness;
    return 1.0 / (nearness * view_.depth_of(ray.direction));
}

void ScanShading::set_shape(const ScanSource& source, std::uint32_t part, double t,
                            const Ray& ray) {
    const Placement placement{source.world_from_own, source.own_from_world};
    Hit hit;
    hit.t = t;
    hit.part = part;
    if (source.is_by_ray) {
        const Ray own = source.placed ? transformed(source.own_from_world, ray) : ray;
        (void)nearest_crossing(*source.shape, own, t, hits_, hit);
    }
    set_shape_surface(*source.shape, source.placed ? &placement : nullptr, ray, hit,
                      !job_.scene.textures.empty() || job_.aovs != nullptr, point_.surface);
}

void ScanShading::set_facet(const ScanFacet& facet, const Ray& ray) {
    const ScanSource& source = scene_.sources[facet.source];
    if (source.mesh == nullptr) {
        const double t =
            dot(facet.point - ray.origin, facet.normal) / dot(ray.direction, facet.normal);
        set_shape(source, facet.part, t, ray);
        t_ = t;
        point_.surface.materials[0] = source.material;
        return;
    }
    const Hit hit = triangle_hit(triangle_corners(source, facet.part), ray);
    const Placement placement{source.world_from_own, source.own_from_world};
    PlacedMesh mesh;
    // A non-owning pointer: the description outlives the picture.
    mesh.mesh = std::shared_ptr<const TriangleMesh>(std::shared_ptr<void>(), source.mesh);
    mesh.material = source.material;
    set_mesh_surface(mesh, facet.part, source.placed ? &placement : nullptr, hit, point_.surface);
    t_ = hit.t;
}

void ScanShading::set_point(const ScanSample& seen, const Ray& ray) {
    Surface& surface = point_.surface;
    std::uint32_t source_index;
    if ((seen.item & ScanSample::kFacet) != 0) {
        const ScanFacet& facet = scene_.facets[seen.item & ~ScanSample::kFacet];
        source_index = facet.source;
        set_facet(facet, ray);
    } else {
        const ScanPiece& piece = scene_.pieces[seen.item];
        const ScanSource& source = scene_.sources[piece.source];
        source_index = piece.source;
        t_ = distance(seen.nearness, ray);
        if (source.is_patch) {
            surface.has_extras ? reset_extras(surface) : void();
            surface.is_of_mesh = false;
            set_patch_surface(scene_, piece, {seen.u, seen.v}, ray,
                              flatness_ * view_.pixel_size(seen.nearness), surface);
        } else {
            set_shape(source, piece.part, t_, ray);
        }
        surface.materials[0] = source.material;
    }
    complete_point(source_index, ray);
}

Rgb ScanShading::radiance(std::span<const ScanVeil> veils, const ScanSample& seen, const Ray& ray,
                          PixelGeometry* geometry, bool first) {
    Rgb sum;
    double left = 1.0;
    bool told = geometry == nullptr;
    const auto meet = [&](const ScanSample& sample) {
        set_point(sample, ray);
        if (is_trimmed_away(sample)) return true;
        const double coverage = point_.material->coverage;
        if (!(coverage > 0.0)) return true;
        if (!told) {
            told = true;
            if (first) geometry->add_ids(point_.surface);
            geometry->add(point_, depth_);
        }
        sum += (left * coverage) * unhindered_light(job_.scene, ambient_, point_);
        left = left * (1.0 - coverage);
        return left >= kLeastTransmittance;
    };
    for (const ScanVeil& veil : veils) {
        if (!meet(veil.seen)) return sum;
    }
    if (seen.item != ScanSample::kNothing && !meet(seen)) return sum;
    return sum + left * job_.scene.background;
}

void ScanShading::complete_point(std::uint32_t source_index, const Ray& ray) {
    point_.surface.part = scene_.sources[source_index].part;
    point_.surface.instance = scene_.sources[source_index].instance;
    const PointNeeds needs{.constant = &constant_};
    complete_shading_point(job_.scene, ray, {false, job_.cone.width_at(t_)}, needs, point_);
}

Rgb ScanShading::color_of_point() const {
    const double coverage = point_.material->coverage;
    // Avoids a copy, here and below: a load of the whole would wait for the stores of its parts.
    if (coverage == 1.0) return unhindered_light(job_.scene, ambient_, point_);
    const Rgb color = coverage * unhindered_light(job_.scene, ambient_, point_);
    return coverage < 1.0 ? color + (1.0 - coverage) * job_.scene.background : color;
}

void ScanShading::shade_patch(std::span<const ScanSample> seen, std::span<const Ray> rays,
                              Rgb* pixels) {
    const ScanPiece& piece = scene_.pieces[seen[0].item];
    const ScanSource& source = scene_.sources[piece.source];
    Surface& surface = point_.surface;
    if (surface.has_extras) reset_extras(surface);
    surface.is_of_mesh = false;
    const bool with_uv = !job_.scene.textures.empty();
    while (!seen.empty()) {
        block_.count = std::min(seen.size(), PatchBlock::kMost);
        block_.rays = rays.data();
        for (std::size_t k = 0; k < block_.count; ++k) {
            block_.u[k] = seen[k].u;
            block_.v[k] = seen[k].v;
            block_.error[k] = flatness_ * view_.pixel_size(seen[k].nearness);
        }
        find_patch_points(piece.net, piece.polynomial, block_);
        for (std::size_t k = 0; k < block_.count; ++k) {
            set_patch_surface(scene_, piece, block_, k, with_uv, surface);
            surface.materials[0] = source.material;
            // Only textures need the distance.
            if (with_uv) t_ = distance(seen[k].nearness, rays[k]);
            complete_point(piece.source, rays[k]);
            const Rgb color = color_of_point();
            pixels[k].r = color.r;
            pixels[k].g = color.g;
            pixels[k].b = color.b;
        }
        pixels += block_.count;
        seen = seen.subspan(block_.count);
        rays = rays.subspan(block_.count);
    }
}

bool ScanShading::is_of_patch(const ScanSample& seen) const {
    return (seen.item & ScanSample::kFacet) == 0 &&
           scene_.sources[scene_.pieces[seen.item].source].is_patch;
}

bool ScanShading::is_trimmed_away(const ScanSample& seen) const {
    if ((seen.item & ScanSample::kFacet) != 0) return false;
    const ScanPiece& piece = scene_.pieces[seen.item];
    if (!piece.trimmed) return false;
    const Vec2 uv = point_.surface.uv;
    return !std::get<NurbsSurface>(*scene_.sources[piece.source].shape).keeps_uv(uv);
}

void ScanShading::shade_run(std::span<const ScanSample> seen, const Vec3* columns,
                            const Vec3& of_row, Rgb* pixels) {
    const std::span<Vec3> sums = std::span(sums_).first(seen.size());
    for (std::size_t k = 0; k < seen.size(); ++k) sums[k] = columns[k] + of_row;
    eye_.rays(sums, rays_.data());
    const std::span<const Ray> rays = std::span(rays_).first(seen.size());
    for (std::size_t k = 0; k < seen.size();) {
        if (!is_of_patch(seen[k])) {
            set_point(seen[k], rays[k]);
            pixels[k] = color_of_point();
            ++k;
            continue;
        }
        std::size_t end = k + 1;
        while (end < seen.size() && seen[end].item == seen[k].item) ++end;
        shade_patch(seen.subspan(k, end - k), rays.subspan(k, end - k), pixels + k);
        k = end;
    }
}

std::uint64_t ScanShading::shade_plain(const ScanRow& row, int number, Film& film) {
    const Vec3 of_row = eye_.row(grid_.film_at(0, number, 0).y);
    Rgb* const pixels = film.from(film.crop().x0, film.crop().y0 + number);
    FiniteMean of_background;
    const bool bad_background = !of_background.add(job_.scene.background);
    const Rgb background = of_background.value();
    const std::span<const ScanSample> seen(row.samples);
    std::uint64_t left_out = 0;
    for (std::size_t i = 0, end = 0; i < seen.size(); i = end) {
        if (seen[i].item == ScanSample::kNothing) {
            pixels[i] = background;
            left_out += bad_background;
            end = i + 1;
            continue;
        }
        while (end < seen.size() && seen[end].item != ScanSample::kNothing) ++end;
        shade_run(seen.subspan(i, end - i), columns_.data() + i, of_row, pixels + i);
        for (std::size_t k = i; k < end; ++k) {
            FiniteMean mean;
            left_out += !mean.add(pixels[k]);
            pixels[k] = mean.value();
        }
    }
    return left_out;
}

std::uint64_t ScanShading::shade(const ScanRow& row, int number, Film& film) {
    if (job_.aovs == nullptr && row.veils.empty() && !grid_.several()) {
        return shade_plain(row, number, film);
    }
    const int samples = grid_.samples();
    const bool layers = job_.aovs != nullptr && job_.aovs->wanted().has_geometry();
    const std::span<const ScanVeil> veils(row.veils);
    std::size_t veil = 0;
    std::uint64_t left_out = 0;
    const int y = film.crop().y0 + number;
    for (int i = 0; i < grid_.columns(); ++i) {
        FiniteMean mean;
        PixelGeometry geometry;
        geometry.samples = samples;
        for (int s = 0; s < samples; ++s) {
            const auto k = static_cast<std::uint32_t>(i * samples + s);
            std::size_t end = veil;
            while (end < veils.size() && veils[end].sample == k) ++end;
            const ScanSample& seen = row.samples[k];
            Rgb color = job_.scene.background;
            if (seen.item != ScanSample::kNothing || end > veil) {
                const Vec2 at = grid_.film_at(i, number, s);
                const Ray ray = eye_.ray(eye_.column(at.x) + eye_.row(at.y));
                color = radiance(veils.subspan(veil, end - veil), seen, ray,
                                 layers ? &geometry : nullptr, s == 0);
            }
            veil = end;
            left_out += !mean.add(color);
        }
        film.set(film.crop().x0 + i, y, mean.value());
        if (layers) write_geometry(*job_.aovs, film.crop().x0 + i, y, geometry);
    }
    return left_out;
}

}  // namespace alhazen
