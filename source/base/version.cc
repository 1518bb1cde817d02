// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: versions of the program and of the libraries it was built with.

#include <tanktread/base/version.h>

#include <deal.II/base/config.h>

#include <Eigen/Core>
#include <opensubdiv/version.h>
#include <tanktread_revision.h> // written by CMake at each build

namespace tanktread
{
  namespace
  {
    template <typename... Numbers>
    std::string
    dotted(const Numbers... numbers)
    {
      std::string text;
      ((text += (text.empty() ? "" : ".") + std::to_string(numbers)), ...);
      return text;
    }
  } // namespace

  std::string
  program_version()
  {
    return "Tanktread " TANKTREAD_VERSION " (revision " TANKTREAD_REVISION ", " TANKTREAD_BUILD_TYPE ")";
  }

  std::string
  library_versions()
  {
    return "deal.II " DEAL_II_PACKAGE_VERSION ", Trilinos " +
      dotted(DEAL_II_TRILINOS_VERSION_MAJOR, DEAL_II_TRILINOS_VERSION_MINOR, DEAL_II_TRILINOS_VERSION_SUBMINOR) + ", p4est " +
      dotted(DEAL_II_P4EST_VERSION_MAJOR, DEAL_II_P4EST_VERSION_MINOR, DEAL_II_P4EST_VERSION_SUBMINOR) + ", OpenSubdiv " +
      dotted(OPENSUBDIV_VERSION_NUMBER / 10000, OPENSUBDIV_VERSION_NUMBER / 100 % 100, OPENSUBDIV_VERSION_NUMBER % 100) + ", Eigen " +
      dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
  }
} // namespace tanktread
