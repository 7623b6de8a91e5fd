#include "silvasim/export/text.h"

#include <gtest/gtest.h>

#include "silvasim/export/colour.h"

namespace silvasim::exports {
namespace {

TEST(Text, numbers_are_grouped_with_thin_spaces) {
  EXPECT_EQ(grouped(std::uint64_t{0}), "0");
  EXPECT_EQ(grouped(std::uint64_t{999}), "999");
  EXPECT_EQ(grouped(std::uint64_t{1000}), "1\u2009000");
  EXPECT_EQ(grouped(std::uint64_t{5022357}), "5\u2009022\u2009357");
  EXPECT_EQ(grouped(-1234.5, 2), "\u22121\u2009234.50");
  EXPECT_EQ(grouped(-0.001, 2), "0.00");
}

TEST(Text, lengths_and_shares_read_well) {
  EXPECT_EQ(length(40000), "40 km");
  EXPECT_EQ(length(1500), "1.5 km");
  EXPECT_EQ(length(999.7), "1 km");
  EXPECT_EQ(length(250), "250 m");
  EXPECT_EQ(length(0.2), "20 cm");
  EXPECT_EQ(length(4e6), "4\u2009000 km");
  EXPECT_EQ(length(1e15), "1e+15 m");
  for (const double any : {0.0, -5.0, 1e18, 2e19, -1e300, 1e300, 1.7e308, 5e-324}) {
    EXPECT_NO_THROW(length(any)) << any;
    for (const int decimals : {0, 2, 9}) EXPECT_NO_THROW(grouped(any, decimals)) << any;
  }
  EXPECT_EQ(percent(0), "0 %");
  EXPECT_EQ(percent(0.0001), "< 0.1 %");
  EXPECT_EQ(percent(0.1234), "12.3 %");
  EXPECT_EQ(percent(1), "100.0 %");
}

TEST(Text, round_lengths_are_one_two_or_five) {
  for (const double power : {1e-3, 1.0, 1e4}) {
    EXPECT_DOUBLE_EQ(round_length(1.0 * power), 1 * power);
    EXPECT_DOUBLE_EQ(round_length(1.99 * power), 1 * power);
    EXPECT_DOUBLE_EQ(round_length(2.0 * power), 2 * power);
    EXPECT_DOUBLE_EQ(round_length(4.9 * power), 2 * power);
    EXPECT_DOUBLE_EQ(round_length(9.9 * power), 5 * power);
  }
}

TEST(Text, slugs_are_fit_for_ids) {
  EXPECT_EQ(slug("Picea abies"), "picea-abies");
  EXPECT_EQ(slug("  Abies × borisii-regis (L.) "), "abies-borisii-regis-l");
  EXPECT_EQ(slug("<&>"), "species");
  EXPECT_EQ(slug(""), "species");
}

TEST(Text, what_is_no_text_is_replaced) {
  EXPECT_EQ(printable("a\nb\tc"), "a b c");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\uFFFDb");
  EXPECT_EQ(printable("Bu\xC3\xA4"), "Bu\xC3\xA4");
  EXPECT_EQ(printable("\x1b[2J\xC2\x9B"), "\uFFFD[2J\uFFFD");  // both of a terminal's escapes
  EXPECT_EQ(printable("\xC3"), "\uFFFD");
  EXPECT_EQ(printable("\xC0\xAF"), "\uFFFD\uFFFD");              // overlong slash
  EXPECT_EQ(printable("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD");    // half a surrogate pair
  EXPECT_EQ(printable("\xEF\xBF\xBE"), "\uFFFD\uFFFD\uFFFD");    // U+FFFE, which XML forbids
  EXPECT_EQ(printable("\xF0\x9F\x8C\xB2"), "\xF0\x9F\x8C\xB2");  // a tree
  EXPECT_EQ(xml_escaped("<a b=\"c\" d='e'> & \x01"), "&lt;a b=&quot;c&quot; d=&#39;e&#39;&gt; &amp; \uFFFD");
}

TEST(Text, shortening_counts_characters) {
  EXPECT_EQ(base::shortened("Buäche", 6), "Buäche");
  EXPECT_EQ(base::shortened("Buäche", 3), "Buä...");
  EXPECT_EQ(base::shortened("a\x1b[2J", 2), "a\uFFFD...");
  EXPECT_EQ(base::shortened("", 0), "");
}

TEST(Text, fitting_cuts_at_characters_and_never_exceeds_the_room) {
  const Font font{14};
  const std::string name = "Übermäßig lange Ächtungsfichte von Österreich";
  double before = 0;
  for (double room = 20; room < width_px(name, font) + 10; room += 3) {
    const std::string cut = fitted(name, font, room);
    EXPECT_LE(width_px(cut, font), room) << cut;
    EXPECT_EQ(printable(cut), cut) << "a character was cut through";
    EXPECT_GE(width_px(cut, font) + 8, before);  // a space before the ellipsis may go
    before = width_px(cut, font);
  }
  EXPECT_EQ(fitted(name, font, 1e4), name);
}

TEST(Text, wrapping_keeps_every_word) {
  const Font font{12};
  const std::string text = "one two  three four five six seven eight nine ten";
  const auto lines = wrapped(text, font, 80);
  std::string joined;
  for (const std::string& line : lines) {
    EXPECT_LE(width_px(line, font), 80);
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, "one two three four five six seven eight nine ten");
  EXPECT_GT(lines.size(), 3u);
}

TEST(Colour, the_ramp_gets_steadily_lighter) {
  double before = -1, least_step = 1e9, most_step = 0;
  for (int i = 0; i <= 32; ++i) {
    // L* of CIE 1976 from sRGB, computed as the standard does.
    const auto channel = [&](int shift) {
      const double v = ((ramp(i / 32.0) >> shift) & 0xFF) / 255.0;
      return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const double luminance = 0.2126 * channel(16) + 0.7152 * channel(8) + 0.0722 * channel(0);
    const double lightness = 116 * std::cbrt(luminance) - 16;
    if (before >= 0) {
      least_step = std::min(least_step, lightness - before);
      most_step = std::max(most_step, lightness - before);
    }
    before = lightness;
  }
  EXPECT_GT(least_step, 0.8);
  EXPECT_LT(most_step, 4.2);
  EXPECT_EQ(ramp(-1), ramp(0));
  EXPECT_EQ(ramp(2), ramp(1));
  EXPECT_EQ(ramp(std::nan("")), ramp(0));
}

TEST(Colour, survives_light_and_back) {
  for (std::uint32_t v = 0; v < 256; ++v) {
    const Colour colour = v << 16 | (255 - v) << 8 | (v * 7 & 0xFF);
    EXPECT_EQ(colour_of(light_of(colour)), colour);
  }
  EXPECT_EQ(hex(0x00FF0A), "#00ff0a");
}

}  // namespace
}  // namespace silvasim::exports
