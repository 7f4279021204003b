// Types of fields, found by their values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "mars/vector/feature.h"

namespace mars {

// Names the type of a field.
enum class FieldType : std::uint8_t { integer, number, text };

// Returns the type that holds all values of a field: integer if all are, number if all are integers or numbers, else
// text; text for a field without values. Pure.
FieldType field_type(const FeatureLayer& layer, std::size_t field);

// Returns a value as text, "" for none. Numbers come back from it to the bit. Pure.
std::string field_text(const FieldValue& value);

}  // namespace mars
