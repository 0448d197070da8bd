// Places of values, and what the parser refuses.
#include "host/json_document.h"

#include "tests/temporary_folder.h"

namespace wale {
namespace {

TEST(JsonDocument, EveryValueKnowsItsPlace) {
  const JsonNode root = parse_json(
      "{ // a comment, with: {signs}\n"
      "  \"a\": [1, -2.5e3, \"x\\\"y\", /* in\n"
      "  between */ true],\n"
      "  \"\xC3\xA9\": {\"k\": null}\n"
      "}",
      "s.json");
  EXPECT_EQ(root.place.text(), "s.json:1:1");
  const JsonNode& a = root["a"];
  EXPECT_EQ(a.place.text(), "s.json:2:8");
  EXPECT_EQ(a.items[0].place.text(), "s.json:2:9");
  EXPECT_EQ(a.items[1].place.text(), "s.json:2:12");
  EXPECT_EQ(a.items[1].number, -2500);
  EXPECT_EQ(a.items[2].place.text(), "s.json:2:20");
  EXPECT_EQ(a.items[2].text, "x\"y");
  EXPECT_EQ(a.items[3].place.text(), "s.json:3:14");
  EXPECT_EQ(root.members[1].place.text(), "s.json:4:3");
  EXPECT_EQ(root.members[1].value.place.text(), "s.json:4:8") << "a two-byte letter is one column";
  EXPECT_EQ(root.members[1].value["k"].place.text(), "s.json:4:14");
}

TEST(JsonDocument, ByteOrderMarkTakesNoColumn) {
  EXPECT_EQ(parse_json("\xEF\xBB\xBF[7]", "s").items[0].place.text(), "s:1:2");
}

TEST(JsonDocument, SyntaxErrorIsOneLineWithPlace) {
  const std::string message = user_message([] { parse_json("{\n  \"a\": 1,\n  b: 2\n}", "s.json"); });
  EXPECT_TRUE(message.starts_with("s.json:3:3: syntax error")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(JsonDocument, MissingBraceIsReportedAtTheEnd) {
  const std::string message = user_message([] { parse_json("{\"a\": [1, 2]", "s.json"); });
  EXPECT_TRUE(message.starts_with("s.json:1:1")) << message;
  EXPECT_NE(message.find("end of input"), std::string::npos) << message;
}

TEST(JsonDocument, EmptyFileIsRefused) {
  EXPECT_TRUE(user_message([] { parse_json("", "s.json"); }).starts_with("s.json:1:1: syntax error"));
}

TEST(JsonDocument, DuplicateKeyNamesBothPlaces) {
  EXPECT_EQ(user_message([] { parse_json("{\"a\": 1,\n \"b\": 2,\n \"a\": 3}", "s.json"); }),
            "s.json:3:2: \"a\": given twice; the first is in line 1");
}

TEST(JsonDocument, NumberBeyondDoubleIsRefused) {
  const std::string message = user_message([] { parse_json("[1e999]", "s.json"); });
  EXPECT_TRUE(message.starts_with("s.json:1:")) << message;
  EXPECT_NE(message.find("1e999"), std::string::npos) << message;
}

TEST(JsonDocument, NanIsNoJson) {
  EXPECT_NE(user_message([] { parse_json("[NaN]", "s.json"); }).find("s.json:1:"), std::string::npos);
}

TEST(JsonDocument, DeepNestingIsRefused) {
  const std::string deep(100000, '[');
  EXPECT_EQ(user_message([&] { parse_json(deep, "s.json"); }), "s.json:1:65: nested deeper than 64 levels");
}

TEST(JsonDocument, MissingFileIsNamed) {
  EXPECT_EQ(user_message([] { read_json("/no/such/scene.json"); }), "/no/such/scene.json: cannot read this file");
}

TEST(JsonDocument, OptionValueIsJsonOrText) {
  EXPECT_EQ(parse_option_value("[1, 2]", "--set x").items.size(), 2u);
  const JsonNode word = parse_option_value("cell+ring", "--set x");
  EXPECT_EQ(word.kind, JsonNode::Kind::string);
  EXPECT_EQ(word.text, "cell+ring");
  EXPECT_EQ(word.place.text(), "--set x");
}

}  // namespace
}  // namespace wale
