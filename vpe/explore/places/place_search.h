// Search of named places, and of coordinates, as a user types.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/core/appearance/gazetteer.h"

namespace vpe::explore {

// Returns text in lower case without accents of Latin letters and without punctuation: "Árgyre-Planitia" gives
// "argyre planitia". Other characters stay. Pure.
std::string folded(std::string_view text);

// Finds places by name. Immutable after its construction: any number of threads may search.
//
// Typical usage:
//   const PlaceSearch search(core::read_gazetteer(file));
//   for (const core::Place* place : search.find("olymp", 8)) list(place->name);
class PlaceSearch {
 public:
  // Takes places in the order of their importance, as core::read_gazetteer() returns them: larger ones first.
  explicit PlaceSearch(std::vector<core::Place> places = {});

  const std::vector<core::Place>& places() const { return places_; }

  // Returns at most `most` places whose names match: equal names first, then those that begin with the text, those
  // with a word that begins with it, those that contain it, and those within one typing error (two from eight
  // letters on) of the text at their beginning or that of a word. Within each kind the order is that of the list.
  // Case, accents and punctuation do not count. An empty text matches nothing. Takes some 0.3 ms for 2000 places.
  std::vector<const core::Place*> find(std::string_view text, std::size_t most) const;

  // Returns the place with this name, or null.
  const core::Place* named(std::string_view name) const;

 private:
  std::vector<core::Place> places_;
  std::vector<std::string> folded_;  // names, in the same order
};

// Names the best known places of Mars, for lists that begin with them.
extern const std::span<const std::string_view> kSights;

// Puts the best known places first; the others keep their order.
std::vector<core::Place> sights_first(std::vector<core::Place> places);

// Returns the number of single-letter errors (another letter, one more, one less, two neighbours exchanged) by
// which `typed` differs from the beginning of `word`; `most` + 1 if it is more than `most`. Pure.
int typing_errors(std::string_view typed, std::string_view word, int most);

}  // namespace vpe::explore
