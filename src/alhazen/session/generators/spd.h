#pragma once
/// The Standard Procedural Databases: one function each, which writes the NFF file of a size
/// factor.
///
/// Source: Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and what
/// the files that the original generators (version 3.14) wrote say.
/// Differs: written anew. balls, gears, tetra and teapot give the published files number for
/// number, and rings, sombrero and tree those of small sizes that are known; where such a file
/// holds nothing but rounding error (below 1e-12), so do ours. Of the others the number of
/// primitives is the published one and the rest a reconstruction:
/// - jacks: one jack is as published, how smaller ones nest in it is ours;
/// - mount: view, light and the glass spheres are as published; the heights of the original came
///   from random numbers that are not known, ours come from others;
/// - lattice, shells: nothing but the kind and number of primitives is known to us;
/// - gears beyond size 4: the colours go on by the rule found in the files of sizes 1 and 4, and
/// the
///   gears get thinner where they would touch;
/// - balls beyond size 4: where a ball points straight down, the original left to rounding which
/// way
///   its own are turned; ours turn about y, but for the one place where the published file does
///   not.
/// Conventions: the size factor is at least 1 and at most the largest that `generators()` names;
/// the number of primitives is stated with each.

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

/// The background of most databases.
inline constexpr Rgb kSky{0.078, 0.361, 0.753};
/// The shininess of a material without a highlight.
inline constexpr double kDull = 100000;

}  // namespace alhazen
