#include "vpe/explore/results/result_files.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "mars/vector/field_types.h"
#include "vpe/base/file.h"

namespace vpe::explore {

namespace {

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string csv_of_layer(const mars::FeatureLayer& layer) {
  std::string text;
  for (std::size_t n = 0; n < layer.fields.size(); ++n) text += (n > 0 ? "," : "") + csv_cell(layer.fields[n]);
  text += "\n";
  for (const mars::Feature& feature : layer.features) {
    for (std::size_t n = 0; n < feature.values.size(); ++n)
      text += (n > 0 ? "," : "") + csv_cell(mars::field_text(feature.values[n]));
    text += "\n";
  }
  return text;
}

void write_result(const std::filesystem::path& file, const mars::FeatureLayer& layer,
                  const mars::FeatureFileInfo& info, const std::string& csv) {
  std::string end = file.extension().string();
  std::ranges::transform(end, end.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (end == ".csv") return base::write_file(file, csv);
  if (end != ".geojson" && end != ".json" && end != ".gpkg")
    throw std::runtime_error(file.string() + ": cannot write: let the name end in .csv, .geojson or .gpkg");
  mars::write_features(file, layer, info);
}

}  // namespace vpe::explore
