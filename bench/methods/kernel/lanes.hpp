// C++ versions of the GLSL types and functions that the kernel source needs. They work with floats, or with a number
// type that counts its operations. They are simple, so that the compiler may optimise freely.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace dolp::bench {

template <class Real>
struct Vec2 {
  Real x, y;
  friend constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Vec2 operator*(Real a, Vec2 b) { return {a * b.x, a * b.y}; }
  constexpr Vec2& operator+=(Vec2 more) { return *this = *this + more; }
  constexpr Vec2& operator*=(Real factor) { return *this = factor * *this; }
};

template <class Real>
struct Vec4 {
  Real x, y, z, w;
  constexpr Vec4() = default;
  constexpr explicit Vec4(Real all) : x(all), y(all), z(all), w(all) {}
  constexpr Vec4(Real x0, Real y0, Real z0, Real w0) : x(x0), y(y0), z(z0), w(w0) {}
  friend constexpr Vec4 operator+(Vec4 a, Vec4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
  friend constexpr Vec4 operator-(Vec4 a, Vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
  friend constexpr Vec4 operator*(Real a, Vec4 b) { return {a * b.x, a * b.y, a * b.z, a * b.w}; }
  constexpr Vec4& operator+=(Vec4 more) { return *this = *this + more; }
  constexpr Vec4& operator*=(Real factor) { return *this = factor * *this; }
};

using uint = std::uint32_t;

inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }
inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }

inline int min(int a, int b) { return b < a ? b : a; }
inline int max(int a, int b) { return a < b ? b : a; }
inline uint min(uint a, uint b) { return b < a ? b : a; }

inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float clamp(float value, float low, float high) { return min(max(value, low), high); }
inline float abs(float value) { return std::fabs(value); }
template <class Real>
Vec4<Real> abs(Vec4<Real> a) {
  return {abs(a.x), abs(a.y), abs(a.z), abs(a.w)};
}
inline float floor(float value) { return std::floor(value); }
inline float sqrt(float value) { return std::sqrt(value); }
inline float mod(float value, float by) { return value - by * std::floor(value / by); }

/// value times 2^exponent. Domain: exponents for which 2^exponent is a normal float.
inline float ldexp(float value, int exponent) {
  constexpr int kMantissaBits = 23;
  constexpr int kBias = 127;
  return value * std::bit_cast<float>((exponent + kBias) << kMantissaBits);
}

/// Splits a positive normal number into a mantissa in [0.5, 1), which it returns, and an exponent of 2.
inline float frexp(float value, int& exponent) {
  constexpr int kMantissaBits = 23;
  constexpr int kBias = 126;
  constexpr int kMantissa = (1 << kMantissaBits) - 1;
  const auto bits = std::bit_cast<std::int32_t>(value);
  exponent = (bits >> kMantissaBits) - kBias;
  return std::bit_cast<float>((bits & kMantissa) | (kBias << kMantissaBits));
}

}  // namespace dolp::bench
