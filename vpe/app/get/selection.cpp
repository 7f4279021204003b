#include "vpe/app/get/selection.h"

#include <algorithm>
#include <stdexcept>

#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/core/registry/key_registry.h"

namespace vpe::app {

namespace {

std::string suggestion(const Catalogue& catalogue, const std::string& name) {
  std::vector<core::KeyInfo> keys;
  for (const Product& product : catalogue) {
    core::KeyInfo key;
    key.name = product.name;
    keys.push_back(key);
  }
  const std::string words = core::did_you_mean(name, keys);
  return words.empty() ? "'vpe get' lists the products" : words;
}

std::vector<std::string> chosen_tiles(const Product& product, const std::vector<std::string>& tiles,
                                      std::vector<bool>& used) {
  std::vector<std::string> chosen;
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    if (std::ranges::find(product.tiles, tiles[n]) == product.tiles.end()) continue;
    used[n] = true;
    if (std::ranges::find(chosen, tiles[n]) == chosen.end()) chosen.push_back(tiles[n]);
  }
  return chosen;
}

std::string tile_names(const std::vector<SelectedProduct>& selected) {
  std::string names;
  for (const SelectedProduct& s : selected) {
    for (const std::string& tile : s.product->tiles) names += (names.empty() ? "" : ", ") + tile;
  }
  return names;
}

// Sets the tiles and the files of all products.
void complete(std::vector<SelectedProduct>& selected, const std::vector<std::string>& tiles) {
  std::vector<bool> used(tiles.size(), false);
  for (SelectedProduct& s : selected) {
    s.choice.tiles = chosen_tiles(*s.product, tiles, used);
    try {
      s.files = product_files(*s.product, s.choice);
    } catch (const std::runtime_error& e) {
      throw UsageError(s.product->name + " " + s.choice.parameter + ": " + e.what());
    }
  }
  const auto unused = std::ranges::find(used, false);
  if (unused == used.end()) return;
  const std::string names = tile_names(selected);
  throw UsageError("--tile " + on_one_line(tiles[static_cast<std::size_t>(unused - used.begin())]) + ": " +
                   (names.empty() ? "no product named here has tiles" : "no such tile; there are " + names));
}

}  // namespace

const Product& require_product(const Catalogue& catalogue, const std::string& name) {
  const Product* product = find_product(catalogue, name);
  if (product == nullptr)
    throw UsageError("no product is called '" + on_one_line(name) + "'; " + suggestion(catalogue, name));
  return *product;
}

std::vector<SelectedProduct> select_products(const Catalogue& catalogue, const std::vector<std::string>& words,
                                             const std::vector<std::string>& tiles) {
  std::vector<SelectedProduct> selected;
  const auto add = [&](const Product& product, const std::string& parameter) {
    const bool is_new = std::ranges::none_of(selected, [&](const SelectedProduct& s) {
      return s.product == &product && s.choice.parameter == parameter;
    });
    if (is_new) selected.push_back({&product, {parameter, {}}, {}});
  };
  for (std::size_t at = 0; at < words.size();) {
    const Product& product = require_product(catalogue, words[at++]);
    if (!product.parameter) {
      add(product, "");
      continue;
    }
    const CatalogueParameter& parameter = *product.parameter;
    const std::size_t first = at;
    while (at < words.size() && matches_parameter(parameter, words[at])) add(product, words[at++]);
    if (at > first) continue;
    throw UsageError("'" + product.name + "' needs " + parameter.name + ", such as " + parameter.example +
                     (at < words.size() ? "; '" + on_one_line(words[at]) + "' is none" : ""));
  }
  complete(selected, tiles);
  return selected;
}

}  // namespace vpe::app
