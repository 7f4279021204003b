#include "objects/reader/gltf_json.h"

#include <cmath>

#include "objects/reader/refusal.h"

namespace objects {

const Json& list_of(const Json& object, const char* key) {
  static const Json kNone = Json::array();
  const auto found = object.find(key);
  if (found == object.end()) return kNone;
  if (!found->is_array()) throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" is not an array");
  for (const Json& entry : *found)
    if (!entry.is_object()) throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" has no objects");
  return *found;
}

std::optional<std::uint64_t> whole_of(const Json& object, const char* key, std::uint64_t most) {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_number_unsigned() || found->get<std::uint64_t>() > most)
    throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" is not a whole number from 0 to " +
                  std::to_string(most));
  return found->get<std::uint64_t>();
}

std::optional<std::size_t> index_of(const Json& object, const char* key, std::size_t size) {
  if (!object.contains(key)) return {};
  if (size == 0)
    throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" names an entry of an empty list");
  return whole_of(object, key, size - 1);
}

void check_numbers(const Json& object, const char* key, std::size_t count) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  bool ok = found->is_array() && found->size() == count;
  if (ok) {
    for (const Json& x : *found) ok = ok && x.is_number() && std::isfinite(x.get<double>());
  }
  if (!ok)
    throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" has not " + std::to_string(count) +
                  " numbers");
}

double number_of(const Json& object, const char* key, double missing) {
  const auto found = object.find(key);
  if (found == object.end()) return missing;
  if (!found->is_number() || !std::isfinite(found->get<double>()))
    throw Refusal("its JSON is damaged: \"" + std::string(key) + "\" is not a number");
  return found->get<double>();
}

Json picked(const Json& object, std::initializer_list<const char*> keys) {
  Json result = Json::object();
  for (const char* key : keys) {
    const auto found = object.find(key);
    if (found != object.end()) result[key] = *found;
  }
  return result;
}

}  // namespace objects
