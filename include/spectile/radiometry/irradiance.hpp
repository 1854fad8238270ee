// How much of an evenly bright emitter a surface sees: projected solid angles, in closed form and by
// quadrature.
//
// Rules common to all. The irradiance of a surface from an emitter of the same radiance L in all directions
// is L times the emitter's projected solid angle, the integral of the cosine at the receiver over the solid
// angle of the emitter. It holds for any L: radiance gives irradiance, spectral radiance spectral irradiance,
// luminance illuminance. Emitters have one bright side; where the receiver is not in front of it, the answer
// is 0. What is below the receiver's horizon does not count. An emitter without area gives 0. Normals are of
// any length but 0.
//
// Units: positions in m (or any other length, the same everywhere); sr.
//
// Errors: kBadArgument for a number that is not finite, a zero normal, a negative radius, points outside 1 to
// 1e9.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <spectile/radiometry/directions.hpp>
#include <spectile/result.hpp>
#include <spectile/units.hpp>

namespace spectile {

/// A small piece of a surface.
struct Receiver {
  Vector3 position_m = {};
  Vector3 normal = {0, 0, 1};
};

/// A disk, bright on the side to which its normal points.
struct DiskEmitter {
  Vector3 centre_m = {};
  Vector3 normal = {0, 0, 1};
  double radius_m = 0;
};

/// A parallelogram: a square, a rectangle. Bright on the side to which cross(edge_u, edge_v) points.
struct QuadEmitter {
  Vector3 corner_m = {};
  Vector3 edge_u_m = {};
  Vector3 edge_v_m = {};
};

// --- in closed form --------------------------------------------------------------------------------------

/// Of a disk whose plane is parallel to the receiver's: pi r^2 / (r^2 + h^2) on its axis; anywhere else too.
/// Errors: also kBadArgument where the planes are not parallel to within 1e-9 rad. Relative error below
/// 1e-14, also for small disks far away, plus what rounding the normals leaves of the height: 1e-16 of the
/// distance, which counts where the disk is next to the receiver's own plane. Source: Foote, Illumination
/// from a Radiating Disk, Scientific Papers of the Bureau of Standards 12, 1915.
Result<SolidAngle> projected_solid_angle(const DiskEmitter& emitter, const Receiver& receiver);

/// Of a parallelogram, at any angle. Absolute error below 1e-14. Source: as for the polygon.
Result<SolidAngle> projected_solid_angle(const QuadEmitter& emitter, const Receiver& receiver);

/// Of a plane polygon, convex or not, at any angle, bright on the side from which its corners run
/// counter-clockwise; clipped at the receiver's horizon. Shapes: at least three corners. That they are in one
/// plane is the caller's matter. Absolute error below 1e-14 times the number of corners. Source: Lambert,
/// Photometria, 1760; Baum, Rushmeier, Winget, Improving Radiosity Solutions Through the Use of Analytically
/// Determined Form-Factors, SIGGRAPH 1989.
Result<SolidAngle> projected_solid_angle(std::span<const Vector3> polygon_m, const Receiver& receiver);

/// Of a rectangle of these sides, parallel to the receiver at a height, with one corner straight above it: pi
/// times the form factor of the tables. Four of them make up a centred one. 0 at height 0. Errors:
/// kBadArgument for a number below 0 or not finite. Absolute error below 1e-15. Source: Howell, Menguc,
/// Siegel, Thermal Radiation Heat Transfer, 6th edition, configuration factor B-3.
Result<SolidAngle> projected_solid_angle_over_corner(double side_a_m, double side_b_m, double height_m);

// --- by quadrature: two ways that share no formula -------------------------------------------------------

/// Over the emitter's area: the midpoint rule on a grid of cells of equal area, at least `points` of them
/// (rounded up to a square). The error falls as 1 / points, also where the horizon cuts the emitter, and is
/// below 1 / points for an emitter not larger than its distance. One much larger than its distance needs
/// enough points that a cell is not.
Result<SolidAngle> projected_solid_angle_by_area(const DiskEmitter& emitter, const Receiver& receiver,
                                                 std::size_t points);
Result<SolidAngle> projected_solid_angle_by_area(const QuadEmitter& emitter, const Receiver& receiver,
                                                 std::size_t points);

/// Over directions: rays, one in each cell of equal solid angle of the cone about the emitter's bounding
/// sphere (or of the hemisphere, where the receiver is in that sphere), at least `points` of them (rounded up
/// to a square), that hit the emitter or do not. Stratified: the standard error falls as points^(-3/4), and
/// is below (cone's solid angle) * points^(-3/4). The same seed gives the same bits on every machine with the
/// same mathematical library.
Result<SolidAngle> projected_solid_angle_by_directions(const DiskEmitter& emitter, const Receiver& receiver,
                                                       std::size_t points, std::uint64_t seed = 0);
Result<SolidAngle> projected_solid_angle_by_directions(const QuadEmitter& emitter, const Receiver& receiver,
                                                       std::size_t points, std::uint64_t seed = 0);

}  // namespace spectile
