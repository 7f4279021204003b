#include <toml++/toml.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "relief/files/relief_file.h"
#include "relief/relief.h"
#include "relief/spec_polygon.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_table.h"

namespace relief {

namespace {

constexpr std::string_view kExtension = ".relief.toml";

class ReliefTomlReader {
 public:
  explicit ReliefTomlReader(const std::filesystem::path& path) : file_(path.string()) {}

  std::vector<ReliefSpec> read(const toml::table& root) {
    for (const auto& [key, node] : root) {
      if (key != "version" && key != "relief")
        fail(node, "unknown key " + vpe::base::quote_text(key.str()) + "; keys are version and relief");
    }
    const toml::node* version = root.get("version");
    if (version == nullptr) fail(root, "version is missing; expected version = 1");
    if (version->value_exact<std::int64_t>() != 1) fail(*version, "version: expected 1");
    const toml::node* node = root.get("relief");
    if (node == nullptr) return {};
    const toml::array* tables = node->as_array();
    if (tables == nullptr) fail(*node, "relief: expected tables [[relief]]");
    if (tables->size() > kMostReliefs) {
      fail(*node, "expected at most " + std::to_string(kMostReliefs) + " reliefs, found " +
                      std::to_string(tables->size()));
    }
    std::vector<ReliefSpec> reliefs;
    for (const toml::node& one : *tables) {
      if (!one.is_table()) fail(one, "relief: expected tables [[relief]]");
      reliefs.push_back(read_relief(*one.as_table()));
    }
    return reliefs;
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw std::runtime_error(
        file_ + ":" + std::to_string(std::max<std::uint32_t>(1, node.source().begin.line)) + ": " + what);
  }

  ReliefSpec read_relief(const toml::table& table) {
    const auto& keys = relief_keys();
    ReliefSpec spec;
    const std::size_t kind = *keys.find("kind");
    set(table, kind, spec);  // the other keys depend on it
    for (const auto& [name, node] : table) {
      const auto key = keys.find(name.str());
      if (!key) fail_unknown(node, name.str(), spec.kind);
      if (!has_key(spec.kind, *key)) {
        fail(node, std::string(name.str()) + ": a " + std::string(kind_word(spec.kind)) +
                       " has no such key; its keys are " + keys_of(spec.kind));
      }
      set(table, *key, spec);
    }
    for (std::size_t key = 0; key < keys.infos().size(); ++key) {
      if (needs_key(spec.kind, key)) require(table, key);
    }
    if (const std::string problem = problem_of(spec); !problem.empty()) fail(table, problem);
    if (!spec.name.empty() && !names_.insert(spec.name).second)
      fail(*table.get("name"), "there are two reliefs " + vpe::base::quote_text(spec.name));
    return spec;
  }

  [[noreturn]] void fail_unknown(const toml::node& node, std::string_view name, ReliefKind kind) const {
    const std::string hint = vpe::core::did_you_mean(name, relief_keys().infos());
    fail(node,
         "unknown key " + vpe::base::quote_text(name) + " in [[relief]]; " +
             (hint.empty() ? "keys of a " + std::string(kind_word(kind)) + " are " + keys_of(kind) : hint));
  }

  void require(const toml::table& table, std::size_t key) const {
    const std::string name(relief_keys().infos()[key].name);
    if (!table.contains(name)) fail(table, name + " is missing in [[relief]]");
  }

  void set(const toml::table& table, std::size_t key, ReliefSpec& spec) const {
    require(table, key);
    const vpe::core::KeyInfo& info = relief_keys().infos()[key];
    const toml::node& node = *table.get(info.name);
    const std::string problem = set_key(spec, key, text_of(node, info));
    if (!problem.empty()) fail(node, problem);
  }

  // Returns the value as set_key() reads it. A number in quotation marks is none.
  std::string text_of(const toml::node& node, const vpe::core::KeyInfo& info) const {
    const bool is_number = std::holds_alternative<vpe::core::NumberKey>(info.type) ||
                           std::holds_alternative<vpe::core::NumberOrWordKey>(info.type) ||
                           std::holds_alternative<vpe::core::IntegerKey>(info.type);
    const auto* text = node.as_string();
    if (info.name == "polygon") return polygon_text(node);
    if (is_number) {
      if (const auto* real = node.as_floating_point()) return vpe::base::format_shortest(real->get());
      if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
      if (text != nullptr && !vpe::base::parse_number(text->get())) return text->get();
    } else if (text != nullptr) {
      return text->get();
    }
    fail(node,
         std::string(info.name) + ": expected " + vpe::core::allowed_text(info) + ", found " + kind_of(node));
  }

  static std::string kind_of(const toml::node& node) {
    if (node.is_string()) return "a text";
    if (node.is_array()) return "a list";
    if (node.is_table()) return "a table";
    return node.is_boolean() ? "true or false" : "a number";
  }

  std::string polygon_text(const toml::node& node) const {
    const toml::array* corners = node.as_array();
    constexpr const char* kForm = "polygon: expected a list of corners [lon, lat]";
    if (corners == nullptr || corners->size() > kMostPolygonCorners) {
      fail(node, std::string(kForm) + ", at most " + std::to_string(kMostPolygonCorners));
    }
    std::string text;
    for (const toml::node& corner : *corners) {
      const toml::array* parts = corner.as_array();
      if (parts == nullptr || parts->size() != 2) fail(corner, kForm);
      const auto lon_deg = (*parts)[0].value<double>();
      const auto lat_deg = (*parts)[1].value<double>();
      if (!(*parts)[0].is_number() || !(*parts)[1].is_number() || !lon_deg || !lat_deg) fail(corner, kForm);
      text += (text.empty() ? "" : ";") + vpe::base::format_shortest(*lon_deg) + "," +
              vpe::base::format_shortest(*lat_deg);
    }
    return text;
  }

  std::string file_;
  std::set<std::string> names_;
};

}  // namespace

bool is_relief_path(const std::filesystem::path& path) {
  return path.filename().string().ends_with(kExtension);
}

std::vector<ReliefSpec> parse_relief_toml(std::string_view text, const std::filesystem::path& path) {
  const std::string file = path.string();
  if (text.size() > kMostReliefFileBytes) {
    throw std::runtime_error(file + ":1: expected at most " + std::to_string(kMostReliefFileBytes >> 20U) +
                             " MiB");
  }
  return ReliefTomlReader(path).read(vpe::base::parse_toml(text, file));
}

std::vector<ReliefSpec> read_relief_file(const std::filesystem::path& path) {
  if (!is_relief_path(path))
    throw vpe::base::file_error("read", path, "it is no file of reliefs", "name it *.relief.toml");
  const std::vector<std::uint8_t> bytes = vpe::base::read_file(path, kMostReliefFileBytes);
  return parse_relief_toml({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace relief
