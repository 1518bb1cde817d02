// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations with assembled matrices and algebraic multigrid, in the own numbering.

#include <tanktread/base/timings.h>
#include <tanktread/fluid/algebraic_preconditioner.h>
#include <tanktread/fluid/algebraic_stokes.h>

namespace tanktread
{
  namespace
  {
    class AssembledMap : public StokesMap
    {
    public:
      explicit AssembledMap(const AssembledStokes &stokes)
        : stokes_(stokes)
      {
        stokes.reinit(src_);
        stokes.reinit(dst_);
      }

      void
      vmult(FluidBlockVector &dst, const FluidBlockVector &src) const override
      {
        stokes_.to_components(src, src_);
        stokes_.vmult(dst_, src_);
        stokes_.to_nodes(dst_, dst);
      }

    private:
      const AssembledStokes  &stokes_;
      mutable ComponentVector src_, dst_;
    };


    class AlgebraicInverse : public StokesInverse
    {
    public:
      AlgebraicInverse(const TaylorHoodSpace &space, const AssembledStokes &stokes)
        : space_(space)
        , stokes_(stokes)
        , preconditioner_(stokes)
      {
        stokes.reinit(src_);
        stokes.reinit(dst_);
      }

      void
      vmult(FluidBlockVector &dst, const FluidBlockVector &src, Timings *const timings) const override
      {
        const Timings::Scope scope(timings, "- algebraic preconditioner");
        stokes_.to_components(src, src_);
        preconditioner_.vmult(dst_, src_);
        stokes_.to_nodes(dst_, dst);
      }

      const TaylorHoodSpace &
      space() const override
      {
        return space_;
      }

    private:
      const TaylorHoodSpace  &space_;
      const AssembledStokes  &stokes_;
      AlgebraicPreconditioner preconditioner_;
      mutable ComponentVector src_, dst_;
    };
  } // namespace


  struct AlgebraicStokes::Parts
  {
    explicit Parts(const TaylorHoodSpace &space)
      : stokes(space)
      , map(stokes)
      , inverse(space, stokes)
    {}

    AssembledStokes  stokes;
    AssembledMap     map;
    AlgebraicInverse inverse;
  };


  AlgebraicStokes::AlgebraicStokes(const TaylorHoodSpace &space)
    : parts_(std::make_unique<const Parts>(space))
  {}


  AlgebraicStokes::~AlgebraicStokes() = default;


  const StokesMap &
  AlgebraicStokes::map() const
  {
    return parts_->map;
  }


  const StokesInverse &
  AlgebraicStokes::inverse() const
  {
    return parts_->inverse;
  }
} // namespace tanktread
