// Small PLY files for tests, in all three formats.
//
// Typical usage:
//   PlyMaker ply(PlyMaker::Kind::kText, "element vertex 1\nproperty float x\nproperty uchar red\n");
//   ply.add(0.5F).add(std::uint8_t{200}).end();
//   write_text("a.ply", ply.bytes());
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>

namespace objects::test_support {

// Gathers the numbers of elements, which must have the types that the header says.
class PlyMaker {
 public:
  enum class Kind { kText, kLittle, kBig };

  PlyMaker(Kind kind, const std::string& elements) : kind_(kind) {
    bytes_ = std::string("ply\nformat ") +
             (kind == Kind::kText     ? "ascii"
              : kind == Kind::kLittle ? "binary_little_endian"
                                      : "binary_big_endian") +
             " 1.0\ncomment of a test\n" + elements + "end_header\n";
  }
  // Add a number, and end a line of text.
  template <class T>
  PlyMaker& add(T value) {
    if (kind_ == Kind::kText) {
      bytes_ += (bytes_.back() == '\n' ? "" : " ") + text(value);
      return *this;
    }
    char stored[sizeof(T)];
    std::memcpy(stored, &value, sizeof(T));
    if (kind_ == Kind::kBig) std::reverse(std::begin(stored), std::end(stored));
    bytes_.append(stored, sizeof(T));
    return *this;
  }
  PlyMaker& end() {
    if (kind_ == Kind::kText) bytes_ += '\n';
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  static std::string text(T value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value)) return std::isnan(value) ? "nan" : "inf";
    }
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(value));
    return digits;
  }

  Kind kind_;
  std::string bytes_;
};

}  // namespace objects::test_support
