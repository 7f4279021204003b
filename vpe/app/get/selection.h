// The products that a command line names.
#pragma once

#include <string>
#include <vector>

#include "vpe/app/get/catalogue.h"
#include "vpe/app/get/product_files.h"

namespace vpe::app {

struct SelectedProduct {
  const Product* product = nullptr;  // in the catalogue
  ProductChoice choice;
  std::vector<RemoteFile> files;
};

// Returns the products that the words name, in their order. A word after a product with a parameter is the
// parameter if it matches the pattern; several such words choose several files. `tiles` apply to all products
// that have tiles. Products that are named twice appear once. Throws UsageError for words that name nothing,
// with what may have been meant, for a parameter that is missing, and for tiles that no product has. The
// catalogue must outlive the result.
std::vector<SelectedProduct> select_products(const Catalogue& catalogue, const std::vector<std::string>& words,
                                             const std::vector<std::string>& tiles);

// Returns the product of this name. Throws UsageError with what may have been meant.
const Product& require_product(const Catalogue& catalogue, const std::string& name);

}  // namespace vpe::app
