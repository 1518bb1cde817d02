// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vectors that flexible GMRES keeps.

#ifndef tanktread_fluid_krylov_basis_h
#define tanktread_fluid_krylov_basis_h

#include <tanktread/fluid/types.h>

#include <vector>

namespace tanktread
{
  /**
   * Orthonormal vectors v_0, v_1, ... and the preconditioned ones z_0, z_1, ... that belong to them, in single precision: half the memory and half the time for
   * sums over them, and what rounding costs in accuracy is
   * recovered when GMRES starts again from its residual. The memory stays from one solve to the next of vectors
   * as long.
   */
  class KrylovBasis
  {
  public:
    /** Empty, for vectors with the layout of `vector`. */
    void
    reinit(const FluidBlockVector &vector);

    unsigned int
    size() const
    {
      return n_;
    }

    /** Makes `vector`, whose norm is given, the next v. */
    void
    append(const FluidBlockVector &vector, double norm);

    /** The last v. */
    void
    last(FluidBlockVector &vector) const;

    /** Stores the z that belongs to the last v. */
    void
    set_preconditioned(const FluidBlockVector &vector);

    /**
     * vector -= its part in the space of all v; `coefficients` gets the size() products with them. Classical Gram-Schmidt, twice. Returns the norm of what is
     * left. Collective.
     */
    double
    orthogonalise(FluidBlockVector &vector, std::vector<double> &coefficients) const;

    /** vector += sum_i factors_i z_i over the first factors.size(). */
    void
    add_preconditioned(const std::vector<double> &factors, FluidBlockVector &vector) const;

  private:
    using Vectors = std::vector<std::vector<float>>;

    /** One more vector of length_ in `vectors`. */
    float *
    grow(Vectors &vectors, unsigned int n) const;

    MPI_Comm     communicator_ = MPI_COMM_SELF;
    std::size_t  length_       = 0; // of this rank's part of a vector, all blocks
    unsigned int n_            = 0;
    Vectors      v_, z_;
  };
} // namespace tanktread

#endif
