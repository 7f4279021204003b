#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "paging/build/build_inputs.h"
#include "vpe/base/number.h"

#ifndef VPE_VERSION
#define VPE_VERSION "0"
#endif

namespace paging {

namespace {

// Must be raised whenever equal sources and options give other tiles than before within a version of the
// program.
constexpr int kBuilderRevision = 8;

constexpr std::string_view kPlaceMark = "place of ";  // begins lines that portable_fingerprint() leaves out
constexpr std::size_t kMostDifferences = 4;
constexpr std::size_t kMostLetters = 80;  // of a value, for people

// Appends a line for each thing that is known of each source.
void append_sources(std::string& text, const std::string& what, const std::string& json_text,
                    const PlanetMeta& meta) {
  const nlohmann::json list = nlohmann::json::parse(json_text);
  text += what + "s = " + std::to_string(list.size()) + "\n";
  std::size_t number = 0;
  for (const nlohmann::json& source : list) {
    const std::string label = what + " " + std::to_string(++number);
    for (const auto& [key, value] : source.items()) {
      const bool is_place = key == "name" || key == "mtime_s";
      if (is_place && source.contains("content")) text += kPlaceMark;
      text += label + " " + key + " = ";
      text += (key == "treatment" ? without_folders(value.dump(), meta) : value.dump()) + "\n";
    }
  }
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Returns what stands before and after " = " by line; a line without it counts as its own label.
std::map<std::string, std::string> values_of(const std::string& fingerprint) {
  std::map<std::string, std::string> values;
  for (const std::string& line : lines_of(fingerprint)) {
    const std::size_t at = line.find(" = ");
    values[line.substr(0, at)] = at == std::string::npos ? "" : line.substr(at + 3);
  }
  return values;
}

// Replaces the number of a source by its file's name.
std::string named(const std::string& label, const PlanetMeta& meta) {
  const auto replace = [&](const std::string& what,
                           const std::vector<mars::SourceInfo>& sources) -> std::string {
    for (std::size_t n = 0; n < sources.size(); ++n) {
      const std::string begin = what + " " + std::to_string(n + 1) + " ";
      if (label.starts_with(begin)) return what + " " + sources[n].name + ": " + label.substr(begin.size());
    }
    return {};
  };
  for (const std::string& text :
       {replace("elevation source", meta.sources), replace("image source", meta.image_sources)})
    if (!text.empty()) return text;
  return label;
}

std::string shortened(const std::string& value) {
  return value.size() <= kMostLetters ? value : value.substr(0, kMostLetters) + "...";
}

}  // namespace

std::string without_folders(std::string treatment, const PlanetMeta& meta) {
  for (const auto* sources : {&meta.sources, &meta.image_sources}) {
    for (const mars::SourceInfo& source : *sources) {
      const std::string name = std::filesystem::path(source.name).filename().string();
      if (name.empty() || name == source.name) continue;
      for (std::size_t at = 0; (at = treatment.find(source.name, at)) != std::string::npos; at += name.size())
        treatment.replace(at, source.name.size(), name);
    }
  }
  return treatment;
}

std::string build_settings(const BuildOptions& options) {
  std::string text = "program = vpe " VPE_VERSION " builder " + std::to_string(kBuilderRevision) + "\n";
  const auto add = [&](const std::string& label, double value) {
    text += label + " = " + vpe::base::format_number(value) + "\n";
  };
  add("mesh ratio", options.mesh_ratio);
  add("image quality", options.image_quality);
  return text;
}

std::string build_fingerprint(const BuildOptions& options, const PlanetMeta& meta) {
  using vpe::base::format_number;
  std::string text = build_settings(options);
  text += "compared posts = " + std::to_string(options.resampling_posts) + "\n";
  text += "base spacing = " + format_number(options.base_spacing_m) + "\n";
  text += "finest spacing = " + format_number(options.finest_spacing_m) + "\n";
  text += "finest image = " + format_number(options.finest_image_m) + "\n";
  text += "regions =";
  for (const Region& r : options.regions) {
    text += " " + format_number(r.west_deg) + "," + format_number(r.south_deg) + "," +
            format_number(r.east_deg) + "," + format_number(r.north_deg);
  }
  text += "\n";
  const auto rows = to_rows(meta);
  for (const auto& [key, value] : rows) {
    if (key != kMetaChecksumKey && key != "sources" && key != "image_sources" && key != kBuildSettingsKey &&
        key != kArgumentsKey)
      text += key + " = " + value + "\n";
  }
  append_sources(text, "elevation source", rows.at("sources"), meta);
  append_sources(text, "image source", rows.at("image_sources"), meta);
  if (!options.shard.is_all()) text += fingerprint_line(options.shard);
  return text;
}

std::string patch_line(const std::string& identity) { return "begun with the tiles of " + identity + "\n"; }

std::string portable_fingerprint(const std::string& fingerprint) {
  std::string text;
  for (const std::string& line : lines_of(fingerprint))
    if (!line.starts_with(kPlaceMark)) text += line + "\n";
  return text;
}

std::vector<std::string> fingerprint_differences(const std::string& is, const std::string& not_this,
                                                 const PlanetMeta& meta) {
  const auto values = values_of(is);
  auto others = values_of(not_this);
  std::vector<std::string> texts;
  for (const auto& [label, value] : values) {
    const auto other = others.find(label);
    if (other == others.end()) {
      texts.push_back(named(label, meta) + " is " + shortened(value) + " here alone");
    } else if (other->second != value) {
      texts.push_back(named(label, meta) + " is " + shortened(value) + ", not " + shortened(other->second));
    }
  }
  for (const auto& [label, value] : others)
    if (!values.contains(label))
      texts.push_back(named(label, meta) + " is " + shortened(value) + " there alone");
  if (texts.size() > kMostDifferences) {
    const std::size_t more = texts.size() - kMostDifferences;
    texts.resize(kMostDifferences);
    texts.push_back("and " + std::to_string(more) + " more");
  }
  return texts;
}

std::string fingerprint_line(const vpe::base::Shard& shard) {
  return "part " + std::to_string(shard.number) + " of " + std::to_string(shard.of) + "\n";
}

}  // namespace paging
