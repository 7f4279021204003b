// Texts of `vpe get` about products, without fetching them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vpe/app/get/catalogue.h"

namespace vpe::app {

// Returns the size of all files of a product in bytes, 0 if that of one is not known. For products with a
// parameter it is the size of one of them.
std::int64_t total_bytes(const Product& product);

// Returns one or two lines for each product: name, body, kind, size, licence, and what it is.
std::string catalogue_listing(const Catalogue& catalogue);

// Returns all that the catalogue says of a product, line by line.
std::string product_text(const Product& product);

// Returns the same as JSON.
nlohmann::json product_json(const Product& product);

}  // namespace vpe::app
