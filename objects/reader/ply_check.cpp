#include "objects/reader/ply_check.h"

#include <cstdint>
#include <string_view>
#include <vector>

#include "objects/reader/model_folder.h"
#include "objects/reader/ply_header.h"
#include "objects/reader/ply_words.h"
#include "objects/reader/refusal.h"
#include "vpe/base/file.h"

namespace objects {

namespace {

void check_text(const PlyHeader& header, std::string_view rest) {
  for (const PlyElement& element : header.elements) {
    for (std::uint64_t n = 0; n < element.count; ++n) {
      std::string_view line;
      if (!next_line(rest, line)) throw Refusal("it ends early");
      for (const PlyProperty& property : element.properties) {
        std::string_view word = next_word(line);
        if (property.is_list) {
          const std::uint64_t entries = ply_count(word, kMostPlyListEntries);
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
  const bool is_big = header.format == PlyFormat::kBigEndian;
  for (const PlyElement& element : header.elements) {
    std::uint64_t fixed = 0;
    bool has_lists = false;
    for (const PlyProperty& property : element.properties) {
      fixed += bytes_of(property.type);
      has_lists = has_lists || property.is_list;
    }
    if (!has_lists) {
      skip(element.count * fixed);
      continue;
    }
    for (std::uint64_t n = 0; n < element.count; ++n) {
      for (const PlyProperty& property : element.properties) {
        if (!property.is_list) {
          skip(bytes_of(property.type));
          continue;
        }
        const std::size_t size = bytes_of(property.count_type);
        if (size > rest.size()) throw Refusal("it ends early");
        const std::uint64_t entries = list_count(rest, size, is_big);
        skip(size);
        if (entries > kMostPlyListEntries) throw Refusal("one of its lists is too long");
        skip(entries * bytes_of(property.type));
      }
    }
  }
}

}  // namespace

void check_ply(const std::filesystem::path& path) {
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, ModelFolder::kMostBytes);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const PlyHeader header = parse_ply_header(text);
  if (header.format == PlyFormat::kText)
    check_text(header, text.substr(header.bytes));
  else
    check_binary(header, text.substr(header.bytes));
}

}  // namespace objects
