// Access to the JSON of a glTF file that ends with a reason where it is damaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace objects {

using Json = nlohmann::json;

// Returns an array of objects, empty where the key is missing. Throws Refusal for anything else.
const Json& list_of(const Json& object, const char* key);

// Returns a whole number from 0 to most, or nullopt where the key is missing. Throws Refusal for anything else.
std::optional<std::uint64_t> whole_of(const Json& object, const char* key, std::uint64_t most);

// Returns an index into an array of this size, or nullopt where the key is missing. Throws Refusal for anything else.
std::optional<std::size_t> index_of(const Json& object, const char* key, std::size_t size);

// Throws Refusal unless the key is missing or has an array of so many finite numbers.
void check_numbers(const Json& object, const char* key, std::size_t count);

// Returns a number, or `missing` where the key is missing. Throws Refusal for anything else.
double number_of(const Json& object, const char* key, double missing);

// Returns the object's members of these keys.
Json picked(const Json& object, std::initializer_list<const char*> keys);

// Throws Refusal unless the nodes of the scene that is shown are trees of at most 1000 levels. The arrays exist.
void check_nodes(const Json& document);

// Throws Refusal unless the views lie in their buffers.
void check_views(const Json& document, std::optional<std::uint64_t> body_bytes);

// Returns the triangle primitives of the meshes with the attributes that a model keeps; `dropped` counts the others.
// Throws Refusal for arrays of unread types or beyond their buffers.
Json kept_meshes(const Json& document, std::size_t& dropped);

}  // namespace objects
