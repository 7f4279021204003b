#include "vpe/app/film/frame_range.h"

#include <optional>
#include <string_view>

#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

FrameRange parse_frames(const std::string& text, std::int64_t count) {
  if (text.empty()) return {0, count - 1, 1};
  std::string_view rest = text;
  std::optional<std::int64_t> step = 1;
  if (const std::size_t x = rest.find('x'); x != std::string_view::npos) {
    step = base::parse_integer(rest.substr(x + 1));
    rest = rest.substr(0, x);
  }
  const std::size_t dash = rest.find('-');
  const std::optional<std::int64_t> first = base::parse_integer(rest.substr(0, dash));
  const std::optional<std::int64_t> last =
      dash == std::string_view::npos ? first : base::parse_integer(rest.substr(dash + 1));
  if (!first || !last || !step || *step < 1 || *first < 0 || *last < *first || *last >= count) {
    throw UsageError("--frames '" + text + "': expected A-B or A-BxN within 0-" + std::to_string(count - 1));
  }
  return {*first, *last, *step};
}

}  // namespace vpe::app
