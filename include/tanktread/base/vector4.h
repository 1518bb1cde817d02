// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: four numbers in vector registers.

#ifndef tanktread_base_vector4_h
#define tanktread_base_vector4_h

#include <cstring>

namespace tanktread
{
  /**
   * A 3-vector and a fourth number in two registers of two, which every 64-bit processor has. Compilers leave arrays of four numbers that are summed up in
   * loops in
   * memory; these stay in registers.
   */
  class Vector4
  {
  public:
    Vector4()
      : Vector4(0., 0., 0.)
    {}
    Vector4(const double x, const double y, const double z, const double w = 0.)
      : xy_{x, y}
      , zw_{z, w}
    {}
    /** The three numbers at `values` and a zero. */
    explicit Vector4(const double *values)
      : zw_{values[2], 0.}
    {
      // Both at once: a register that is put together from two halves is stored as two, and waits for them when it is loaded again.
      std::memcpy(&xy_, values, sizeof(xy_));
    }

    /** The four numbers at `values`. */
    static Vector4
    of_four(const double *values)
    {
      Vector4 result;
      std::memcpy(&result.xy_, values, sizeof(result.xy_));
      std::memcpy(&result.zw_, values + 2, sizeof(result.zw_));
      return result;
    }

    void
    store_four(double *values) const
    {
      std::memcpy(values, &xy_, sizeof(xy_));
      std::memcpy(values + 2, &zw_, sizeof(zw_));
    }
    /** Writes the first three. */
    void
    store(double *values) const
    {
      std::memcpy(values, &xy_, sizeof(xy_));
      values[2] = zw_[0];
    }
    double
    operator[](const unsigned int c) const
    {
      return c < 2 ? xy_[c] : zw_[c - 2];
    }

    Vector4 &
    operator+=(const Vector4 &v)
    {
      xy_ += v.xy_;
      zw_ += v.zw_;
      return *this;
    }
    Vector4 &
    operator-=(const Vector4 &v)
    {
      xy_ -= v.xy_;
      zw_ -= v.zw_;
      return *this;
    }
    Vector4 &
    operator*=(const double factor)
    {
      xy_ *= factor;
      zw_ *= factor;
      return *this;
    }
    /** Product place by place. */
    Vector4
    times(const Vector4 &v) const
    {
      Vector4 result(*this);
      result.xy_ *= v.xy_;
      result.zw_ *= v.zw_;
      return result;
    }
    friend Vector4
    operator+(Vector4 v, const Vector4 &w)
    {
      return v += w;
    }
    friend Vector4
    operator*(const double factor, Vector4 v)
    {
      return v *= factor;
    }

  private:
    typedef double Pair __attribute__((vector_size(16)));

    Pair xy_, zw_;
  };
} // namespace tanktread

#endif
