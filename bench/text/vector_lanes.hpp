// A number with a lane for each of several invocations of the shaders' text that go side by side in one thread.
//
// They keep together: a condition holds for all lanes or for none, an integer is the largest of the lanes, so that all take
// the rule of most nodes; what differs from lane to lane is `choose` and `whole` in the text.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "bench/text/lanes.hpp"

namespace dolp::bench {

constexpr int kLanes = 16;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

#define DOLP_INLINE inline __attribute__((always_inline))

/// The lanes do not agree on a condition: each has to go alone.
struct LanesDiffer {};

/// -1 in the lanes where a condition holds.
struct Mask {
  Ints v;
  DOLP_INLINE operator bool() const {
    int all = -1;
    int any = 0;
    for (int i = 0; i < kLanes; ++i) {
      all &= v[i];
      any |= v[i];
    }
    if (all != any) throw LanesDiffer();
    return any != 0;
  }
};

/// An integer of each lane's own.
struct Whole {
  Ints v;
  Whole() = default;
  DOLP_INLINE explicit Whole(Ints lanes) : v(lanes) {}
};

struct Real {
  Floats v;
  Real() = default;
  DOLP_INLINE Real(Floats lanes) : v(lanes) {}
  DOLP_INLINE constexpr explicit Real(float all)
      : v{all, all, all, all, all, all, all, all, all, all, all, all, all, all, all, all} {}
  DOLP_INLINE constexpr explicit Real(double all) : Real(static_cast<float>(all)) {}
  DOLP_INLINE constexpr explicit Real(int all) : Real(static_cast<float>(all)) {}
  DOLP_INLINE constexpr explicit Real(uint all) : Real(static_cast<float>(all)) {}
  DOLP_INLINE explicit Real(Whole whole) : v(__builtin_convertvector(whole.v, Floats)) {}
  /// The largest.
  DOLP_INLINE explicit operator float() const {
    float largest = v[0];
    for (int i = 1; i < kLanes; ++i) largest = bench::max(largest, v[i]);
    return largest;
  }
  DOLP_INLINE explicit operator int() const { return static_cast<int>(static_cast<float>(*this)); }
  DOLP_INLINE explicit operator Whole() const { return Whole(__builtin_convertvector(v, Ints)); }

  DOLP_INLINE Real operator-() const { return -v; }
  friend DOLP_INLINE Real operator+(Real a, Real b) { return a.v + b.v; }
  friend DOLP_INLINE Real operator-(Real a, Real b) { return a.v - b.v; }
  friend DOLP_INLINE Real operator*(Real a, Real b) { return a.v * b.v; }
  friend DOLP_INLINE Real operator/(Real a, Real b) { return a.v / b.v; }
  DOLP_INLINE Real& operator+=(Real more) { return *this = *this + more; }
  DOLP_INLINE Real& operator-=(Real less) { return *this = *this - less; }
  DOLP_INLINE Real& operator*=(Real factor) { return *this = *this * factor; }
  friend DOLP_INLINE Mask operator<(Real a, Real b) { return {Ints(a.v < b.v)}; }
  friend DOLP_INLINE Mask operator<=(Real a, Real b) { return {Ints(a.v <= b.v)}; }
  friend DOLP_INLINE Mask operator>(Real a, Real b) { return {Ints(a.v > b.v)}; }
  friend DOLP_INLINE Mask operator>=(Real a, Real b) { return {Ints(a.v >= b.v)}; }
};

DOLP_INLINE Real choose(Mask where, Real a, Real b) { return where.v ? a.v : b.v; }
DOLP_INLINE Vec2<Real> choose(Mask where, Vec2<Real> a, Vec2<Real> b) {
  return {choose(where, a.x, b.x), choose(where, a.y, b.y)};
}

DOLP_INLINE Real min(Real a, Real b) { return a.v < b.v ? a.v : b.v; }
DOLP_INLINE Real max(Real a, Real b) { return a.v < b.v ? b.v : a.v; }
DOLP_INLINE Real clamp(Real value, Real low, Real high) { return min(max(value, low), high); }
DOLP_INLINE Real abs(Real value) { return Floats(Ints(value.v) & 0x7fffffff); }
DOLP_INLINE Real sqrt(Real value) {
  Floats root;
  for (int i = 0; i < kLanes; ++i) root[i] = __builtin_sqrtf(value.v[i]);
  return root;
}
DOLP_INLINE Real floor(Real value) {
  Floats below;
  for (int i = 0; i < kLanes; ++i) below[i] = __builtin_floorf(value.v[i]);
  return below;
}
DOLP_INLINE Real mod(Real value, Real by) { return value - by * floor(value / by); }

/// As those of lanes.hpp.
DOLP_INLINE Real ldexp(Real value, Whole exponent) { return value.v * Floats((exponent.v + 127) << 23); }
DOLP_INLINE Real frexp(Real value, Whole& exponent) {
  exponent = Whole((Ints(value.v) >> 23) - 126);
  return Floats((Ints(value.v) & 0x7fffff) | (126 << 23));
}

}  // namespace dolp::bench
