#include "objects/files/uri.h"

namespace objects {

std::string decoded_uri(const std::string& uri) {
  if (uri.starts_with("data:")) return uri;
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string name;
  for (std::size_t n = 0; n < uri.size(); ++n) {
    if (uri[n] == '%' && n + 2 < uri.size() && digit(uri[n + 1]) >= 0 && digit(uri[n + 2]) >= 0) {
      name += static_cast<char>(16 * digit(uri[n + 1]) + digit(uri[n + 2]));
      n += 2;
    } else {
      name += uri[n];
    }
  }
  return name;
}

}  // namespace objects
