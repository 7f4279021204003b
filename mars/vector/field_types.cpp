#include "mars/vector/field_types.h"

#include "vpe/base/number.h"

namespace mars {

FieldType field_type(const FeatureLayer& layer, std::size_t field) {
  bool has_value = false;
  bool has_number = false;
  for (const Feature& feature : layer.features) {
    if (field >= feature.values.size()) continue;
    const FieldValue& value = feature.values[field];
    if (std::holds_alternative<std::string>(value)) return FieldType::text;
    has_value = has_value || !std::holds_alternative<std::monostate>(value);
    has_number = has_number || std::holds_alternative<double>(value);
  }
  if (!has_value) return FieldType::text;
  return has_number ? FieldType::number : FieldType::integer;
}

std::string field_text(const FieldValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&value)) return vpe::base::format_number(*number);
  return "";
}

}  // namespace mars
