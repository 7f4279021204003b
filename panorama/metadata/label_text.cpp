// PDS3 labels (through mars::parse_pds_label) and VICAR labels, which are one line of KEY=value.
#include <array>
#include <map>

#include "mars/raster/pds_label.h"
#include "panorama/metadata/label_values.h"
#include "panorama/metadata/xml.h"

namespace panorama {

namespace {

// Both spellings occur.
constexpr std::array<const char*, 2> kGroups{"SURFACE_PROJECTION_PARMS", "SURFACE_PROJECTION_PARAMS"};

constexpr std::size_t kMaxName = 100;

// Holds values by "SECTION.KEY"; of equal keys the first counts.
using VicarLabel = std::map<std::string, std::string, std::less<>>;

bool is_vicar(std::string_view text) { return text.starts_with("LBLSIZE="); }

class VicarReader {
 public:
  explicit VicarReader(std::string_view text) : text_(text) {}

  VicarLabel read() {
    VicarLabel label;
    std::string section;
    for (;;) {
      skip_blank();
      const std::size_t equals = text_.find('=', at_);
      if (at_ >= text_.size() || text_[at_] == '\0' || equals == std::string_view::npos) return label;
      const std::string key(trim(text_.substr(at_, equals - at_)));
      at_ = equals + 1;
      const std::string value = read_value();
      // A new property, or a task of the history that follows the properties, begins a section. Its name stands
      // before all of its keys: a long one, which no reader needs, is cut.
      if (key == "PROPERTY" || key == "TASK") section = value.substr(0, kMaxName) + ".";
      label.emplace(section + key, value);
    }
  }

 private:
  void skip_blank() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r')) ++at_;
  }

  // Inside of strings, quotes are doubled.
  std::string read_string() {
    std::string value;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\'') {
        ++at_;
        if (at_ >= text_.size() || text_[at_] != '\'') return value;
      }
      value += text_[at_];
    }
    return value;
  }

  std::string read_value() {
    skip_blank();
    if (at_ >= text_.size()) return {};
    if (text_[at_] == '\'') return read_string();
    const bool is_list = text_[at_] == '(';
    std::size_t end = text_.find(is_list ? ')' : ' ', at_);
    if (end == std::string_view::npos) end = text_.size();
    if (is_list && end < text_.size()) ++end;
    std::string value(text_.substr(at_, end - at_));
    at_ = end;
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::string_view unquoted(std::string_view text) {
  text = trim(text);
  if (text.size() >= 2 && (text.front() == '\'' || text.front() == '"') && text.back() == text.front()) {
    text = text.substr(1, text.size() - 2);
  }
  return trim(text);
}

// Returns item `index` of "(a, b)"; the value itself when it is no list.
std::string item(std::string_view text, std::size_t index) {
  text = trim(text);
  if (!text.starts_with('(')) return std::string(unquoted(text));
  text.remove_prefix(1);
  if (text.ends_with(')')) text.remove_suffix(1);
  for (; index > 0; --index) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return {};
    text.remove_prefix(comma + 1);
  }
  return std::string(unquoted(text.substr(0, text.find(','))));
}

// Splits "21.4 <pix/deg>" into value and unit.
LabelValue with_unit(const std::string& text) {
  const std::size_t open = text.find('<');
  if (open == std::string::npos) return {text, ""};
  const std::size_t close = std::min(text.find('>', open), text.size());
  return {std::string(trim(std::string_view(text).substr(0, open))), text.substr(open + 1, close - open - 1)};
}

// Returns the key in the label and the item of its value that a key of LabelLookup means.
std::pair<std::string, std::size_t> key_and_index(std::string_view key) {
  if (key == "MAP_RESOLUTION_X") return {"MAP_RESOLUTION", 0};
  if (key == "MAP_RESOLUTION_Y") return {"MAP_RESOLUTION", 1};
  return {std::string(key), 0};
}

RoverLabel read_vicar(const VicarLabel& label, const std::string& group) {
  return label_of([&](std::string_view asked) -> std::optional<LabelValue> {
    if (asked == "LINES" || asked == "LINE_SAMPLES") {
      const auto found = label.find(asked == "LINES" ? "NL" : "NS");
      return found == label.end() ? std::nullopt : std::optional(LabelValue{found->second, ""});
    }
    const auto [key, index] = key_and_index(asked);
    const auto found = label.find(group + "." + key);
    if (found == label.end()) return std::nullopt;
    const auto unit = label.find(group + "." + key + "__UNIT");
    return LabelValue{item(found->second, index), unit == label.end() ? "" : item(unit->second, index)};
  });
}

RoverLabel read_pds3(const mars::PdsLabel& label, const std::string& group) {
  return label_of([&](std::string_view asked) -> std::optional<LabelValue> {
    const auto [key, index] = key_and_index(asked);
    const bool is_of_image = asked == "LINES" || asked == "LINE_SAMPLES";
    const auto found = label.values.find((is_of_image ? "IMAGE" : group) + "." + key);
    if (found == label.values.end()) return std::nullopt;
    return with_unit(item(found->second, index));
  });
}

}  // namespace

bool is_label_start(std::string_view text) {
  return is_vicar(text) || text.starts_with("PDS_VERSION_ID") || text.starts_with("ODL_VERSION_ID") ||
         text.starts_with("CCSD");
}

std::optional<RoverLabel> read_text_label(std::string_view text) {
  if (is_vicar(text)) {
    const VicarLabel label = VicarReader(text).read();
    for (const std::string group : kGroups) {
      if (label.contains(group + ".PROPERTY")) return read_vicar(label, group);
    }
    return std::nullopt;
  }
  const mars::PdsLabel label = mars::parse_pds_label(text);
  for (const std::string group : kGroups) {
    const auto first = label.values.lower_bound(group + ".");
    if (first != label.values.end() && first->first.starts_with(group + ".")) return read_pds3(label, group);
  }
  return std::nullopt;
}

}  // namespace panorama
