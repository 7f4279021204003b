#include "mars/raster/gdal/label_keywords.h"

#include <cpl_json.h>
#include <cpl_minixml.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <string>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {
namespace {

constexpr int kMostDepth = 32;  // of groups within groups, which a hostile label may make deep

std::string domain_text(GDALDataset& dataset, const char* domain) {
  char** lines = dataset.GetMetadata(domain);
  return lines == nullptr || lines[0] == nullptr ? "" : lines[0];
}

// Adds the keywords of an object of an ISIS label. GDAL writes a value with a unit as an object of both.
void add_json_keywords(const CPLJSONObject& object, int depth, std::vector<LabelKeyword>& keywords) {
  if (depth >= kMostDepth) return;
  for (const CPLJSONObject& child : object.GetChildren()) {
    if (child.GetType() != CPLJSONObject::Type::Object) {
      keywords.emplace_back(child.GetName(), child.ToString());
      continue;
    }
    const CPLJSONObject value = child.GetObj("value");
    if (value.IsValid()) {
      keywords.emplace_back(child.GetName(), value.ToString());
    } else {
      add_json_keywords(child, depth + 1, keywords);
    }
  }
}

// Adds the keywords of XML elements: a node, those after it, and those inside of these.
void add_xml_keywords(const CPLXMLNode* node, int depth, std::vector<LabelKeyword>& keywords) {
  if (depth >= kMostDepth) return;
  for (; node != nullptr; node = node->psNext) {
    if (node->eType != CXT_Element) continue;
    if (EQUAL(node->pszValue, "Observing_System_Component") &&
        EQUAL(CPLGetXMLValue(node, "type", ""), "Instrument"))
      keywords.emplace_back("INSTRUMENT_NAME", CPLGetXMLValue(node, "name", ""));
    const std::string value = CPLGetXMLValue(node, "", "");
    if (!value.empty()) keywords.emplace_back(node->pszValue, value);
    add_xml_keywords(node->psChild, depth + 1, keywords);
  }
}

}  // namespace

std::vector<LabelKeyword> label_keywords(GDALDataset& dataset) {
  const GdalScope scope;
  std::vector<LabelKeyword> keywords;
  CPLJSONDocument isis;
  const std::string text = domain_text(dataset, "json:ISIS3");
  if (!text.empty() && isis.LoadMemory(text)) add_json_keywords(isis.GetRoot(), 0, keywords);
  const std::string xml = domain_text(dataset, "xml:PDS4");
  if (xml.empty()) return keywords;
  const CPLXMLTreeCloser root(CPLParseXMLString(xml.c_str()));
  if (root == nullptr) return keywords;
  CPLStripXMLNamespace(root.get(), nullptr, TRUE);
  add_xml_keywords(root.get(), 0, keywords);
  return keywords;
}

}  // namespace mars
