#include "silvasim/config/value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace silvasim::config {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

double number(const std::string& text, ValueType type) {
  const ParsedValue parsed = parse_value(text, type, {}, -inf, inf);
  EXPECT_EQ(parsed.problem, "") << text;
  return std::get<double>(parsed.value);
}

std::string problem(const std::string& text, ValueType type, double least = -inf, double most = inf) {
  return parse_value(text, type, {}, least, most).problem;
}

TEST(Value, LengthsComeInMetres) {
  EXPECT_DOUBLE_EQ(number("200", ValueType::length), 200);
  EXPECT_DOUBLE_EQ(number("200 m", ValueType::length), 200);
  EXPECT_DOUBLE_EQ(number("0.2km", ValueType::length), 200);
  EXPECT_DOUBLE_EQ(number("30 cm", ValueType::length), 0.3);
  EXPECT_DOUBLE_EQ(number("100 ft", ValueType::length), 30.48);
}

TEST(Value, SharesMayBePercentages) {
  EXPECT_DOUBLE_EQ(number("0.25", ValueType::fraction), 0.25);
  EXPECT_DOUBLE_EQ(number("25 %", ValueType::fraction), 0.25);
  EXPECT_NE(problem("1.5", ValueType::fraction), "");
  EXPECT_NE(problem("120 %", ValueType::fraction), "");
}

TEST(Value, AnglesAndTimesHaveUnits) {
  EXPECT_DOUBLE_EQ(number("55", ValueType::angle), 55);
  EXPECT_DOUBLE_EQ(number("55 deg", ValueType::angle), 55);
  EXPECT_DOUBLE_EQ(number("12 s", ValueType::duration), 12);
  EXPECT_DOUBLE_EQ(number("2 min", ValueType::duration), 120);
  EXPECT_DOUBLE_EQ(number("400ms", ValueType::duration), 0.4);
  EXPECT_NE(problem("12 m", ValueType::duration), "");
  EXPECT_NE(problem("1 rad", ValueType::angle), "");
}

TEST(Value, NumbersAreReadWholeOrNotAtAll) {
  for (const char* bad : {"", "x", "1x", "nan", "inf", "-inf", "1e999", "0x10", "1 2", "--1", "+1", "1e", "٣"}) {
    EXPECT_NE(problem(bad, ValueType::number), "") << bad;
  }
  EXPECT_EQ(problem("0,5", ValueType::number), "\"0,5\" has a comma; the decimal mark is a point");
  EXPECT_NE(problem("200 m", ValueType::number).find("plain number"), std::string::npos);
  EXPECT_NE(problem("200 parsec", ValueType::length).find("known are m, km, cm, mm, ft"), std::string::npos);
  EXPECT_EQ(problem("-5", ValueType::length, 1e-9), "\"-5\" is not above 0");
  EXPECT_NE(problem("2.5", ValueType::integer), "");
}

TEST(Value, EveryDoubleReadsBackFromItsText) {
  std::uint64_t bits = 0x243F6A8885A308D3u;
  for (int i = 0; i < 10000; ++i) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(number(to_text(value), ValueType::number), value);
  }
}

TEST(Value, ColoursAndChoices) {
  EXPECT_EQ(number("#1f5F3a", ValueType::colour), 0x1f5f3a);
  EXPECT_NE(problem("green", ValueType::colour), "");
  const ParsedValue parsed = parse_value("optimall", ValueType::choice, {"optimal", "paper"}, -inf, inf);
  EXPECT_EQ(parsed.problem, "\"optimall\" is none of optimal, paper; did you mean \"optimal\"?");
}

}  // namespace
}  // namespace silvasim::config
