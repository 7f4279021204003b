// A list of layers in their order, each of which can be switched off. Settings hold those that are on; the list remembers the
// others and where they were.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace vpe::explore {

// Holds a layer and whether it is shown.
template <class Item>
struct Switched {
  Item item;
  bool is_on = true;
  bool operator==(const Switched&) const = default;
};

// Holds layers, the lowest first.
template <class Item>
using SwitchedList = std::vector<Switched<Item>>;

// Returns the layers that are on, in their order. Pure.
template <class Item>
std::vector<Item> items_on(const SwitchedList<Item>& list) {
  std::vector<Item> on;
  for (const Switched<Item>& one : list)
    if (one.is_on) on.push_back(one.item);
  return on;
}

// Returns a list whose layers that are on are `on`, in this order. Layers of the former list that are not among them stay,
// switched off, above the layer that was below them before. `name` selects the member by which layers are the same. Pure.
template <class Item>
SwitchedList<Item> with_on(const SwitchedList<Item>& former, const std::vector<Item>& on,
                           std::string Item::*name) {
  SwitchedList<Item> list;
  for (const Item& item : on) list.push_back({item, true});
  std::size_t below = 0;  // layers of `list` up to the one that was below
  for (const Switched<Item>& one : former) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const Switched<Item>& other) {
      return other.item.*name == one.item.*name;
    });
    if (found != list.end()) {
      below = static_cast<std::size_t>(found - list.begin()) + 1;
      continue;
    }
    list.insert(list.begin() + static_cast<std::ptrdiff_t>(below), Switched<Item>{one.item, false});
    ++below;
  }
  return list;
}

// Moves a layer up or down by one. Returns false if there is no layer on that side. Pure.
template <class Item>
bool move_by_one(SwitchedList<Item>& list, std::size_t index, bool up) {
  const std::size_t other = up ? index + 1 : index - 1;
  if (index >= list.size() || other >= list.size()) return false;
  std::swap(list[index], list[other]);
  return true;
}

}  // namespace vpe::explore
