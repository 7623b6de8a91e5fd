#include "silvasim/config/xml_text.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "silvasim/base/words.h"

namespace silvasim::config {

namespace {

// Length of the UTF-8 sequence at `at`, and its code point; 0 where it is invalid (overlong, surrogate, cut off).
std::size_t utf8_sequence(std::string_view text, std::size_t at, std::uint32_t& code) {
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

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// What may begin a name, and what may follow. Letters beyond ASCII are taken as they come: the dialect has none.
bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 128;
}
bool is_in_name(char c) { return begins_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }

bool same_but_case(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? c + 32 : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return small(x) == small(y); });
}

std::string shown(std::string_view text) { return base::shortened(std::string(text), 60); }
std::string tag_text(std::string_view name) { return "<" + shown(name) + ">"; }

class Scanner {
 public:
  Scanner(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  XmlPlaces scan() {
    check_characters();
    declaration();
    while (at_ < text_.size()) {
      if (text_[at_] != '<') {
        characters();
      } else if (next_is("<!--")) {
        comment();
      } else if (next_is("<![CDATA[")) {
        character_data();
      } else if (next_is("<?")) {
        instruction();
      } else if (next_is("<!")) {
        fail(at_, "document type declarations and entities of one's own are not supported");
      } else if (next_is("</")) {
        end_tag();
      } else {
        start_tag();
      }
    }
    if (!open_.empty()) fail(open_.back().at, tag_text(open_.back().name) + " is not closed before the file ends");
    return std::move(places_);
  }

 private:
  struct Open {
    std::string_view name;
    std::size_t at;
  };

  [[noreturn]] void fail(std::size_t at, std::string message) const {
    const TextPlace place = place_at(at, 0, {});
    throw base::ConfigError({file_, place.line, place.column}, std::move(message));
  }

  // Counts on from a place that is known.
  TextPlace place_at(std::size_t at, std::size_t from, TextPlace place) const {
    for (std::size_t i = from; i < at; ++i) {
      ++place.column;
      if (text_[i] == '\n') place = {place.line + 1, 1};
    }
    return place;
  }

  TextPlace mark(std::size_t at) {
    marked_ = place_at(at, marked_at_, marked_);
    marked_at_ = at;
    return marked_;
  }

  bool next_is(std::string_view word) const { return text_.substr(at_).starts_with(word); }

  bool skip_blanks() {
    const std::size_t before = at_;
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    return at_ > before;
  }

  std::string_view name() {
    const std::size_t first = at_;
    if (at_ < text_.size() && begins_name(text_[at_])) {
      while (at_ < text_.size() && is_in_name(text_[at_])) ++at_;
    }
    return text_.substr(first, at_ - first);
  }

  // The character here, for messages.
  std::string found() const {
    if (at_ >= text_.size()) return "the end of the file";
    const std::string rest(text_.substr(at_, 4));
    return "\"" + base::printable(rest.substr(0, std::max<std::size_t>(1, base::character_length(rest, 0)))) + "\"";
  }

  void check_characters() {
    at_ = text_.starts_with("\xEF\xBB\xBF") ? 3 : 0;
    if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF") || text_.find('\0') != std::string::npos) {
      fail(0, "not UTF-8 text; save the file as UTF-8");
    }
    for (std::size_t at = at_; at < text_.size();) {
      std::uint32_t code = 0;
      const std::size_t length = utf8_sequence(text_, at, code);
      if (length == 0) fail(at, "invalid UTF-8; save the file as UTF-8");
      if (!allowed_in_xml(code)) fail(at, "control character that XML does not allow");
      at += length;
    }
  }

  // <?xml version="1.0" encoding="UTF-8" standalone="yes"?>, at the very start only.
  void declaration() {
    const std::size_t start = at_;
    if (!next_is("<?xml") || start + 5 >= text_.size() || is_in_name(text_[start + 5])) return;
    at_ += 5;
    constexpr const char* likeness = "the XML declaration must be like <?xml version=\"1.0\" encoding=\"UTF-8\"?>";
    constexpr std::string_view known[] = {"version", "encoding", "standalone"};
    std::size_t least = 0;
    while (true) {
      const bool blank = skip_blanks();
      if (next_is("?>") && least > 0) break;
      const std::size_t here = at_;
      const std::string_view word = name();
      const auto which = static_cast<std::size_t>(std::find(known, known + 3, word) - known);
      if (!blank || which == 3 || which < least || (least == 0 && which > 0)) fail(here, likeness);
      least = which + 1;
      const std::string_view value = quoted(here, likeness);
      if (which == 0 && value != "1.0") fail(here, "XML of version " + shown(value) + "; version 1.0 is read");
      if (which == 1) encoding(start, value);
      if (which == 2 && value != "yes" && value != "no") fail(here, likeness);
    }
    at_ += 2;
  }

  void encoding(std::size_t at, std::string_view name) const {
    if (same_but_case(name, "utf-8")) return;
    const bool ascii = same_but_case(name, "us-ascii") || same_but_case(name, "ascii");
    const bool plain =
        std::all_of(text_.begin(), text_.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
    if (!ascii || !plain) fail(at, "the file says it is in \"" + shown(name) + "\"; save it as UTF-8");
  }

  // ="value", with blanks around the equals sign.
  std::string_view quoted(std::size_t start, const std::string& likeness) {
    skip_blanks();
    if (!next_is("=")) fail(start, likeness);
    ++at_;
    skip_blanks();
    if (!next_is("\"") && !next_is("'")) fail(start, likeness);
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    if (end == std::string_view::npos) fail(start, likeness);
    const std::string_view value = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return value;
  }

  void check_ampersands(std::size_t from, std::size_t to) const {
    const std::string_view part = text_.substr(from, to - from);
    for (std::size_t at = part.find('&'); at != std::string_view::npos; at = part.find('&', at + 1)) {
      if (!known_entity(part.substr(at))) fail(from + at, "unknown entity; write &amp; for an ampersand");
    }
  }

  void characters() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    if (open_.empty()) {
      skip_blanks();
      if (at_ < end) fail(at_, "text outside of the root element");
    }
    check_ampersands(at_, end);
    const std::size_t stray = text_.substr(at_, end - at_).find("]]>");
    if (stray != std::string_view::npos) fail(at_ + stray, "]]> in a text; write ]]&gt;");
    at_ = end;
  }

  void skip_past(std::string_view end, const char* what) {
    const std::size_t last = text_.find(end, at_);
    if (last == std::string_view::npos) fail(at_, std::string(what) + " is not closed by " + std::string(end));
    at_ = last + end.size();
  }

  void comment() {
    const std::size_t start = at_;
    at_ += 4;
    const std::size_t end = text_.find("--", at_);
    if (end == std::string_view::npos) fail(start, "a comment is not closed by -->");
    if (!text_.substr(end).starts_with("-->")) fail(end, "-- inside a comment, which XML does not allow");
    at_ = end + 3;
  }

  void character_data() {
    if (open_.empty()) fail(at_, "text outside of the root element");
    skip_past("]]>", "a CDATA section");
  }

  void instruction() {
    const std::size_t start = at_;
    at_ += 2;
    const std::string_view target = name();
    if (same_but_case(target, "xml")) fail(start, "the XML declaration must stand at the very start of the file");
    if (target.empty() || target.find(':') != std::string_view::npos || (!next_is("?>") && !skip_blanks()))
      fail(start, "<? must be followed by a name");
    at_ = start;
    skip_past("?>", "an instruction");
  }

  void end_tag() {
    const std::size_t start = at_;
    at_ += 2;
    const std::string_view closed = name();
    skip_blanks();
    const std::string tag = "</" + shown(closed) + ">";
    if (closed.empty() || !next_is(">")) fail(start, "an end tag must be like </plant>; found " + found());
    if (open_.empty()) fail(start, tag + " closes nothing");
    if (closed != open_.back().name) {
      const TextPlace opened = place_at(open_.back().at, 0, {});
      fail(start, tag + " where " + tag_text(open_.back().name) + " of line " + std::to_string(opened.line) +
                      " is still to be closed");
    }
    ++at_;
    open_.pop_back();
  }

  void start_tag() {
    const std::size_t start = at_++;
    const std::string_view tag = name();
    if (tag.empty())
      fail(start, "< must be followed by an element's name; found " + found() + "; write &lt; for the sign");
    if (open_.empty() && !places_.elements.empty()) fail(start, "a second root element; XML has one");
    if (open_.size() >= most_depth) fail(start, "elements are nested too deep");
    if (places_.elements.size() >= most_elements) {
      fail(start, "more than " + std::to_string(most_elements) + " elements");
    }
    places_.elements.push_back({mark(start), places_.attributes.size()});
    names_.clear();
    while (true) {
      const bool blank = skip_blanks();
      if (next_is("/>")) {
        at_ += 2;
        return;
      }
      if (next_is(">")) {
        ++at_;
        open_.push_back({tag, start});
        return;
      }
      attribute(tag, blank);
    }
  }

  void attribute(std::string_view tag, bool blank) {
    const std::size_t start = at_;
    const std::string_view word = name();
    if (word.empty()) fail(start, tag_text(tag) + ": expected an attribute, > or />; found " + found());
    const std::string which = tag_text(tag) + " " + shown(word);
    if (!blank) fail(start, which + ": a blank is missing before the attribute");
    if (std::find(names_.begin(), names_.end(), word) != names_.end())
      fail(start, which + ": the attribute stands twice");
    if (names_.size() >= most_attributes) {
      fail(start, tag_text(tag) + " has more than " + std::to_string(most_attributes) + " attributes");
    }
    names_.push_back(word);
    places_.attributes.push_back(mark(start));
    const std::string_view value =
        quoted(start, which + ": expected " + which.substr(which.find(' ') + 1) + "=\"...\"");
    const std::size_t first = at_ - 1 - value.size();
    if (const std::size_t less = value.find('<'); less != std::string_view::npos) {
      fail(start, which + ": < inside the value; write &lt;, or close the value by its quotation mark");
    }
    check_ampersands(first, at_ - 1);
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::vector<Open> open_;
  std::vector<std::string_view> names_;  // of the present element's attributes
  XmlPlaces places_;
  TextPlace marked_;  // the place of `marked_at_`
  std::size_t marked_at_ = 0;
};

}  // namespace

XmlPlaces scan_xml(const std::string& text, const std::string& file) { return Scanner(text, file).scan(); }

}  // namespace silvasim::config
