// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules at random in a box, none of which overlap.

#ifndef tanktread_simulation_random_places_h
#define tanktread_simulation_random_places_h

#include <tanktread/fluid/box.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/place.h>

#include <vector>

namespace tanktread
{
  /** Capsules of one shape. */
  struct KindInPlace
  {
    FittedShape        shape;          // about the origin; a coarse control mesh will do
    unsigned int       number = 1;     // at random places
    bool               turned = false; // orientations at random too; as the shape has them otherwise
    std::vector<Place> fixed  = {};    // places of further ones, which the random ones have to leave room for
  };

  /** What is asked for. */
  struct RandomPlacement
  {
    unsigned int seed      = 1;
    double       least_gap = 0.1; // between capsules and their periodic images, in a
    double       face_gap  = 0.1; // to faces with prescribed velocity
  };

  /**
   * Places without overlap: capsules start small at random, move and turn at random as hard bodies do, and grow as far as gaps allow after each round, until they have their size (Lubachevsky & Stillinger,
   * J. Stat. Phys. 60, 561 (1990), with Monte Carlo moves in the place of collisions). The same for the same arguments. Gaps are those of the vertices' limit positions of one capsule from the tangent
   * planes at those of the other.
   * @return random places of each of `kinds`.
   * Throws InputError where the capsules do not fit: there are too many of them for the box.
   */
  std::vector<std::vector<Place>>
  random_places(const RandomPlacement &wanted, const std::vector<KindInPlace> &kinds, const Box &box);
} // namespace tanktread

#endif
