#include "silvasim/config/xml_text.h"

#include <cstdint>
#include <cstring>
#include <string_view>

namespace silvasim::config {

namespace {

base::Place place_at(const std::string& text, std::size_t at, const std::string& file) {
  base::Place place{file, 1, 1};
  for (std::size_t i = 0; i < at; ++i) {
    if (text[i] == '\n') {
      ++place.line;
      place.column = 1;
    } else {
      ++place.column;
    }
  }
  return place;
}

// Length of the UTF-8 sequence at `at`, and its code point; 0 where it is invalid (overlong, surrogate, cut off).
std::size_t utf8_sequence(const std::string& text, std::size_t at, std::uint32_t& code) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  const std::size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  if (length == 0) return 0;
  code = length == 1 ? first : first & (0x7Fu >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if (byte(at + k) >> 6 != 2) return 0;
    code = code << 6 | (byte(at + k) & 63);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < least[length] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) return 0;
  return length;
}

bool allowed_in_xml(std::uint32_t code) {
  if (code == '\t' || code == '\n' || code == '\r') return true;
  return code >= 0x20 && code != 0xFFFE && code != 0xFFFF;
}

// Whether an ampersand starts one of the five predefined entities or a number.
bool known_entity(std::string_view rest) {
  for (const char* name : {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"}) {
    if (rest.starts_with(name)) return true;
  }
  if (!rest.starts_with("&#")) return false;
  const bool hexadecimal = rest.size() > 2 && rest[2] == 'x';
  std::uint32_t code = 0;
  std::size_t digits = 0;
  for (std::size_t i = hexadecimal ? 3 : 2; i < rest.size(); ++i, ++digits) {
    const char c = rest[i];
    if (c == ';') return digits > 0 && allowed_in_xml(code) && code <= 0x10FFFF && !(code >= 0xD800 && code < 0xE000);
    const int digit = c >= '0' && c <= '9'                  ? c - '0'
                      : hexadecimal && c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : hexadecimal && c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                            : -1;
    if (digit < 0 || code > 0x10FFFF) return false;
    code = code * (hexadecimal ? 16 : 10) + static_cast<std::uint32_t>(digit);
  }
  return false;
}

bool is_utf8_name(std::string_view name) {
  const auto same = [&](const char* other) {
    if (name.size() != std::strlen(other)) return false;
    for (std::size_t i = 0; i < name.size(); ++i) {
      if ((name[i] | 32) != (other[i] | 32)) return false;
    }
    return true;
  };
  return same("utf-8") || same("us-ascii") || same("ascii");
}

// The value of encoding="..." in an XML declaration, or "".
std::string_view declared_encoding(std::string_view text) {
  if (!text.starts_with("<?xml")) return {};
  const std::string_view declaration = text.substr(0, text.find("?>"));
  const std::size_t at = declaration.find("encoding");
  if (at == std::string_view::npos) return {};
  const std::size_t open = declaration.find_first_of("\"'", at);
  if (open == std::string_view::npos) return {};
  const std::size_t close = declaration.find(declaration[open], open + 1);
  if (close == std::string_view::npos) return {};
  return declaration.substr(open + 1, close - open - 1);
}

}  // namespace

std::optional<base::Diagnostic> check_xml_text(const std::string& text, const std::string& file) {
  const auto found = [&](std::size_t at, const std::string& message) {
    return base::Diagnostic{place_at(text, at, file), message};
  };
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") || text.find('\0') != std::string::npos) {
    return found(0, "not UTF-8 text; save the file as UTF-8");
  }
  const std::string_view encoding = declared_encoding(std::string_view(text).substr(at));
  if (!encoding.empty() && !is_utf8_name(encoding)) {
    return found(at, "the file says it is in \"" + std::string(encoding.substr(0, 40)) + "\"; save it as UTF-8");
  }
  // Walk the characters; inside comments, character data and instructions an ampersand is only a character.
  std::string_view verbatim_end;
  while (at < text.size()) {
    const std::string_view rest = std::string_view(text).substr(at);
    std::uint32_t code = 0;
    const std::size_t length = utf8_sequence(text, at, code);
    if (length == 0) return found(at, "invalid UTF-8; save the file as UTF-8");
    if (!allowed_in_xml(code)) return found(at, "control character that XML does not allow");
    if (!verbatim_end.empty()) {
      if (rest.starts_with(verbatim_end)) verbatim_end = {};
    } else if (rest.starts_with("<!--")) {
      verbatim_end = "-->";
    } else if (rest.starts_with("<![CDATA[")) {
      verbatim_end = "]]>";
    } else if (rest.starts_with("<?")) {
      verbatim_end = "?>";
    } else if (rest.starts_with("<!")) {
      return found(at, "document type declarations and entities of one's own are not supported");
    } else if (code == '&' && !known_entity(rest)) {
      return found(at, "unknown entity; write &amp; for an ampersand");
    }
    at += length;
  }
  return std::nullopt;
}

ColumnFinder::ColumnFinder(const std::string& text) : text_(text), starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') starts_.push_back(i + 1);
  }
}

std::string_view ColumnFinder::line_text(int line) const {
  if (line < 1 || static_cast<std::size_t>(line) > starts_.size()) return {};
  const std::size_t start = starts_[static_cast<std::size_t>(line) - 1];
  return std::string_view(text_).substr(start, text_.find('\n', start) - start);
}

int ColumnFinder::element(int line, const std::string& tag) {
  if (line != last_line_) {
    last_line_ = line;
    searched_ = 0;
  }
  const std::string_view text = line_text(line);
  const std::string open = "<" + tag;
  for (std::size_t at = text.find(open, searched_); at != std::string_view::npos; at = text.find(open, at + 1)) {
    const std::size_t end = at + open.size();
    if (end == text.size() || std::strchr(" \t\r\n/>", text[end])) {
      searched_ = end;
      return static_cast<int>(at) + 1;
    }
  }
  return 0;
}

int ColumnFinder::attribute(int line, const std::string& name, int from_column) const {
  const std::string_view text = line_text(line);
  std::size_t at = from_column > 0 ? static_cast<std::size_t>(from_column) : 0;
  for (at = text.find(name, at); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const std::size_t end = text.find_first_not_of(" \t", at + name.size());
    const bool starts = at == 0 || std::strchr(" \t", text[at - 1]);
    if (starts && end != std::string_view::npos && text[end] == '=') return static_cast<int>(at) + 1;
  }
  return 0;
}

}  // namespace silvasim::config
