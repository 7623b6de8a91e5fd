// The dialect as an XML Schema, for editors (completion, hover text) and for `silvasim validate`.
//
// Generated from the same tables as the parser. XML Schema 1.0 can't say everything: references between names and "one of
// each at most" are the parser's alone, so a file that the schema passes may still be refused, never the other way round.
#pragma once

#include <string>
#include <vector>

#include "silvasim/base/error.h"
#include "silvasim/config/rules.h"

namespace silvasim::config {

std::string xml_schema(const Dialect& dialect);

// What libxml2 finds when it holds `text` against the schema. Nothing is fetched, no entity is expanded.
std::vector<base::Diagnostic> check_against_schema(const std::string& text, const std::string& file,
                                                   const std::string& schema);

}  // namespace silvasim::config
