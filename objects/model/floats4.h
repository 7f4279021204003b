// Four floats at a time, by the vector types of g++ and clang: the same bits as one at a time.
#pragma once

#include <cstdint>

namespace objects::simd {

using Floats4 = float __attribute__((vector_size(16)));
using Mask4 = std::int32_t __attribute__((vector_size(16)));  // -1 or 0 in each lane

inline Floats4 all(float x) { return Floats4{x, x, x, x}; }
inline Floats4 min(const Floats4& a, const Floats4& b) { return a < b ? a : b; }
inline Floats4 max(const Floats4& a, const Floats4& b) { return a > b ? a : b; }

// Returns a bit for each lane, that of lane 0 lowest.
inline int bits(const Mask4& mask) { return (mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8); }

}  // namespace objects::simd
