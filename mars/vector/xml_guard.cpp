#include "mars/vector/xml_guard.h"

#include <algorithm>
#include <utility>

namespace mars {
namespace {

constexpr std::size_t kNone = std::string_view::npos;
constexpr std::string_view kEndOfName = " \t\r\n/>";

// Returns the position behind `end`, or that of the end of the text.
std::size_t behind(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t found = text.find(end, from);
  return found == kNone ? text.size() : found + end.size();
}

// Returns the position of the > that ends a tag: values of attributes may have others.
std::size_t end_of_tag(std::string_view text, std::size_t from) {
  char quote = 0;
  for (std::size_t i = from; i < text.size(); ++i) {
    const char c = text[i];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return i;
    }
  }
  return text.size();
}

// Returns the name of the element that begins at a <, without its prefix.
std::string_view local_name(std::string_view text, std::size_t at) {
  std::string_view name =
      text.substr(at + 1, std::min(text.find_first_of(kEndOfName, at + 1), text.size()) - at - 1);
  const std::size_t colon = name.rfind(':');
  return colon == kNone ? name : name.substr(colon + 1);
}

// Returns the text that follows a tag, up to the next one.
std::string text_behind(std::string_view text, std::size_t at) {
  constexpr std::string_view kBlanks = " \t\r\n";
  constexpr std::string_view kCdata = "<![CDATA[";
  at = std::min(text.find_first_not_of(kBlanks, at), text.size());
  std::string_view rest = text.substr(at);
  if (rest.starts_with(kCdata)) {
    rest = rest.substr(kCdata.size(), rest.find("]]>") - kCdata.size());
  } else {
    rest = rest.substr(0, rest.find('<'));
  }
  const std::size_t last = rest.find_last_not_of(kBlanks);
  return std::string(rest.substr(0, last == kNone ? 0 : last + 1));
}

// Follows the elements of a text.
class XmlInspector {
 public:
  explicit XmlInspector(std::string_view text) : text_(text) {}

  XmlFindings inspect() {
    std::size_t at = text_.find('<');
    while (at < text_.size() && findings_.problem.empty()) at = text_.find('<', step(at));
    return std::move(findings_);
  }

 private:
  // Returns the position behind what begins at a <.
  std::size_t step(std::size_t at) {
    const std::string_view rest = text_.substr(at);
    if (rest.starts_with("<!--")) return behind(text_, "-->", at + 4);
    if (rest.starts_with("<![CDATA[")) return behind(text_, "]]>", at);
    if (rest.starts_with("<?")) return behind(text_, "?>", at);
    if (rest.starts_with("<!")) {
      findings_.problem =
          "it has a document type declaration (<!DOCTYPE), whose entities could expand to any size; remove it";
      return text_.size();
    }
    if (rest.starts_with("</")) {
      close();
      return behind(text_, ">", at);
    }
    const std::size_t end = end_of_tag(text_, at);
    open(local_name(text_, at), end, end < text_.size() && text_[end - 1] == '/');
    return end;
  }

  void open(std::string_view name, std::size_t end, bool is_empty) {
    if (name == "NetworkLink" && is_empty) findings_.links.emplace_back();
    if (is_empty) return;
    if (++depth_ > kMostXmlDepth)
      findings_.problem =
          "its elements are nested more than " + std::to_string(kMostXmlDepth) + " deep; check its content";
    if (name == "NetworkLink" && link_depth_ == 0) {
      link_depth_ = depth_;
      has_href_ = false;
    } else if (name == "href" && link_depth_ > 0) {
      has_href_ = true;
      findings_.links.push_back(text_behind(text_, end + 1));
    }
  }

  void close() {
    if (depth_ == link_depth_ && link_depth_ > 0) {
      if (!has_href_) findings_.links.emplace_back();
      link_depth_ = 0;
    }
    --depth_;
  }

  std::string_view text_;
  XmlFindings findings_;
  int depth_ = 0;
  int link_depth_ = 0;  // of the open <NetworkLink>; 0: none
  bool has_href_ = false;
};

}  // namespace

XmlFindings inspect_xml(std::string_view text) {
  if (text.find('\0') != kNone || text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return {"it is not XML in UTF-8; save it as UTF-8", {}};
  return XmlInspector(text).inspect();
}

}  // namespace mars
