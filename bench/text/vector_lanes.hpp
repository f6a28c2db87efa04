// Numbers with a lane for each of several invocations, for what bench/text/vectorise.py makes of the shaders' text.
// Assignments spare the lanes that branches, loops and returns have left out.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "bench/text/lanes.hpp"

namespace dolp::bench::vector_text {

constexpr int kLanes = 16;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Uints = std::uint32_t __attribute__((vector_size(4 * kLanes)));

#define DOLP_INLINE inline __attribute__((always_inline))

inline thread_local Ints active;   // -1 in the lanes at work
inline thread_local Ints retired;  // -1 in those that have returned from the function at work

DOLP_INLINE bool any(Ints lanes) {
  std::int64_t parts[kLanes / 2];
  std::memcpy(parts, &lanes, sizeof parts);
  std::int64_t all = 0;
  for (const std::int64_t part : parts) all |= part;
  return all != 0;
}

struct Mask {
  Ints v;
  Mask() = default;
  DOLP_INLINE Mask(Ints lanes) : v(lanes) {}
  DOLP_INLINE Mask(bool all) : v(all ? ~Ints{} : Ints{}) {}
  Mask(const Mask&) = default;
  DOLP_INLINE Mask& operator=(const Mask& o) {
    v = (v & ~active) | (o.v & active);
    return *this;
  }
};
DOLP_INLINE Mask operator&&(Mask a, Mask b) { return a.v & b.v; }
DOLP_INLINE Mask operator||(Mask a, Mask b) { return a.v | b.v; }
DOLP_INLINE Mask operator!(Mask a) { return ~a.v; }

struct Int {
  Ints v;
  Int() = default;
  DOLP_INLINE Int(Ints lanes) : v(lanes) {}
  DOLP_INLINE Int(int all) : v(Ints{} + all) {}
  Int(const Int&) = default;
  DOLP_INLINE Int& operator=(const Int& o) {
    v = active ? o.v : v;
    return *this;
  }
};
struct Uint {
  Uints v;
  Uint() = default;
  DOLP_INLINE Uint(Uints lanes) : v(lanes) {}
  DOLP_INLINE Uint(std::uint32_t all) : v(Uints{} + all) {}
  Uint(const Uint&) = default;
  DOLP_INLINE Uint& operator=(const Uint& o) {
    v = active ? o.v : v;
    return *this;
  }
};
struct Real {
  Floats v;
  Real() = default;
  DOLP_INLINE Real(Floats lanes) : v(lanes) {}
  DOLP_INLINE Real(float all) : v(Floats{} + all) {}
  DOLP_INLINE explicit Real(double all) : Real(static_cast<float>(all)) {}
  DOLP_INLINE explicit Real(int all) : Real(static_cast<float>(all)) {}
  DOLP_INLINE explicit Real(Int all) : v(__builtin_convertvector(all.v, Floats)) {}
  Real(const Real&) = default;
  DOLP_INLINE Real& operator=(const Real& o) {
    v = active ? o.v : v;
    return *this;
  }
  DOLP_INLINE Real operator-() const { return -v; }
};
#define DOLP_OPERATORS(Type)                                                  \
  DOLP_INLINE Type operator+(Type a, Type b) { return a.v + b.v; }            \
  DOLP_INLINE Type operator-(Type a, Type b) { return a.v - b.v; }            \
  DOLP_INLINE Type operator*(Type a, Type b) { return a.v * b.v; }            \
  DOLP_INLINE Type operator/(Type a, Type b) { return a.v / b.v; }            \
  DOLP_INLINE Type& operator+=(Type& a, Type b) { return a = a + b; }         \
  DOLP_INLINE Type& operator-=(Type& a, Type b) { return a = a - b; }         \
  DOLP_INLINE Mask operator<(Type a, Type b) { return Ints(a.v < b.v); }      \
  DOLP_INLINE Mask operator<=(Type a, Type b) { return Ints(a.v <= b.v); }    \
  DOLP_INLINE Mask operator>(Type a, Type b) { return Ints(a.v > b.v); }      \
  DOLP_INLINE Mask operator>=(Type a, Type b) { return Ints(a.v >= b.v); }    \
  DOLP_INLINE Mask operator==(Type a, Type b) { return Ints(a.v == b.v); }    \
  DOLP_INLINE Mask operator!=(Type a, Type b) { return Ints(a.v != b.v); }    \
  DOLP_INLINE Type select(Mask c, Type a, Type b) { return c.v ? a.v : b.v; } \
  DOLP_INLINE Type min(Type a, Type b) { return a.v < b.v ? a.v : b.v; }      \
  DOLP_INLINE Type max(Type a, Type b) { return a.v < b.v ? b.v : a.v; }
DOLP_OPERATORS(Real)
DOLP_OPERATORS(Int)
DOLP_OPERATORS(Uint)
DOLP_INLINE Uint operator>>(Uint a, Uint b) { return a.v >> b.v; }
DOLP_INLINE Uint operator<<(Uint a, Uint b) { return a.v << b.v; }

using Real2 = Vec2<Real>;
using Real4 = Vec4<Real>;
DOLP_INLINE Real2 select(Mask c, Real2 a, Real2 b) { return {select(c, a.x, b.x), select(c, a.y, b.y)}; }
DOLP_INLINE Int select(Mask c, int a, int b) { return select(c, Int(a), Int(b)); }
template <class T>
DOLP_INLINE T select(bool c, T a, T b) {
  return c ? a : b;
}

using bench::max;
using bench::min;
DOLP_INLINE Real clamp(Real x, Real low, Real high) { return min(max(x, low), high); }
DOLP_INLINE Real abs(Real x) { return Floats(Ints(x.v) & 0x7fffffff); }
DOLP_INLINE Real sqrt(Real x) {
  Floats r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_sqrtf(x.v[i]);
  return r;
}
DOLP_INLINE Real floor(Real x) {
  Floats r;
  for (int i = 0; i < kLanes; ++i) r[i] = __builtin_floorf(x.v[i]);
  return r;
}
DOLP_INLINE Real mod(Real x, Real by) { return x - by * floor(x / by); }
DOLP_INLINE Real ldexp(Real x, Int exponent) { return x.v * Floats((exponent.v + 127) << 23); }
DOLP_INLINE Real frexp(Real x, Int& exponent) {
  exponent = Int((Ints(x.v) >> 23) - 126);
  return Floats((Ints(x.v) & 0x7fffff) | (126 << 23));
}
DOLP_INLINE Uint floatBitsToUint(Real x) { return Uints(x.v); }
DOLP_INLINE Real uintBitsToFloat(Uint x) { return Floats(x.v); }
DOLP_INLINE Int to_int(Real x) { return __builtin_convertvector(x.v, Ints); }
DOLP_INLINE Uint to_uint(Int x) { return Uints(x.v); }
DOLP_INLINE Uint to_uint(int x) { return static_cast<std::uint32_t>(x); }
DOLP_INLINE Real to_float(Real x) { return x; }
template <int kCount>
DOLP_INLINE Real at(const Real (&list)[kCount], Int place) {
  Floats r;
  const Ints own = place.v & active;
  for (int i = 0; i < kLanes; ++i) r[i] = list[own[i]].v[i];
  return r;
}

inline thread_local Ints otherwise;  // -1 in the lanes where the last condition did not hold: those of else

/// if (condition): the body runs for the lanes where it holds, and not at all where there is none.
class Branch {
 public:
  DOLP_INLINE explicit Branch(Mask c) : Branch(active, c) {}
  DOLP_INLINE Branch(Ints among, Mask c) : saved_(active), rest_(among & ~c.v) {
    active = among & c.v;
    runs_ = any(active);
  }
  DOLP_INLINE explicit operator bool() const { return runs_; }
  DOLP_INLINE void end() {
    runs_ = false;
    active = saved_ & ~retired;
    otherwise = rest_;
  }
  DOLP_INLINE ~Branch() { end(); }

 private:
  Ints saved_, rest_;
  bool runs_;
};
/// The same for a condition that is no lane's own.
class PlainBranch {
 public:
  DOLP_INLINE explicit PlainBranch(bool c) : runs_(c) {}
  DOLP_INLINE explicit operator bool() const { return runs_; }
  DOLP_INLINE void end() { runs_ = false; }

 private:
  bool runs_;
};
DOLP_INLINE Branch branch(Mask c) { return Branch(c); }
DOLP_INLINE PlainBranch branch(bool c) { return PlainBranch(c); }
#define if_(...) for (auto branch_ = branch(__VA_ARGS__); branch_; branch_.end())
#define elif_(...) for (Branch branch_(otherwise, __VA_ARGS__); branch_; branch_.end())
#define else_ for (Branch branch_(otherwise, Mask(true)); branch_; branch_.end())

/// A loop that each lane leaves at its own limit.
class Loop {
 public:
  DOLP_INLINE explicit Loop(Int limit) : saved_(active), limit_(limit.v) {}
  DOLP_INLINE explicit Loop(int limit) : Loop(Int(limit)) {}
  DOLP_INLINE bool runs() {
    active = saved_ & ~retired & Ints(limit_ > i_);
    return any(active);
  }
  DOLP_INLINE void operator++() { ++i_; }
  DOLP_INLINE operator int() const { return i_; }
  DOLP_INLINE ~Loop() { active = saved_ & ~retired; }

 private:
  Ints saved_, limit_;
  int i_ = 0;
};

DOLP_INLINE Int operator+(Int a, const Loop& b) { return a + Int(static_cast<int>(b)); }

/// What a function with returns in branches returns.
template <class T>
class Result {
 public:
  DOLP_INLINE Result() : entry_(active), outer_(retired) { retired = Ints{}; }
  DOLP_INLINE ~Result() {
    retired = outer_;
    active = entry_;
  }
  DOLP_INLINE void give(T value) {
    value_ = value;
    retired |= active;
    active = Ints{};
  }
  DOLP_INLINE bool is_over() const { return !any(entry_ & ~retired); }
  DOLP_INLINE T value() const { return value_; }
  DOLP_INLINE T whole(T value) const { return value; }

 private:
  Ints entry_, outer_;
  T value_;
};
DOLP_INLINE constexpr bool always(bool c) { return c; }
DOLP_INLINE bool always(Mask) { return false; }

/// Four numbers of a list at a place of each lane.
DOLP_INLINE Real4 gathered(const Vec4<float>* list, Int where) {
  const Ints place = where.v & active;  // nothing is read for lanes that are left out
  Real4 r;
  const float* base = &list->x;
  Floats* out[4] = {&r.x.v, &r.y.v, &r.z.v, &r.w.v};
  for (int part = 0; part < 4; ++part) {
    for (int i = 0; i < kLanes; ++i) (*out[part])[i] = base[4 * place[i] + part];
  }
  return r;
}

}  // namespace dolp::bench::vector_text
