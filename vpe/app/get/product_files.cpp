#include "vpe/app/get/product_files.h"

#include <cstdio>
#include <regex>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::app {

namespace {

// Regular expressions are matched by recursion: longer words are not names of products.
constexpr std::size_t kMaxParameter_chars = 100;
constexpr int kFirstOrbitOfPsp = 1200;  // PSP_001330 is the first observation
constexpr int kFirstOrbitOfEsp = 11200;

// Replaces the placeholders of texts.
class Placeholders {
 public:
  Placeholders(const Product& product, const std::string& parameter) : parameter_(parameter) {
    if (!product.parameter) return;
    has_parameter_ = true;
    const std::regex pattern(product.parameter->pattern);
    if (!std::regex_match(parameter_, groups_, pattern))
      throw std::runtime_error("'" + parameter + "' does not match the pattern of '" + product.name + "'");
  }
  Placeholders(const Placeholders&) = delete;
  Placeholders& operator=(const Placeholders&) = delete;

  void set_tile(const std::string& tile) { tile_ = tile; }

  std::string fill(const std::string& text) const {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = text.find('{', at);
      out += text.substr(at, open - at);
      if (open == std::string::npos) break;
      const std::size_t close = text.find('}', open);
      if (close == std::string::npos) throw std::runtime_error("'" + text + "': a brace is not closed");
      out += value(text.substr(open + 1, close - open - 1));
      at = close + 1;
    }
    return out;
  }

 private:
  std::string value(const std::string& name) const {
    if (name == "parameter" && has_parameter_) return parameter_;
    if (name == "tile" && !tile_.empty()) return tile_;
    const std::size_t colon = name.find(':');
    const std::string function = colon == std::string::npos ? "" : name.substr(0, colon);
    const auto index = base::parse_integer(colon == std::string::npos ? name : name.substr(colon + 1));
    if (has_parameter_ && index && *index > 0 && *index < static_cast<std::int64_t>(groups_.size())) {
      const std::string group = groups_[static_cast<std::size_t>(*index)].str();
      if (function.empty() && colon == std::string::npos) return group;
      if (function == "hundred") return hundred(group);
      if (function == "phase") return hirise_phase(number(group));
    }
    throw std::runtime_error("{" + name + "} stands for nothing here");
  }

  static int number(const std::string& digits) {
    const auto value = base::parse_integer(digits);
    if (!value || *value < 0 || *value > 999'999) throw std::runtime_error("'" + digits + "' is not a number");
    return static_cast<int>(*value);
  }

  static std::string hundred(const std::string& digits) {
    const int first = number(digits) / 100 * 100;
    char text[32];
    std::snprintf(text, sizeof text, "%06d_%06d", first, first + 99);
    return text;
  }

  std::string parameter_;
  bool has_parameter_ = false;
  std::string tile_;
  std::smatch groups_;  // of parameter_
};

std::string last_part(const std::string& address) {
  const std::string path = address.substr(0, address.find_first_of("?#"));
  return path.substr(path.rfind('/') + 1);
}

RemoteFile remote_file(const CatalogueFile& file, const Placeholders& placeholders) {
  RemoteFile f{placeholders.fill(file.address),
               placeholders.fill(file.name),
               file.bytes,
               file.about_bytes,
               file.md5,
               file.sha256,
               placeholders.fill(file.md5_address),
               file.is_input,
               {}};
  if (f.bytes > 0) f.about_bytes = f.bytes;
  for (const std::string& inner : file.inside) f.inside.push_back(placeholders.fill(inner));
  if (!is_web_address(f.address)) throw std::runtime_error("'" + f.address + "' is not an http(s) address");
  if (!f.md5_address.empty() && !is_web_address(f.md5_address))
    throw std::runtime_error("'" + f.md5_address + "' is not an http(s) address");
  if (f.name.empty()) f.name = last_part(f.address);
  if (!is_plain_file_name(f.name))
    throw std::runtime_error("'" + f.address + "' does not end in the name of a file; give it with 'name'");
  return f;
}

}  // namespace

std::vector<RemoteFile> product_files(const Product& product, const ProductChoice& choice) {
  Placeholders placeholders(product, choice.parameter);
  std::vector<RemoteFile> files;
  const auto add_all = [&] {
    for (const CatalogueFile& file : product.files) files.push_back(remote_file(file, placeholders));
  };
  if (product.tiles.empty()) add_all();
  for (const std::string& tile : choice.tiles.empty() ? product.tiles : choice.tiles) {
    placeholders.set_tile(tile);
    add_all();
  }
  return files;
}

bool matches_parameter(const CatalogueParameter& parameter, const std::string& word) {
  return word.size() <= kMaxParameter_chars && std::regex_match(word, std::regex(parameter.pattern));
}

std::string hirise_phase(int orbit) {
  if (orbit < kFirstOrbitOfPsp)
    throw std::runtime_error("orbit " + std::to_string(orbit) + " precedes HiRISE's primary science phase");
  return orbit < kFirstOrbitOfEsp ? "PSP" : "ESP";
}

}  // namespace vpe::app
