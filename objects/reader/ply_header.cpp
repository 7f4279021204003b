#include "objects/reader/ply_header.h"

#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "objects/model/mesh.h"
#include "objects/reader/ply_words.h"
#include "objects/reader/refusal.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> kPlyTypes = {{{"char", PlyType::kInt8},
                                                                             {"uchar", PlyType::kUint8},
                                                                             {"int8", PlyType::kInt8},
                                                                             {"uint8", PlyType::kUint8},
                                                                             {"short", PlyType::kInt16},
                                                                             {"ushort", PlyType::kUint16},
                                                                             {"int16", PlyType::kInt16},
                                                                             {"uint16", PlyType::kUint16},
                                                                             {"int", PlyType::kInt32},
                                                                             {"uint", PlyType::kUint32},
                                                                             {"int32", PlyType::kInt32},
                                                                             {"uint32", PlyType::kUint32},
                                                                             {"float", PlyType::kFloat32},
                                                                             {"float32", PlyType::kFloat32},
                                                                             {"double", PlyType::kFloat64},
                                                                             {"float64", PlyType::kFloat64}}};

PlyType ply_type(std::string_view word) {
  for (const auto& [name, type] : kPlyTypes)
    if (name == word) return type;
  throw Refusal("its header has the unknown type " + vpe::base::quote_text(word));
}

PlyFormat ply_format(std::string_view word) {
  if (word == "ascii") return PlyFormat::kText;
  if (word == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (word == "binary_big_endian") return PlyFormat::kBigEndian;
  throw Refusal("its format " + vpe::base::quote_text(word) + " is not read");
}

PlyProperty ply_property(std::string_view line) {
  PlyProperty property;
  std::string_view type = next_word(line);
  property.is_list = type == "list";
  if (property.is_list) {
    property.count_type = ply_type(next_word(line));
    type = next_word(line);
  }
  property.type = ply_type(type);
  property.name = next_word(line);
  return property;
}

}  // namespace

std::size_t bytes_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8: return 1;
    case PlyType::kInt16:
    case PlyType::kUint16: return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32: return 4;
    case PlyType::kFloat64: return 8;
  }
  return 8;
}

std::uint64_t ply_count(std::string_view word, std::uint64_t most) {
  if (word.empty()) throw Refusal("one of its lines has too few numbers");
  std::uint64_t count = 0;
  const auto parsed = std::from_chars(word.data(), word.data() + word.size(), count);
  if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || count > most)
    throw Refusal("it claims a count of " + vpe::base::quote_text(word) + "; at most " + std::to_string(most) +
                  " are read");
  return count;
}

PlyHeader parse_ply_header(std::string_view text) {
  PlyHeader header;
  std::optional<PlyFormat> format;
  std::string_view rest = text;
  std::string_view line;
  if (!next_line(rest, line) || next_word(line) != "ply") throw Refusal("it does not begin with \"ply\"");
  while (next_line(rest, line)) {
    const std::string_view key = next_word(line);
    if (key == "end_header") {
      if (!format) throw Refusal("its header does not say its format");
      header.format = *format;
      header.bytes = text.size() - rest.size();
      return header;
    }
    if (key == "format") {
      format = ply_format(next_word(line));
    } else if (key == "element") {
      const std::string name(next_word(line));
      header.elements.push_back({name, ply_count(next_word(line), MeshLimits::kMostVertices), {}});
    } else if (key == "property") {
      if (header.elements.empty()) throw Refusal("its header is damaged");
      header.elements.back().properties.push_back(ply_property(line));
    }
  }
  throw Refusal("its header has no end");
}

}  // namespace objects
