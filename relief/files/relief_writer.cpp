#include <toml++/toml.h>

#include <set>
#include <stdexcept>

#include "relief/files/relief_file.h"
#include "relief/relief.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace relief {

namespace {

// Returns the number as TOML reads it back to the bit.
std::string relief_number(double value) {
  const std::string text = vpe::base::format_number(value);
  return text == "-0" ? "-0.0" : text;  // a whole number has no sign of zero
}

// Returns the text in quotation marks. Throws std::invalid_argument if it is not in UTF-8 or has control characters.
std::string relief_quoted(const std::string& text) {
  // Three apostrophes would be taken for a text of several lines.
  const bool has_three = text.find("'''") != std::string::npos;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\'' && has_three) {
      out += "\\u0027";
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
  const bool has_control = text.find('\t') != std::string::npos;
  try {
    (void)toml::parse("a = " + out);
  } catch (const toml::parse_error&) {
    throw std::invalid_argument(vpe::base::quote_text(text) +
                                ": expected a text in UTF-8 without control characters");
  }
  if (has_control)
    throw std::invalid_argument(vpe::base::quote_text(text) + ": expected a text without control characters");
  return out;
}

std::string polygon_list(std::span<const mars::LonLat> corners) {
  std::string text = "[";
  for (const mars::LonLat& corner : corners) {
    text += (text.size() > 1 ? ", [" : "[") + relief_number(corner.lon_deg) + ", " +
            relief_number(corner.lat_deg) + "]";
  }
  return text + "]";
}

std::string value_text(const vpe::core::KeyInfo& info, const vpe::core::KeyValue& value,
                       const ReliefSpec& spec) {
  if (info.name == "polygon") return polygon_list(spec.polygon);
  if (const auto* number = std::get_if<double>(&value)) return relief_number(*number);
  if (const auto* number = std::get_if<vpe::core::NumberOrWord>(&value); number != nullptr && number->number)
    return relief_number(*number->number);
  if (std::holds_alternative<vpe::core::IntegerKey>(info.type)) return vpe::core::print_value(info, value);
  return relief_quoted(vpe::core::print_value(info, value));
}

}  // namespace

std::string to_toml(std::span<const ReliefSpec> reliefs) {
  static const ReliefSpec kUsual;
  if (reliefs.size() > kMostReliefs)
    throw std::invalid_argument("expected at most " + std::to_string(kMostReliefs) + " reliefs");
  const auto& keys = relief_keys();
  std::set<std::string> names;
  std::string text = "version = 1\n";
  for (std::size_t n = 0; n < reliefs.size(); ++n) {
    const ReliefSpec& spec = reliefs[n];
    if (const std::string problem = problem_of(spec); !problem.empty())
      throw std::invalid_argument(relief_title(spec, n + 1) + ": " + problem);
    if (!spec.name.empty() && !names.insert(spec.name).second)
      throw std::invalid_argument("there are two reliefs " + vpe::base::quote_text(spec.name));
    text += "\n[[relief]]\n";
    for (std::size_t key = 0; key < keys.infos().size(); ++key) {
      const vpe::core::KeyInfo& info = keys.infos()[key];
      const vpe::core::KeyValue value = keys.get(key, spec);
      const bool is_usual =
          vpe::core::print_value(info, value) == vpe::core::print_value(info, keys.get(key, kUsual));
      if (is_usual && !needs_key(spec.kind, key)) continue;
      text += std::string(info.name) + " = " + value_text(info, value, spec) + "\n";
    }
  }
  return text;
}

void write_relief_file(std::span<const ReliefSpec> reliefs, const std::filesystem::path& path) {
  vpe::base::write_file(path, to_toml(reliefs));
}

}  // namespace relief
