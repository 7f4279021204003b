#include "objects/reader/ply_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/reader/model_folder.h"
#include "objects/reader/refusal.h"
#include "vpe/base/file.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

constexpr std::uint64_t kMostListEntries = 1'000'000;

struct PlyType {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::array<PlyType, 16> kPlyTypes = {{{"char", 1},
                                                {"uchar", 1},
                                                {"int8", 1},
                                                {"uint8", 1},
                                                {"short", 2},
                                                {"ushort", 2},
                                                {"int16", 2},
                                                {"uint16", 2},
                                                {"int", 4},
                                                {"uint", 4},
                                                {"int32", 4},
                                                {"uint32", 4},
                                                {"float", 4},
                                                {"float32", 4},
                                                {"double", 8},
                                                {"float64", 8}}};

struct PlyProperty {
  std::size_t bytes = 0;
  std::size_t count_bytes = 0;  // of a list; 0: no list
};

struct PlyElement {
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  std::string format;
  std::vector<PlyElement> elements;
};

class PlyText {
 public:
  explicit PlyText(std::string_view text) : rest_(text) {}

  // Returns false at the end; a line that the file's end cuts off counts.
  bool next_line(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return true;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

std::uint64_t count_of(std::string_view word, std::uint64_t most) {
  if (word.empty()) throw Refusal("one of its lines has too few numbers");
  std::uint64_t count = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), count);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || count > most)
    throw Refusal("it claims a count of " + vpe::base::quote_text(word) + "; at most " + std::to_string(most) +
                  " are read");
  return count;
}

std::size_t bytes_of_type(std::string_view word) {
  for (const PlyType& type : kPlyTypes)
    if (type.name == word) return type.bytes;
  throw Refusal("its header has the unknown type " + vpe::base::quote_text(word));
}

PlyHeader header_of(PlyText& text) {
  PlyHeader header;
  std::string_view line;
  if (!text.next_line(line) || next_word(line) != "ply") throw Refusal("it does not begin with \"ply\"");
  while (text.next_line(line)) {
    const std::string_view key = next_word(line);
    if (key == "end_header") {
      if (header.format.empty()) throw Refusal("its header does not say its format");
      return header;
    }
    if (key == "format") {
      header.format = next_word(line);
      if (header.format != "ascii" && header.format != "binary_little_endian" &&
          header.format != "binary_big_endian")
        throw Refusal("its format " + vpe::base::quote_text(header.format) + " is not read");
    } else if (key == "element") {
      next_word(line);
      header.elements.push_back({count_of(next_word(line), MeshLimits::kMostTriangles), {}});
    } else if (key == "property") {
      if (header.elements.empty()) throw Refusal("its header is damaged");
      PlyProperty property;
      std::string_view type = next_word(line);
      if (type == "list") {
        property.count_bytes = bytes_of_type(next_word(line));
        type = next_word(line);
      }
      property.bytes = bytes_of_type(type);
      header.elements.back().properties.push_back(property);
    }
  }
  throw Refusal("its header has no end");
}

void check_text(const PlyHeader& header, PlyText& text) {
  for (const PlyElement& element : header.elements) {
    for (std::uint64_t n = 0; n < element.count; ++n) {
      std::string_view line;
      if (!text.next_line(line)) throw Refusal("it ends early");
      for (const PlyProperty& property : element.properties) {
        std::string_view word = next_word(line);
        if (property.count_bytes > 0) {
          const std::uint64_t entries = count_of(word, kMostListEntries);
          for (std::uint64_t k = 0; k < entries; ++k) word = next_word(line);
        }
        if (word.empty()) throw Refusal("one of its lines has too few numbers");
      }
    }
  }
}

std::uint64_t list_count(std::string_view bytes, std::size_t size, bool is_big) {
  std::uint64_t count = 0;
  for (std::size_t n = 0; n < size; ++n)
    count |= std::uint64_t{static_cast<std::uint8_t>(bytes[n])} << 8 * (is_big ? size - 1 - n : n);
  return count;
}

void check_binary(const PlyHeader& header, std::string_view rest) {
  const auto skip = [&](std::uint64_t bytes) {
    if (bytes > rest.size()) throw Refusal("it ends early");
    rest.remove_prefix(bytes);
  };
  const bool is_big = header.format == "binary_big_endian";
  for (const PlyElement& element : header.elements) {
    std::uint64_t fixed = 0;
    bool has_lists = false;
    for (const PlyProperty& property : element.properties) {
      fixed += property.bytes;
      has_lists = has_lists || property.count_bytes > 0;
    }
    if (!has_lists) {
      skip(element.count * fixed);
      continue;
    }
    for (std::uint64_t n = 0; n < element.count; ++n) {
      for (const PlyProperty& property : element.properties) {
        if (property.count_bytes == 0) {
          skip(property.bytes);
          continue;
        }
        if (property.count_bytes > rest.size()) throw Refusal("it ends early");
        const std::uint64_t entries = list_count(rest, property.count_bytes, is_big);
        skip(property.count_bytes);
        if (entries > kMostListEntries) throw Refusal("one of its lists is too long");
        skip(entries * property.bytes);
      }
    }
  }
}

}  // namespace

void check_ply(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, ModelFolder::kMostBytes);
  PlyText text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  const PlyHeader header = header_of(text);
  if (header.format == "ascii")
    check_text(header, text);
  else
    check_binary(header, text.rest());
}

}  // namespace objects
