#include "panorama/xml.h"

#include <utility>

namespace panorama {

namespace {

constexpr int kMaxDepth = 100;

// Whether a name's prefix stands for the namespace where it is used.
bool is_of(std::string_view name, pugi::xml_node where, std::string_view uri, bool is_attribute) {
  const std::size_t colon = name.find(':');
  const bool has_prefix = colon != std::string_view::npos;
  if (is_attribute && !has_prefix) return false;  // attributes have no default namespace
  const std::string declaration = has_prefix ? "xmlns:" + std::string(name.substr(0, colon)) : "xmlns";
  for (; where; where = where.parent()) {
    if (const pugi::xml_attribute found = where.attribute(declaration.c_str())) return found.value() == uri;
  }
  return false;
}

class Collector : public pugi::xml_tree_walker {
 public:
  explicit Collector(std::string_view uri) : uri_(uri) {}

  bool for_each(pugi::xml_node& node) override {
    // Looking up prefixes takes time in proportion to the depth.
    if (depth() > kMaxDepth) throw MetadataError("XML nested deeper than " + std::to_string(kMaxDepth));
    if (node.type() != pugi::node_element) return true;
    for (const pugi::xml_attribute attribute : node.attributes()) {
      if (is_of(attribute.name(), node, uri_, true)) put(attribute.name(), attribute.value());
    }
    bool is_leaf = true;
    for (const pugi::xml_node child : node.children()) is_leaf = is_leaf && child.type() != pugi::node_element;
    if (is_leaf && is_of(node.name(), node, uri_, false)) put(node.name(), node.child_value());
    return true;
  }

  std::map<std::string, std::string> found;

 private:
  void put(std::string_view name, std::string_view value) {
    const auto [at, is_new] = found.emplace(local_name(name), trim(value));
    if (!is_new && at->second != trim(value)) {
      throw MetadataError("two values of " + std::string(name) + ", '" + at->second + "' and '" +
                          std::string(trim(value)) + "'; keep one");
    }
  }

  std::string_view uri_;
};

}  // namespace

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return result;
}

std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 || c == '\t' || c == '\n' || c == '\r') result += c;
  }
  return result;
}

pugi::xml_document parse_xml(std::string_view text, std::string_view what) {
  // Packets are padded, some with zeros.
  while (!text.empty() && text.back() == '\0') text.remove_suffix(1);
  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(text.data(), text.size());
  if (!result) {
    throw MetadataError(std::string(what) + " is not well-formed XML: " + result.description() + " at byte " +
                        std::to_string(result.offset) + "; write it again or take it out");
  }
  return document;
}

std::map<std::string, std::string> fields_of_namespace(const pugi::xml_document& document,
                                                       std::string_view uri) {
  Collector collector(uri);
  // traverse() is not const, though it changes nothing by itself.
  const_cast<pugi::xml_document&>(document).traverse(collector);
  return std::move(collector.found);
}

}  // namespace panorama
