#include "vpe/app/get/listing.h"

#include <cstdio>

#include "vpe/app/cli/figures.h"

namespace vpe::app {

namespace {

std::string size_text(const Product& product) {
  const std::int64_t bytes = total_bytes(product);
  if (bytes == 0) return "size unknown";
  return bytes_text(static_cast<double>(bytes)) + (product.parameter ? " each" : "");
}

std::string call_of(const Product& product) {
  return product.name + (product.parameter ? " " + product.parameter->name : "");
}

std::string listed(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

}  // namespace

std::int64_t total_bytes(const Product& product) {
  std::int64_t total = 0;
  for (const CatalogueFile& file : product.files) {
    const std::int64_t bytes = file.bytes > 0 ? file.bytes : file.about_bytes;
    if (bytes == 0) return 0;
    total += bytes;
  }
  return total * static_cast<std::int64_t>(std::max<std::size_t>(1, product.tiles.size()));
}

std::string catalogue_listing(const Catalogue& catalogue) {
  std::string out;
  for (const Product& p : catalogue) {
    char head[160];
    std::snprintf(head, sizeof head, "%-16s %-8s %-10s %-9s ", call_of(p).c_str(), p.body.c_str(),
                  p.is_image ? "image" : "elevation", length_text(p.resolution_m, 3).c_str());
    out += std::string(head) + size_text(p) + "; " + p.licence + "\n    " + p.what + "\n";
  }
  return out;
}

std::string product_text(const Product& p) {
  std::string out = call_of(p) + ": " + p.what + "\n";
  const auto add = [&out](const std::string& name, const std::string& text) {
    if (!text.empty()) out += "  " + name + ": " + text + "\n";
  };
  add("body", p.body);
  add("kind", p.is_image ? "image" : "elevation");
  add("resolution", length_text(p.resolution_m));
  add("datum", p.datum);
  add("size", size_text(p));
  add("licence", p.licence);
  add("credit", p.credit);
  add("page", p.page);
  for (const std::string& note : p.notes) add("note", note);
  if (p.parameter) add(p.parameter->name, "such as " + p.parameter->example);
  add("tiles", listed(p.tiles));
  for (const CatalogueFile& file : p.files) {
    add("address", file.address);
    add("  checksum", !file.sha256.empty()        ? "SHA-256 " + file.sha256
                      : !file.md5.empty()         ? "MD5 " + file.md5
                      : !file.md5_address.empty() ? "MD5 at " + file.md5_address
                                                  : "");
    add("  rasters in it", listed(file.inside));
  }
  return out;
}

nlohmann::json product_json(const Product& p) {
  using nlohmann::json;
  const auto optional_text = [](const std::string& text) { return text.empty() ? json(nullptr) : json(text); };
  const auto optional_bytes = [](std::int64_t bytes) { return bytes == 0 ? json(nullptr) : json(bytes); };
  json files = json::array();
  for (const CatalogueFile& f : p.files) {
    files.push_back({{"address", f.address},
                     {"name", optional_text(f.name)},
                     {"bytes", optional_bytes(f.bytes)},
                     {"about_bytes", optional_bytes(f.bytes > 0 ? f.bytes : f.about_bytes)},
                     {"md5", optional_text(f.md5)},
                     {"sha256", optional_text(f.sha256)},
                     {"md5_address", optional_text(f.md5_address)},
                     {"input", f.is_input},
                     {"inside", f.inside}});
  }
  return {{"name", p.name},
          {"body", p.body},
          {"kind", p.is_image ? "image" : "elevation"},
          {"what", p.what},
          {"resolution_m", p.resolution_m},
          {"datum", optional_text(p.datum)},
          {"licence", p.licence},
          {"credit", p.credit},
          {"page", optional_text(p.page)},
          {"notes", p.notes},
          {"tiles", p.tiles},
          {"parameter", p.parameter ? json{{"name", p.parameter->name},
                                           {"pattern", p.parameter->pattern},
                                           {"example", p.parameter->example}}
                                    : json(nullptr)},
          {"about_bytes", optional_bytes(total_bytes(p))},
          {"files", files}};
}

}  // namespace vpe::app
