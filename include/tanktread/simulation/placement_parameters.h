// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many capsules there are, and where.

#ifndef tanktread_simulation_placement_parameters_h
#define tanktread_simulation_placement_parameters_h

#include <tanktread/surface/place.h>

#include <string>
#include <vector>

namespace dealii
{
  class ParameterHandler;
}

namespace tanktread
{
  /** Where places come from. */
  enum class Placement
  {
    list,  // the lists `centres` and `rotations`
    file,  // the file `places`
    random // number, volume fraction, seed and least gap
  };

  /** The parameters that place the capsules of a kind. */
  struct PlacementParameters
  {
    static constexpr unsigned int most_at_random = 1000000;

    Placement                        placement = Placement::list;
    std::vector<std::vector<double>> centres   = {{0., 0., 0.}}; // of the enclosed volumes, in a
    std::vector<std::vector<double>> rotations;                  // vectors along the axis, as long as the angle in units of pi; none: all as the shape has it
    std::string                      file;
    unsigned int                     number          = 0; // unless 0
    double                           volume_fraction = 0.;
    unsigned int                     seed            = 1;
    bool                             turned          = false;
    double                           least_gap       = 0.1; // a

    /** Declares the parameters in the section of `prm` that is open; parsing fills this object, which has to outlive `prm`. */
    void
    add_parameters(dealii::ParameterHandler &prm);

    /** Throws InputError on an empty list, on a list of rotations that does not fit the centres, and on random places without one number or fraction. */
    void
    check() const;

    /** Those of the lists. */
    std::vector<Place>
    places() const;

    /** How many capsules of the radius `size` are placed at random in a box of that volume: the number, or that which comes nearest to the volume fraction, at least one. Throws InputError where it is more than
     * `most_at_random`. */
    unsigned int
    number_in(double volume, double size = 1.) const;
  };

  /** Places as values of the parameters "Centres" and "Rotations", in that order, to sixteen digits; no rotations if none of the places is turned. */
  std::pair<std::string, std::string>
  as_lists(const std::vector<Place> &places);

  /**
   * Reads a file of places: a line a capsule with x y z, or x y z and a rotation vector in units of pi, separated by blanks or commas; "#" begins a comment.
   * @throws InputError that names file and line.
   */
  std::vector<Place>
  read_places(const std::string &file);
} // namespace tanktread

#endif
