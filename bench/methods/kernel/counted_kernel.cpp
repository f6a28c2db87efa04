// A build of the kernel source that counts arithmetic operations. Its number type `real` is the class Counted.
#define DOLP_KERNEL_NAMESPACE counted_kernel

#include "methods/kernel/grouped_kernel.hpp"
#include "methods/kernel/lanes.hpp"

namespace dolp::bench {
namespace {

thread_local OperationCounts counts;

}  // namespace

OperationCounts counted_operations() { return counts; }

namespace counted_kernel {

void count(std::uint64_t OperationCounts::*kind) { ++(counts.*kind); }

/// A float that counts its operations. Operations between constants do not count: a compiler evaluates them.
class Counted {
 public:
  Counted() = default;
  constexpr explicit Counted(double value) : value_(static_cast<float>(value)), is_constant_(1) {}
  explicit Counted(int value) : value_(static_cast<float>(value)) { count(&OperationCounts::other); }
  constexpr explicit Counted(uint value) : value_(static_cast<float>(value)) {}
  constexpr explicit Counted(float value) : value_(value) {}
  explicit operator float() const { return value_; }
  explicit operator double() const { return static_cast<double>(value_); }
  explicit operator int() const {
    count(&OperationCounts::other);
    return static_cast<int>(value_);
  }

  constexpr float value() const { return value_; }

  friend constexpr Counted operator+(Counted a, Counted b) {
    return result(a, b, a.value_ + b.value_, &OperationCounts::add);
  }
  friend constexpr Counted operator-(Counted a, Counted b) {
    return result(a, b, a.value_ - b.value_, &OperationCounts::add);
  }
  friend constexpr Counted operator*(Counted a, Counted b) {
    return result(a, b, a.value_ * b.value_, &OperationCounts::multiply);
  }
  friend constexpr Counted operator/(Counted a, Counted b) {
    return result(a, b, a.value_ / b.value_, &OperationCounts::divide);
  }
  constexpr Counted operator-() const { return result(*this, *this, -value_, &OperationCounts::other); }
  Counted& operator+=(Counted more) { return *this = *this + more; }
  Counted& operator-=(Counted more) { return *this = *this - more; }
  Counted& operator*=(Counted more) { return *this = *this * more; }

  friend bool operator<(Counted a, Counted b) { return compared(a.value_ < b.value_); }
  friend bool operator<=(Counted a, Counted b) { return compared(a.value_ <= b.value_); }
  friend bool operator>(Counted a, Counted b) { return compared(a.value_ > b.value_); }
  friend bool operator>=(Counted a, Counted b) { return compared(a.value_ >= b.value_); }

 private:
  static constexpr Counted result(Counted a, Counted b, float value, std::uint64_t OperationCounts::*kind) {
    Counted made(value);
    made.is_constant_ = a.is_constant_ & b.is_constant_;
    if (made.is_constant_ == 0) count(kind);
    return made;
  }
  static bool compared(bool answer) {
    count(&OperationCounts::other);
    return answer;
  }

  float value_;
  std::uint32_t is_constant_ = 0;
};

/// Returns `number` as an input of the kernel, not a constant, so that operations on it count.
inline Counted as_data(Counted number) { return Counted(number.value()); }

using real = Counted;
using real2 = Vec2<Counted>;
using real4 = Vec4<Counted>;

inline Counted other(float value) {
  count(&OperationCounts::other);
  return Counted(value);
}
inline Counted min(Counted a, Counted b) { return other(bench::min(a.value(), b.value())); }
inline Counted max(Counted a, Counted b) { return other(bench::max(a.value(), b.value())); }
inline Counted clamp(Counted value, Counted low, Counted high) { return min(max(value, low), high); }
inline Counted abs(Counted value) { return other(bench::abs(value.value())); }
inline Counted floor(Counted value) { return other(bench::floor(value.value())); }
inline Counted ldexp(Counted value, int exponent) { return other(bench::ldexp(value.value(), exponent)); }
inline Counted frexp(Counted value, int& exponent) { return other(bench::frexp(value.value(), exponent)); }
inline Counted mod(Counted value, Counted by) { return value - by * floor(value / by); }
inline Counted sqrt(Counted value) {
  count(&OperationCounts::square_root);
  return Counted(bench::sqrt(value.value()));
}
using bench::max;
using bench::min;

}  // namespace counted_kernel
}  // namespace dolp::bench

#include "methods/kernel/grouped_body.hpp"

namespace dolp::bench {

std::unique_ptr<GroupedKernel> make_counted_kernel(const GroupedWork& work) { return counted_kernel::kernel_for(work); }

}  // namespace dolp::bench
