// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the capsules of a scene, told by their numbers, and the kinds that they are of.

#include <tanktread/shell/capsules.h>

#include <stdexcept>
#include <utility>

namespace tanktread
{
  Capsules::Capsules(std::vector<std::unique_ptr<const Capsule>> kinds, std::vector<unsigned int> kind_of)
    : kinds_(std::move(kinds))
    , kind_of_(std::move(kind_of))
  {
    for (const unsigned int kind : kind_of_)
      if (kind >= kinds_.size())
        throw std::logic_error("Capsules: a capsule is of a kind that there is not.");
  }


  double
  Capsules::volume() const
  {
    double result = 0.;
    for (unsigned int c = 0; c < size(); ++c)
      result += (*this)[c].volume();
    return result;
  }


  std::size_t
  Capsules::n_control_points() const
  {
    std::size_t result = 0;
    for (unsigned int c = 0; c < size(); ++c)
      result += (*this)[c].n_control_points();
    return result;
  }
} // namespace tanktread
