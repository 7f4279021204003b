#include "panorama/metadata/xml.h"

#include <utility>
#include <vector>

namespace panorama {

namespace {

constexpr int kMaxDepth = 100;

// Knows which prefixes stand for one namespace, from the root to the visited element.
class Scopes {
 public:
  explicit Scopes(std::string_view uri) : uri_(uri) {}

  // Enters an element that is nested in `depth` others.
  void enter(pugi::xml_node element, std::size_t depth) {
    declared_.resize(depth + 1);
    Declarations& here = declared_.back();
    here.clear();
    for (const pugi::xml_attribute attribute : element.attributes()) {
      const std::string_view name = attribute.name();
      if (name == "xmlns") here.emplace("", attribute.value() == uri_);
      if (name.starts_with("xmlns:")) here.emplace(name.substr(6), attribute.value() == uri_);
    }
  }

  bool holds(std::string_view name, bool is_attribute) const {
    const std::size_t colon = name.find(':');
    const bool has_prefix = colon != std::string_view::npos;
    if (is_attribute && !has_prefix) return false;  // attributes have no default namespace
    const std::string_view prefix = has_prefix ? name.substr(0, colon) : std::string_view();
    for (auto scope = declared_.rbegin(); scope != declared_.rend(); ++scope) {
      if (const auto found = scope->find(prefix); found != scope->end()) return found->second;
    }
    return false;
  }

 private:
  using Declarations = std::map<std::string_view, bool>;  // of equal ones the first

  std::string_view uri_;
  std::vector<Declarations> declared_;
};

class Collector : public pugi::xml_tree_walker {
 public:
  explicit Collector(std::string_view uri) : scopes_(uri) {}

  bool for_each(pugi::xml_node& node) override {
    // Looking up prefixes takes time in proportion to the depth.
    if (depth() > kMaxDepth) throw MetadataError("XML nested deeper than " + std::to_string(kMaxDepth));
    if (node.type() != pugi::node_element) return true;
    scopes_.enter(node, static_cast<std::size_t>(depth()));
    for (const pugi::xml_attribute attribute : node.attributes()) {
      if (scopes_.holds(attribute.name(), true)) put(attribute.name(), attribute.value());
    }
    bool is_leaf = true;
    for (const pugi::xml_node child : node.children()) is_leaf = is_leaf && child.type() != pugi::node_element;
    if (is_leaf && scopes_.holds(node.name(), false)) put(node.name(), node.child_value());
    return true;
  }

  std::map<std::string, std::string> found;

 private:
  void put(std::string_view name, std::string_view value) {
    const auto [at, is_new] = found.emplace(local_name(name), trim(value));
    if (!is_new && at->second != trim(value)) {
      throw MetadataError("two values of " + excerpt(name) + ", '" + excerpt(at->second) + "' and '" +
                          excerpt(trim(value)) + "'; keep one");
    }
  }

  Scopes scopes_;
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
  // traverse() is not const, but changes nothing by itself.
  const_cast<pugi::xml_document&>(document).traverse(collector);
  return std::move(collector.found);
}

}  // namespace panorama
