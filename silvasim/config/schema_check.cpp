// Validation against the schema, by libxml2.
#include <libxml/parser.h>
#include <libxml/xmlschemas.h>

#include <memory>

#include "silvasim/config/schema.h"
#include "silvasim/config/value.h"

namespace silvasim::config {

namespace {

struct Findings {
  std::vector<base::Diagnostic> found;
  std::string file;
};

void collect(void* context, xmlErrorPtr error) {
  auto& findings = *static_cast<Findings*>(context);
  base::add(findings.found, {findings.file, error->line, 0},
            "schema: " + trimmed(error->message ? error->message : ""));
}

template <typename T, void (*free)(T*)>
struct Free {
  void operator()(T* object) const { free(object); }
};

}  // namespace

std::vector<base::Diagnostic> check_against_schema(const std::string& text, const std::string& file,
                                                   const std::string& schema) {
  Findings findings{{}, file};
  xmlSetStructuredErrorFunc(&findings, collect);
  std::unique_ptr<xmlSchemaParserCtxt, Free<xmlSchemaParserCtxt, xmlSchemaFreeParserCtxt>> parser(
      xmlSchemaNewMemParserCtxt(schema.data(), static_cast<int>(schema.size())));
  std::unique_ptr<xmlSchema, Free<xmlSchema, xmlSchemaFree>> compiled(xmlSchemaParse(parser.get()));
  std::unique_ptr<xmlDoc, Free<xmlDoc, xmlFreeDoc>> document(xmlReadMemory(
      text.data(), static_cast<int>(text.size()), file.c_str(), nullptr, XML_PARSE_NONET | XML_PARSE_BIG_LINES));
  if (compiled && document) {
    std::unique_ptr<xmlSchemaValidCtxt, Free<xmlSchemaValidCtxt, xmlSchemaFreeValidCtxt>> valid(
        xmlSchemaNewValidCtxt(compiled.get()));
    xmlSchemaSetValidStructuredErrors(valid.get(), collect, &findings);
    xmlSchemaValidateDoc(valid.get(), document.get());
  }
  xmlSetStructuredErrorFunc(nullptr, nullptr);
  return findings.found;
}

}  // namespace silvasim::config
