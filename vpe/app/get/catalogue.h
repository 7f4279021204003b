// The catalogue of public products that `vpe get` fetches: a TOML file with one table [[product]] for each
// product and one [[product.file]] for each of its files. docs/guide/data.md explains the keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::app {

// Describes one file of a product. Texts may hold the placeholders of product_files.h.
struct CatalogueFile {
  std::string address;           // begins with http:// or https://
  std::string name;              // of the file on disk; empty: the last part of the address
  std::int64_t bytes = 0;        // exact size, 0 if it is not known
  std::int64_t about_bytes = 0;  // for display and for the check of free space, 0 if it is not known
  std::string md5;               // hexadecimal; empty: not known
  std::string sha256;            // hexadecimal; empty: not known
  std::string md5_address;       // of a file whose first word is the MD5 checksum; empty: none
  bool is_input = true;          // it is named in the line for `vpe build`: not so for the data beside a label
  std::vector<std::string> inside;  // the rasters in it, if it is a ZIP archive
};

// Describes the word that chooses one of many products of a kind.
struct CatalogueParameter {
  std::string name;     // for messages: "ID"
  std::string pattern;  // ECMAScript regular expression that matches the whole word
  std::string example;  // matches the pattern
};

struct Product {
  std::string name;  // small letters, digits and hyphens
  std::string body;  // one of mars::bodies()
  bool is_image = false;
  std::string what;
  double resolution_m = 0;
  std::string datum;  // as `vpe build --datum` takes it; empty for images
  std::string licence;
  std::string credit;
  std::string page;  // address of the description; empty: none
  std::vector<std::string> notes;
  std::vector<std::string> tiles;  // names of the tiles for which each file exists; empty: no tiles
  std::optional<CatalogueParameter> parameter;
  std::vector<CatalogueFile> files;  // in the order in which they are fetched
};

using Catalogue = std::vector<Product>;

// Returns the catalogue in a TOML text. Throws std::runtime_error "NAME:LINE: ..." for a text that is not TOML,
// for unknown, missing and unusable keys, and for two products of one name.
Catalogue parse_catalogue(std::string_view text, const std::string& name);

// Returns the catalogue in a file. Throws base::FileError, and what parse_catalogue() throws.
Catalogue read_catalogue(const std::filesystem::path& file);

// Returns the catalogue that the program holds.
Catalogue embedded_catalogue();

// Returns the product of this name, or null.
const Product* find_product(const Catalogue& catalogue, std::string_view name);

// Returns true for an address that may be fetched: http:// or https:// with a host, without spaces and control
// characters.
bool is_web_address(std::string_view address);

// Returns true if a text is usable as the name of a file in the user's folder: no slash, no leading dot, no
// control character, not empty.
bool is_plain_file_name(std::string_view name);

}  // namespace vpe::app
