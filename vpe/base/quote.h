// Unexpected text in messages.
#pragma once

#include <string>
#include <string_view>

namespace vpe::base {

// Returns the text in double quotes, shortened to some 40 bytes and safe for a terminal: control characters and
// bytes that are not UTF-8 become '?'. Everything else stays as it is.
std::string quote_text(std::string_view text);

}  // namespace vpe::base
