#pragma once
/// Standard Procedural Databases: each function writes the NFF file of a size factor.
///
/// Source: Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the
/// files written by the original generators (version 3.14). Independent implementation.
/// Conventions: the size factor is at least 1 and at most the largest named by `generators()`; the
/// number of primitives is stated with each function.
/// Agreement with the published files: balls, gears, tetra and teapot reproduce them number for
/// number; rings, sombrero and tree reproduce the known ones of small sizes. Published numbers that
/// are only rounding error (below 1e-12) are rounding error here too. The other databases have the
/// published number of primitives and are otherwise reconstructions:
/// - jacks: one jack is as published; the nesting of smaller ones is reconstructed;
/// - mount: view, light and the glass spheres are as published; the original's random heights are
///   unknown and replaced by others;
/// - lattice, shells: only the kind and number of primitives are known;
/// - gears beyond size 4: colours follow the rule found in the files of sizes 1 and 4; gears get
///   thinner where they would touch;
/// - balls beyond size 4: where a ball points straight down, the original leaves the rotation of
///   its children to rounding; here they turn about y, except at the one place where the published
///   file does not.

#include <cstdint>

#include "alhazen/session/generators/nff_text.h"

namespace alhazen {

/// Sphereflake: (9^(n+1) - 1) / 8 spheres and 1 polygon; published 4: 7381.
void write_balls(std::uint64_t n, NffText& out);
/// n^3 gears of 144 + 2 polygons, and 1; published 4: 9345.
void write_gears(std::uint64_t n, NffText& out);
/// (8^n - 1) / 7 jacks of 6 spheres and 3 cylinders; published 3: 438 + 219.
void write_jacks(std::uint64_t n, NffText& out);
/// (n+1)^3 spheres and 3 n (n+1)^2 cylinders; published 12: 2197 + 6084.
void write_lattice(std::uint64_t n, NffText& out);
/// Fractal mountain of 2 * 4^n triangles, and 4 glass spheres; published 6: 8192 + 4.
void write_mount(std::uint64_t n, NffText& out);
/// n (n+1) (2n+1) / 6 knots of 30 spheres and 30 cylinders, and 1 polygon; published 7: 4200 +
/// 4200.
void write_rings(std::uint64_t n, NffText& out);
/// Snail shell of 90 n + 1 spheres; published (here 4): 361.
void write_shells(std::uint64_t n, NffText& out);
/// exp(-r) cos(2 pi r) as 2 (16 * 2^n - 1)^2 triangles; published 2: 7938.
void write_sombrero(std::uint64_t n, NffText& out);
/// Newell's teapot: 64 n^2 - 8 n triangles with normals, on a board of n x n squares; published 12:
/// 9120 + 144.
void write_teapot(std::uint64_t n, NffText& out);
/// Sierpinski's tetrahedron: 4^n triangles; published 6: 4096.
void write_tetra(std::uint64_t n, NffText& out);
/// 2^(n+1) - 1 cones and as many spheres, and 1 polygon; published 11: 4095 + 4095.
void write_tree(std::uint64_t n, NffText& out);

/// Background of most databases.
inline constexpr Rgb kSky{0.078, 0.361, 0.753};
/// Shininess of a material without a highlight.
inline constexpr double kDull = 100000;

}  // namespace alhazen
