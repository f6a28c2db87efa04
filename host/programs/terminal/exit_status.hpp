#pragma once

namespace dolp {

inline constexpr int kExitDone = 0;
inline constexpr int kExitAccuracy = 1;
inline constexpr int kExitInput = 2;
inline constexpr int kExitDevice = 3;
inline constexpr int kExitIo = 4;
inline constexpr int kExitInternal = 5;
inline constexpr int kExitMemory = 6;
inline constexpr int kExitInterrupted = 130;

}  // namespace dolp
