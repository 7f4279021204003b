#include "vpe/app/get/catalogue.h"

#include <toml++/toml.h>

#include <algorithm>
#include <regex>
#include <stdexcept>

#include "mars/geodesy/bodies.h"
#include "mars/geodesy/datum.h"
#include "vpe/app/get/catalogue_text.h"
#include "vpe/app/get/product_files.h"
#include "vpe/base/file.h"
#include "vpe/base/toml_table.h"

namespace vpe::app {

namespace {

constexpr std::uintmax_t kMaxCatalogue_bytes = 4 << 20;

bool is_hex(const std::string& text, std::size_t digits) {
  return text.size() == digits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

class CatalogueReader {
 public:
  explicit CatalogueReader(std::string name) : name_(std::move(name)) {}

  Catalogue read(std::string_view text) {
    const toml::table root = base::parse_toml(text, name_);
    require_keys(root, {"product"}, "the catalogue");
    Catalogue catalogue;
    for (const toml::table* table : tables(root, "product")) {
      catalogue.push_back(product(*table));
      if (find_product(catalogue, catalogue.back().name) != &catalogue.back())
        fail(*table, "there are two products '" + catalogue.back().name + "'");
    }
    if (catalogue.empty()) throw std::runtime_error(name_ + ":1: has no [[product]]");
    return catalogue;
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw std::runtime_error(name_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void require_keys(const toml::table& table, const std::vector<std::string_view>& known,
                    const std::string& where) const {
    for (const auto& [key, node] : table) {
      if (std::ranges::find(known, key.str()) == known.end())
        fail(node, "unknown key '" + std::string(key.str()) + "' in " + where);
    }
  }

  std::vector<const toml::table*> tables(const toml::table& table, std::string_view key) const {
    std::vector<const toml::table*> all;
    const toml::node* node = table.get(key);
    if (node == nullptr) return all;
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(*node, "expected [[" + std::string(key) + "]]");
    for (const toml::node& entry : *list) {
      if (!entry.is_table()) fail(entry, "expected [[" + std::string(key) + "]]");
      all.push_back(entry.as_table());
    }
    return all;
  }

  std::string text(const toml::table& table, std::string_view key, bool is_required) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) {
      if (is_required) fail(table, "'" + std::string(key) + "' is missing");
      return "";
    }
    const auto* value = node->as_string();
    if (value == nullptr || value->get().empty()) fail(*node, "'" + std::string(key) + "': expected a text");
    return value->get();
  }

  std::vector<std::string> texts(const toml::table& table, std::string_view key) const {
    std::vector<std::string> all;
    const toml::node* node = table.get(key);
    if (node == nullptr) return all;
    const toml::array* list = node->as_array();
    if (list == nullptr) fail(*node, "'" + std::string(key) + "': expected a list of texts");
    for (const toml::node& entry : *list) {
      if (!entry.is_string()) fail(entry, "'" + std::string(key) + "': expected a list of texts");
      all.push_back(entry.as_string()->get());
    }
    return all;
  }

  std::int64_t size(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return 0;
    const auto* value = node->as_integer();
    if (value == nullptr || value->get() <= 0)
      fail(*node, "'" + std::string(key) + "': expected a number of bytes");
    return value->get();
  }

  std::string checksum(const toml::table& table, std::string_view key, std::size_t digits) const {
    std::string value = text(table, key, false);
    if (!value.empty() && !is_hex(value, digits))
      fail(*table.get(key), "'" + std::string(key) + "': expected " + std::to_string(digits) +
                                " hexadecimal digits in small letters");
    return value;
  }

  CatalogueFile file(const toml::table& table) const {
    require_keys(table,
                 {"address", "name", "bytes", "about_bytes", "md5", "sha256", "md5_address", "input", "inside"},
                 "[[product.file]]");
    CatalogueFile f;
    f.address = text(table, "address", true);
    f.name = text(table, "name", false);
    f.bytes = size(table, "bytes");
    f.about_bytes = size(table, "about_bytes");
    f.md5 = checksum(table, "md5", 32);
    f.sha256 = checksum(table, "sha256", 64);
    f.md5_address = text(table, "md5_address", false);
    f.inside = texts(table, "inside");
    if (const toml::node* node = table.get("input")) {
      if (!node->is_boolean()) fail(*node, "'input': expected true or false");
      f.is_input = node->as_boolean()->get();
    }
    return f;
  }

  CatalogueParameter parameter(const toml::table& table) const {
    require_keys(table, {"name", "pattern", "example"}, "[product.parameter]");
    CatalogueParameter p{text(table, "name", true), text(table, "pattern", true), text(table, "example", true)};
    try {
      if (!matches_parameter(p, p.example)) fail(*table.get("example"), "'example' does not match 'pattern'");
    } catch (const std::regex_error& e) {
      fail(*table.get("pattern"), "'pattern' is not a regular expression: " + std::string(e.what()));
    }
    return p;
  }

  Product product(const toml::table& table) const {
    require_keys(table,
                 {"name", "body", "kind", "what", "resolution_m", "datum", "licence", "credit", "page", "notes",
                  "tiles", "parameter", "file"},
                 "[[product]]");
    Product p;
    p.name = text(table, "name", true);
    if (p.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos ||
        p.name[0] == '-')
      fail(*table.get("name"), "'name': expected small letters, digits and hyphens");
    p.body = text(table, "body", true);
    if (mars::find_body(std::string_view(p.body)) == nullptr)
      fail(*table.get("body"), "'body': '" + p.body + "' is not known");
    read_kind(table, p);
    p.what = text(table, "what", true);
    p.licence = text(table, "licence", true);
    p.credit = text(table, "credit", true);
    p.page = text(table, "page", false);
    p.notes = texts(table, "notes");
    p.tiles = texts(table, "tiles");
    const toml::node* resolution = table.get("resolution_m");
    p.resolution_m = resolution == nullptr ? 0 : resolution->value<double>().value_or(0);
    if (!(p.resolution_m > 0))
      fail(resolution == nullptr ? table : *resolution, "'resolution_m': expected metres");
    if (const toml::node* node = table.get("parameter")) {
      if (!node->is_table()) fail(*node, "expected [product.parameter]");
      p.parameter = parameter(*node->as_table());
    }
    for (const toml::table* entry : tables(table, "file")) {
      p.files.push_back(file(*entry));
      check_file(*entry, p);
    }
    if (p.files.empty()) fail(table, "'" + p.name + "' has no [[product.file]]");
    if (std::ranges::none_of(p.files, &CatalogueFile::is_input)) fail(table, "'" + p.name + "' has no input");
    return p;
  }

  void read_kind(const toml::table& table, Product& p) const {
    const std::string kind = text(table, "kind", true);
    if (kind != "elevation" && kind != "image") fail(*table.get("kind"), "'kind': expected elevation or image");
    p.is_image = kind == "image";
    p.datum = text(table, "datum", !p.is_image);
    if (p.datum.empty()) return;
    if (p.is_image) fail(*table.get("datum"), "'datum': images have none");
    if (!mars::parse_datum(p.datum, 1e6)) fail(*table.get("datum"), "'datum': '" + p.datum + "' is not one");
  }

  // Checks the last file by what it gives for the example and the first tile.
  void check_file(const toml::table& table, const Product& p) const {
    ProductChoice choice;
    if (p.parameter) choice.parameter = p.parameter->example;
    if (!p.tiles.empty()) choice.tiles = {p.tiles.front()};
    Product one = p;
    one.files = {p.files.back()};
    try {
      product_files(one, choice);
    } catch (const std::runtime_error& e) {
      fail(table, e.what());
    }
  }

  std::string name_;
};

}  // namespace

Catalogue parse_catalogue(std::string_view text, const std::string& name) {
  return CatalogueReader(name).read(text);
}

Catalogue read_catalogue(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, kMaxCatalogue_bytes);
  return parse_catalogue({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

Catalogue embedded_catalogue() {
  return parse_catalogue(catalogue_text::kCatalogue, "the program's catalogue");
}

const Product* find_product(const Catalogue& catalogue, std::string_view name) {
  const auto at = std::ranges::find(catalogue, name, &Product::name);
  return at == catalogue.end() ? nullptr : &*at;
}

bool is_web_address(std::string_view address) {
  const std::size_t host = address.starts_with("https://") ? 8 : address.starts_with("http://") ? 7 : 0;
  return host > 0 && address.size() > host && address[host] != '/' &&
         std::ranges::all_of(address, [](unsigned char c) { return c > 0x20 && c != 0x7f; });
}

bool is_plain_file_name(std::string_view name) {
  return !name.empty() && name.front() != '.' && name.size() < 200 &&
         std::ranges::all_of(name,
                             [](unsigned char c) { return c >= 0x20 && c != 0x7f && c != '/' && c != '\\'; });
}

}  // namespace vpe::app
