// Compiled with flags of its own, see bench/CMakeLists.txt.
#define DOLP_TEXT_NAMESPACE native_text

#include "methods/text/lanes.hpp"

namespace dolp::bench::native_text {
using real = float;
using real2 = Vec2<float>;
using real4 = Vec4<float>;
constexpr real as_data(real number) { return number; }
}  // namespace dolp::bench::native_text

#include "methods/text/grouped_body.hpp"

namespace dolp::bench {

std::unique_ptr<GroupedText> make_native_text(const GroupedWork& work) { return native_text::text_for(work); }

}  // namespace dolp::bench
