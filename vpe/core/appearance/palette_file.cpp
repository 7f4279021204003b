// Reader of palette files.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/palette.h"

namespace vpe::core {

namespace {

constexpr std::uintmax_t kMostBytes = 1 << 20;
constexpr double kFarthestStop = 1e12;  // of Palette

struct Line {
  std::size_t number;
  double at;
  bool is_percent;
  glm::dvec3 rgb;
};

class Parser {
 public:
  explicit Parser(std::string_view name) : name_(name) {}

  Palette parse(std::string_view text) {
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::size_t end = text.find('\n');
      read(number, text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    if (lines_.empty()) {
      throw std::runtime_error(place() + ": it holds no colours; expected lines '" + kForm + "'");
    }
    return palette();
  }

 private:
  static constexpr const char* kForm = "value r g b";

  std::string place() const { return "cannot read the palette '" + name_ + "'"; }

  [[noreturn]] void fail(std::size_t number, const std::string& what) const {
    throw std::runtime_error(place() + ", line " + std::to_string(number) + ": " + what);
  }

  static std::string quoted(std::string_view text) {
    constexpr std::size_t kMost = 40;
    std::string out = "\"";
    for (const char c : text.substr(0, kMost)) out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    return out + (text.size() > kMost ? "...\"" : "\"");
  }

  void read(std::size_t number, std::string_view line) {
    const std::string_view all = line.substr(0, line.find('#'));
    std::vector<std::string_view> words;
    for (std::string_view rest = all;;) {
      constexpr std::string_view kSeparators = " \t,:\r";
      const std::size_t begin = rest.find_first_not_of(kSeparators);
      if (begin == std::string_view::npos) break;
      rest.remove_prefix(begin);
      words.push_back(rest.substr(0, rest.find_first_of(kSeparators)));
      rest.remove_prefix(words.back().size());
    }
    if (words.empty()) return;
    if (words.size() != 4 && words.size() != 5) {
      fail(number, std::string("expected '") + kForm + " [a]', numbers apart by blanks or commas, found " +
                       quoted(all));
    }
    std::string_view at = words[0];
    const bool is_nodata = at == "nv";
    const bool is_percent = !at.empty() && at.back() == '%';
    if (is_percent) at.remove_suffix(1);
    const std::optional<double> value = is_nodata ? 0.0 : base::parse_number(at);
    if (!value || !(std::abs(*value) <= kFarthestStop)) {
      fail(number, "expected a value, a fraction, a percentage or nv, found " + quoted(words[0]));
    }
    if (is_percent && !(*value >= 0 && *value <= 100)) {
      fail(number, "expected 0 % to 100 %, found " + quoted(words[0]));
    }
    glm::dvec3 rgb{};
    for (std::size_t c = 1; c < words.size(); ++c) {
      const std::optional<double> part = base::parse_number(words[c]);
      if (!part || !(*part >= 0 && *part <= 255)) {
        fail(number, "expected red, green and blue (and alpha) from 0 to 255, found " + quoted(words[c]));
      }
      if (c < 4) rgb[static_cast<glm::length_t>(c) - 1] = *part;
    }
    if (is_nodata) {
      has_nodata_ = true;
      return;
    }
    if (!lines_.empty() && lines_.front().is_percent != is_percent) {
      fail(number, "expected " + std::string(is_percent ? "a value" : "a percentage") +
                       " as before: values and percentages do not go together; found " + quoted(words[0]));
    }
    lines_.push_back({number, *value, is_percent, rgb});
  }

  Palette palette() {
    if (lines_.front().at > lines_.back().at) std::reverse(lines_.begin(), lines_.end());
    std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) { return a.at < b.at; });
    for (std::size_t n = 2; n < lines_.size(); ++n) {
      if (lines_[n].at != lines_[n - 2].at) continue;
      fail(std::max({lines_[n].number, lines_[n - 1].number, lines_[n - 2].number}),
           "expected at most two lines of one value, found a third of " + base::format_number(lines_[n].at));
    }
    const bool is_percent = lines_.front().is_percent;
    const bool has_fractions = is_percent || (!has_nodata_ && lines_.front().at == 0 && lines_.back().at == 1);
    std::vector<PaletteStop> stops;
    stops.reserve(lines_.size());
    for (const Line& line : lines_) stops.push_back({is_percent ? line.at / 100 : line.at, line.rgb});
    return {has_fractions ? Palette::Scale::kFraction : Palette::Scale::kValue, std::move(stops)};
  }

  std::string name_;
  std::vector<Line> lines_;
  bool has_nodata_ = false;
};

}  // namespace

Palette parse_palette(std::string_view text, std::string_view name) { return Parser(name).parse(text); }

Palette read_palette(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, kMostBytes);
  return parse_palette({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

}  // namespace vpe::core
