#include "vpe/core/backend.h"

#include "vpe/core/registry/former_names.h"

namespace vpe::core {

std::string_view to_string(Backend backend) { return backend == Backend::kPolygon ? "polygon" : "ray"; }

std::optional<Backend> parse_backend(std::string_view text) {
  const std::string_view name = current_name(NameKind::kBackend, text);
  for (const Backend backend : {Backend::kPolygon, Backend::kRay}) {
    if (name == to_string(backend)) return backend;
  }
  return std::nullopt;
}

}  // namespace vpe::core
