// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: includes that tests/check_layers.py has to refuse; never compiled.

#include <deal.II/base/parameter_handler.h>
#include <deal.II/grid/tria.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/fluid_mesh.h>
#include <mpi.h>
