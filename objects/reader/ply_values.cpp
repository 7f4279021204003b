#include "objects/reader/ply_values.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

#include "objects/reader/ply_words.h"
#include "objects/reader/refusal.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

constexpr std::size_t kPlyPiece_bytes = std::size_t{1} << 20;  // also the most of a header and of a line
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

double number_of_word(std::string_view word) {
  if (word.empty()) throw Refusal("one of its lines has too few numbers");
  std::string_view digits = word;
  if (digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (parsed.ptr != digits.data() + digits.size() || parsed.ec == std::errc::invalid_argument)
    throw Refusal("it has the word " + vpe::base::quote_text(word) + " where a number should be");
  // from_chars() leaves the value as it was where a double cannot hold it; strtod() gives 0 or infinity.
  return parsed.ec == std::errc() ? value : std::strtod(std::string(digits).c_str(), nullptr);
}

template <class T>
double stored_number(std::string_view bytes, bool is_big) {
  static_assert(std::endian::native == std::endian::little);
  char copy[sizeof(T)];
  std::copy_n(bytes.data(), sizeof(T), copy);
  if (is_big) std::reverse(std::begin(copy), std::end(copy));
  T value{};
  std::memcpy(&value, copy, sizeof(T));
  return static_cast<double>(value);
}

}  // namespace

PlyValues::PlyValues(const std::filesystem::path& path) : file_(path, std::ios::binary) {
  std::error_code failure;
  file_bytes_ = std::filesystem::file_size(path, failure);
  if (!file_ || failure) throw Refusal("it cannot be opened", "check the permissions");
  piece_.resize(2 * kPlyPiece_bytes);
  header_ = parse_ply_header(ahead(kPlyPiece_bytes));
  at_ += header_.bytes;
}

std::string_view PlyValues::ahead(std::size_t bytes) {
  if (end_ - at_ < bytes && file_) {
    std::copy(piece_.begin() + static_cast<std::ptrdiff_t>(at_),
              piece_.begin() + static_cast<std::ptrdiff_t>(end_), piece_.begin());
    end_ -= at_;
    at_ = 0;
    file_.read(piece_.data() + end_, static_cast<std::streamsize>(piece_.size() - end_));
    end_ += static_cast<std::size_t>(file_.gcount());
    if (file_.bad()) throw Refusal("it cannot be read", "check the disk");
  }
  return {piece_.data() + at_, end_ - at_};
}

void PlyValues::check_size(const PlyElement& element) const {
  std::uint64_t least = 0;
  for (const PlyProperty& property : element.properties)
    least += header_.format == PlyFormat::kText ? 2 : property.least_bytes();
  // The last word of a text needs nothing behind it.
  if (least > 0 && element.count > (file_bytes_ - header_.bytes + 1) / least) throw Refusal("it ends early");
}

void PlyValues::next(const PlyElement& element, std::vector<double>& values) {
  values.clear();
  if (header_.format == PlyFormat::kText)
    next_text(element, values);
  else
    next_binary(element, values);
}

void PlyValues::next_text(const PlyElement& element, std::vector<double>& values) {
  // Most lines end in what is there already.
  std::string_view rest = ahead(1);
  if (rest.find('\n') == std::string_view::npos) rest = ahead(kPlyPiece_bytes);
  std::string_view line;
  const std::size_t bytes = rest.size();
  if (!next_line(rest, line)) throw Refusal("it ends early");
  if (line.size() >= kPlyPiece_bytes) throw Refusal("one of its lines is too long");
  at_ += bytes - rest.size();
  for (const PlyProperty& property : element.properties) {
    if (!property.is_list) {
      values.push_back(number_of_word(next_word(line)));
      continue;
    }
    const std::uint64_t entries = ply_count(next_word(line), kMostPlyListEntries);
    for (std::uint64_t n = 0; n < entries; ++n) number_of_word(next_word(line));
    values.push_back(kNoNumber);
  }
}

double PlyValues::number(PlyType type) {
  const std::size_t bytes = bytes_of(type);
  const std::string_view from = ahead(bytes);
  if (from.size() < bytes) throw Refusal("it ends early");
  at_ += bytes;
  const bool is_big = header_.format == PlyFormat::kBigEndian;
  switch (type) {
    case PlyType::kInt8: return stored_number<std::int8_t>(from, is_big);
    case PlyType::kUint8: return stored_number<std::uint8_t>(from, is_big);
    case PlyType::kInt16: return stored_number<std::int16_t>(from, is_big);
    case PlyType::kUint16: return stored_number<std::uint16_t>(from, is_big);
    case PlyType::kInt32: return stored_number<std::int32_t>(from, is_big);
    case PlyType::kUint32: return stored_number<std::uint32_t>(from, is_big);
    case PlyType::kFloat32: return stored_number<float>(from, is_big);
    case PlyType::kFloat64: return stored_number<double>(from, is_big);
  }
  return kNoNumber;
}

void PlyValues::next_binary(const PlyElement& element, std::vector<double>& values) {
  for (const PlyProperty& property : element.properties) {
    if (!property.is_list) {
      values.push_back(number(property.type));
      continue;
    }
    const double entries = number(property.count_type);
    if (!(entries >= 0 && entries <= static_cast<double>(kMostPlyListEntries)))
      throw Refusal("one of its lists is too long");
    for (double n = 0; n < entries; ++n) number(property.type);
    values.push_back(kNoNumber);
  }
}

}  // namespace objects
