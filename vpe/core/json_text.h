// JSON values as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vpe::core {

// Returns the text of a JSON value, indented by `indent` (-1: on one line). Bytes that are not UTF-8, as names of
// files may hold, become replacement characters; dump() alone throws for them.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// Returns the text as it reads after it was written as JSON.
inline std::string text_in_json(const std::string& text) {
  return nlohmann::json::parse(json_text(nlohmann::json(text))).get<std::string>();
}

}  // namespace vpe::core
