// The files of a product, with their addresses.
//
// Texts of a catalogue may hold placeholders: {parameter} is the word that chose the product, {1}, {2} ... are
// the groups of its pattern, {tile} is the name of a tile, {hundred:N} is the range of a hundred that holds the
// number in group N (041277: 041200_041299), and {phase:N} is the phase of the HiRISE mission for the orbit in
// group N.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/app/get/catalogue.h"

namespace vpe::app {

// Chooses among what a product has.
struct ProductChoice {
  std::string parameter;           // empty for products without one
  std::vector<std::string> tiles;  // empty: all
};

// Describes one file to fetch.
struct RemoteFile {
  std::string address;
  std::string name;
  std::int64_t bytes = 0;        // 0 if it is not known
  std::int64_t about_bytes = 0;  // equal to `bytes` if that is known
  std::string md5;
  std::string sha256;
  std::string md5_address;
  bool is_input = true;
  std::vector<std::string> inside;
};

// Returns the files of a product, tile by tile. Throws std::runtime_error for placeholders that are not known,
// and if an address or a file name comes out that is not usable.
std::vector<RemoteFile> product_files(const Product& product, const ProductChoice& choice);

// Returns true if the whole word matches the pattern. Throws std::regex_error for a pattern that is none.
bool matches_parameter(const CatalogueParameter& parameter, const std::string& word);

// Returns the phase of the HiRISE mission as IDs of observations begin with it: PSP below orbit 11200, ESP
// above. The camera took no images between orbits 11000 and 11258 (solar conjunction of December 2008). Throws
// std::runtime_error for orbits before the primary science phase, which have no DTMs.
std::string hirise_phase(int orbit);

}  // namespace vpe::app
