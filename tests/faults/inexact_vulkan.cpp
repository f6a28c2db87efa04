// A library that is preloaded into a program. It rewrites the SPIR-V of float shaders so that divisions and square
// roots are as inexact as Vulkan allows. Environment:
//   DOLP_VULKAN_ARITHMETIC  SIGN:DIVISION:ROOT adds DIVISION ulp to each quotient and ROOT ulp to each square root, on
//                           top of the device's own errors. An ulp is the distance to the next float. SIGN is `plus`
//                           or `minus`, or `random`: the bits of a result then decide the sign of its error.
#include <dlfcn.h>
#include <vulkan/vulkan.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace {

using Words = std::vector<std::uint32_t>;

// Instructions and operands of SPIR-V (specification of Khronos, section 3).
enum Opcode : std::uint32_t {
  kExtInstImport = 11,
  kExtInst = 12,
  kTypeBool = 20,
  kTypeInt = 21,
  kTypeFloat = 22,
  kConstant = 43,
  kFunction = 54,
  kBitcast = 124,
  kIAdd = 128,
  kFAdd = 129,
  kISub = 130,
  kIMul = 132,
  kFDiv = 136,
  kSelect = 169,
  kFOrdEqual = 180,
  kShiftRightLogical = 194,
};
constexpr std::uint32_t kSqrt = 31;  // in GLSL.std.450
constexpr std::size_t kHeaderWords = 5;
constexpr std::size_t kBoundWord = 3;  // all ids are below this word of the header

struct Errors {
  explicit Errors(const std::string& text) {
    const std::size_t first = text.find(':');
    const std::size_t second = text.rfind(':');
    sign = text.substr(0, first);
    division = static_cast<std::uint32_t>(std::stoul(text.substr(first + 1)));
    root = static_cast<std::uint32_t>(std::stoul(text.substr(second + 1)));
  }
  std::string sign;
  std::uint32_t division = 0;
  std::uint32_t root = 0;
};

class Rewriting {
 public:
  Rewriting(std::span<const std::uint32_t> module, const Errors& errors) : errors_(errors), bound_(module[kBoundWord]) {
    Words declarations(module.begin(), module.begin() + kHeaderWords);
    Words functions;
    for (std::size_t i = kHeaderWords; i < module.size();) {
      const std::span<const std::uint32_t> instruction = module.subspan(i, module[i] >> 16U);
      i += instruction.size();
      if (opcode(instruction) == kFunction) target_ = &functions;
      if (target_ == nullptr) {
        declare(instruction);
        declarations.insert(declarations.end(), instruction.begin(), instruction.end());
      } else {
        rewrite(instruction);
      }
    }
    for (const auto& [value, id] : constants_) {
      for (const std::uint32_t word : {(4U << 16U) | kConstant, uint_, id, value}) declarations.push_back(word);
    }
    declarations[kBoundWord] = bound_;
    declarations.insert(declarations.end(), functions.begin(), functions.end());
    result_ = std::move(declarations);
  }
  const Words& result() const { return result_; }

 private:
  static std::uint32_t opcode(std::span<const std::uint32_t> instruction) { return instruction[0] & 0xffffU; }

  void declare(std::span<const std::uint32_t> instruction) {
    const std::uint32_t kind = opcode(instruction);
    if (kind == kExtInstImport) extensions_ = instruction[1];
    if (kind == kTypeBool) bool_ = instruction[1];
    if (kind == kTypeInt && instruction[2] == 32 && instruction[3] == 0) uint_ = instruction[1];
    if (kind == kTypeFloat && instruction[2] == 32) float_ = instruction[1];
  }

  void rewrite(std::span<const std::uint32_t> instruction) {
    const std::uint32_t kind = opcode(instruction);
    const bool is_root = kind == kExtInst && instruction[3] == extensions_ && instruction[4] == kSqrt;
    const std::uint32_t ulp = is_root ? errors_.root : errors_.division;
    const bool is_changed = (is_root || kind == kFDiv) && instruction[1] == float_ && ulp > 0;
    const std::size_t at = target_->size();
    target_->insert(target_->end(), instruction.begin(), instruction.end());
    if (!is_changed) return;
    const std::uint32_t exact = bound_++;
    (*target_)[at + 2] = exact;
    add_error(exact, ulp, instruction[2]);
  }

  void add_error(std::uint32_t exact, std::uint32_t ulp, std::uint32_t result) {
    const std::uint32_t bits = append(kBitcast, uint_, {exact});
    std::uint32_t changed = 0;
    if (errors_.sign == "random") {
      // The top bit of the bits times an odd number, which differs from operation to operation.
      const std::uint32_t key = constant((2654435769U * (2 * exact + 1)) | 1U);
      const std::uint32_t top = append(kShiftRightLogical, uint_, {append(kIMul, uint_, {bits, key}), constant(31)});
      const std::uint32_t up = append(kIMul, uint_, {top, constant(2 * ulp)});
      changed = append(kISub, uint_, {append(kIAdd, uint_, {bits, up}), constant(ulp)});
    } else {
      changed = append(errors_.sign == "plus" ? kIAdd : kISub, uint_, {bits, constant(ulp)});
    }
    const std::uint32_t inexact = append(kBitcast, float_, {changed});
    const std::uint32_t twice = append(kFAdd, float_, {exact, exact});
    const std::uint32_t stays = append(kFOrdEqual, bool_, {exact, twice});  // true for zeros and infinities
    append(kSelect, float_, {stays, exact, inexact}, result);
  }

  std::uint32_t append(Opcode kind, std::uint32_t type, std::initializer_list<std::uint32_t> operands,
                       std::uint32_t result = 0) {
    if (result == 0) result = bound_++;
    target_->push_back(static_cast<std::uint32_t>((operands.size() + 3) << 16U) | kind);
    target_->push_back(type);
    target_->push_back(result);
    target_->insert(target_->end(), operands);
    return result;
  }

  std::uint32_t constant(std::uint32_t value) {
    const auto [found, is_new] = constants_.try_emplace(value, bound_);
    if (is_new) ++bound_;
    return found->second;
  }

  Errors errors_;
  std::uint32_t bound_;
  std::uint32_t extensions_ = 0, bool_ = 0, uint_ = 0, float_ = 0;
  std::map<std::uint32_t, std::uint32_t> constants_;  ///< ids of uint constants
  Words* target_ = nullptr;                           ///< null before the first function
  Words result_;
};

}  // namespace

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vkCreateShaderModule(VkDevice device, const VkShaderModuleCreateInfo* info,
                                                               const VkAllocationCallbacks* callbacks,
                                                               VkShaderModule* module) {
  const auto next = reinterpret_cast<PFN_vkCreateShaderModule>(::dlsym(RTLD_NEXT, "vkCreateShaderModule"));
  const char* const errors = std::getenv("DOLP_VULKAN_ARITHMETIC");
  if (errors == nullptr) return next(device, info, callbacks, module);
  const Rewriting rewriting({info->pCode, info->codeSize / sizeof(std::uint32_t)}, Errors(errors));
  VkShaderModuleCreateInfo changed = *info;
  changed.codeSize = rewriting.result().size() * sizeof(std::uint32_t);
  changed.pCode = rewriting.result().data();
  return next(device, &changed, callbacks, module);
}
