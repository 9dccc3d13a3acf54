// SPDX-License-Identifier: Apache-2.0
#include "core/base/json.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/temporary_folder.h"

namespace spectrace {
namespace {

JsonDocument parse(std::string text) { return JsonDocument::parse(std::move(text), "dir/f.json"); }

/// What is wrong with a text that must not parse.
std::string fault_of(std::string text) {
  try {
    JsonDocument::parse(std::move(text), "f");
  } catch (const InputError& error) {
    return error.what();
  }
  return "parsed";
}

std::vector<std::string> lines_of(const JsonDocument& document) {
  std::vector<std::string> lines;
  for (const Diagnostic& d : document.diagnostics()) lines.push_back(d.text());
  return lines;
}
using Lines = std::vector<std::string>;

TEST(Json, TellsIntegersFromOtherNumbers) {
  JsonDocument document = JsonDocument::parse(R"([1, -7, 1.0, 1e3, "1", true])", "f");
  std::vector<bool> found;
  for (const JsonValue& value : document.root().elements()) found.push_back(value.is_integer());
  EXPECT_EQ(found, (std::vector<bool>{true, true, false, false, false, false}));
  EXPECT_FALSE(JsonValue().is_integer());
}

TEST(Json, ReadsEveryType) {
  JsonDocument document =
      parse(R"({"n": -1.5e2, "i": 8e3, "b": true, "s": "a\u00e9\n", "a": [1, 2.5], "v": [1, 2, 3],
                                    "null": null})");
  const JsonValue root = document.root();
  EXPECT_EQ(root.get("n").number(0), -150);
  EXPECT_EQ(root.get("i").integer(0, 0, 10000), 8000);
  EXPECT_TRUE(root.get("b").boolean(false));
  EXPECT_EQ(root.get("s").string(), "a\xc3\xa9\n");
  EXPECT_EQ(root.get("a").numbers(0, 9), (std::vector<double>{1, 2.5}));
  EXPECT_EQ(root.get("v").vec3({}), (Vec3{1, 2, 3}));
  EXPECT_TRUE(root.get("null").exists());
  EXPECT_FALSE(root.get("null").is_object());
  EXPECT_EQ(root.keys(), (Lines{"n", "i", "b", "s", "a", "v", "null"}));
  EXPECT_NO_THROW(document.throw_if_wrong());
}

TEST(Json, ReadsIntegersExactly) {
  JsonDocument document = parse("[9223372036854775807, 9007199254740993, 9223372036854775808]");
  const auto elements = document.root().elements();
  constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(elements[0].integer(0, 0, kMax), kMax);
  EXPECT_EQ(elements[1].integer(0, 0, kMax), 9007199254740993);
  EXPECT_EQ(elements[2].integer(7, 0, kMax), 7);
  EXPECT_EQ(lines_of(document),
            Lines{"dir/f.json:1:41: /2: expected an integer of at least 0, got 9223372036854775808"});
}

TEST(Json, ReturnsFallbacksBelowAbsentKeysWithoutComplaint) {
  JsonDocument document = parse("{}");
  const JsonValue absent = document.root().get("a").get("b");
  EXPECT_FALSE(absent.exists());
  EXPECT_EQ(absent.number(3), 3);
  EXPECT_EQ(absent.integer(4, 0, 9), 4);
  EXPECT_EQ(absent.string("x"), "x");
  EXPECT_EQ(absent.choice("y", {"z"}), "y");
  EXPECT_EQ(absent.vec3({1, 2, 3}), (Vec3{1, 2, 3}));
  EXPECT_TRUE(absent.elements().empty());
  EXPECT_TRUE(absent.path().empty());
  EXPECT_FALSE(absent.require("c").exists());
  absent.reject_unknown_keys();
  EXPECT_TRUE(document.diagnostics().empty());
}

TEST(Json, NamesEveryMistakeAtItsPlaceInOrder) {
  JsonDocument document = parse(
      "{ // a comment with \"quotes\": [\n"
      "  \"rough\": \"rough\", \"kind\": \"condctor\",\n"
      "  /* { \n*/ \"v\": [1, \"x\"], \"w\": [1, 2],\n"
      "\t\"a/b~c\": {\"deep\": [{}, {\"n\": 2.5}]}, \"\xc3\xa9\xc3\xa9\": 1, \"big\": 1e300,\n"
      "  \"long\": \"0123456789012345678901234567890123456789\xc3\xa9 and so on\", \"flag\": 1\n"
      "}");
  const JsonValue root = document.root();
  // Asked in another order than they stand in the file.
  EXPECT_FALSE(root.get("flag").boolean(false));
  EXPECT_EQ(root.get("long").number(1), 1);
  EXPECT_EQ(root.get("big").vec3({7, 7, 7}), (Vec3{7, 7, 7}));
  const auto deep = root.get("a/b~c").get("deep").elements();
  EXPECT_EQ(deep[1].get("n").integer(0, -5, 5), 0);
  EXPECT_FALSE(deep[0].require("n").exists());
  EXPECT_EQ(root.get("\xc3\xa9\xc3\xa9").string("s"), "s");
  EXPECT_TRUE(root.get("w").numbers(3, 3).empty());
  EXPECT_TRUE(root.get("v").numbers(1, 5).empty());
  EXPECT_EQ(root.get("kind").choice("f", {"conductor", "dielectric"}), "f");
  EXPECT_EQ(root.get("rough").number(0.5, {.min = 0, .max = 1, .min_open = true}), 0.5);
  EXPECT_EQ(
      lines_of(document),
      (Lines{"dir/f.json:2:12: /rough: expected a number in (0, 1], got \"rough\"",
             "dir/f.json:2:29: /kind: expected one of \"conductor\", \"dielectric\", got \"condctor\"; did "
             "you mean "
             "\"conductor\"?",
             "dir/f.json:4:13: /v/1: expected a number, got \"x\"",
             "dir/f.json:4:24: /w: expected an array of 3 numbers, got an array of 2",
             "dir/f.json:5:21: /a~1b~0c/deep/0: missing required key \"n\"",
             "dir/f.json:5:31: /a~1b~0c/deep/1/n: expected an integer in [-5, 5], got 2.5",
             "dir/f.json:5:45: /\xc3\xa9\xc3\xa9: expected a string, got 1",
             "dir/f.json:5:55: /big: expected an array of 3 numbers, got 1e300",
             "dir/f.json:6:11: /long: expected a number, got \"012345678901234567890123456789012345678...\"",
             "dir/f.json:6:74: /flag: expected true or false, got 1"}));
  try {
    document.throw_if_wrong();
    FAIL() << "ten mistakes passed";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().size(), 10u);
  }
}

TEST(Json, TellsTheNearestOfTheKnownKeys) {
  JsonDocument document = parse(R"({"roughnes": 1, "zzzzzz": 2, "$schema": "x", "fov": 3})");
  const JsonValue root = document.root();
  EXPECT_FALSE(root.get("roughness").exists());
  EXPECT_EQ(root.get("fov").number(0), 3);
  root.reject_unknown_keys();
  EXPECT_EQ(lines_of(document),
            (Lines{"dir/f.json:1:2: /roughnes: unknown key \"roughnes\"; did you mean \"roughness\"?",
                   "dir/f.json:1:17: /zzzzzz: unknown key \"zzzzzz\"; known here: \"roughness\", \"fov\""}));
}

TEST(Json, RecordsOneProblemOnce) {
  JsonDocument document = parse("{\"a\": 1}");
  EXPECT_FALSE(document.root().get("a").get("x").exists());
  EXPECT_FALSE(document.root().get("a").require("y").exists());
  EXPECT_EQ(lines_of(document), Lines{"dir/f.json:1:7: /a: expected an object, got 1"});
}

TEST(Json, CountsWhatIsBeyondTheListOfMistakes) {
  std::string text = "[0";
  for (std::size_t i = 0; i < kMaxDiagnostics + 4; ++i) text += ", 0";
  JsonDocument document = parse(text + "]");
  for (const JsonValue& element : document.root().elements()) element.error("wrong");
  try {
    document.throw_if_wrong();
    FAIL() << "many mistakes passed";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), kMaxDiagnostics + 1);
    EXPECT_EQ(error.diagnostics().back().problem, "and 5 more problems");
  }
}

TEST(Json, KeepsValuesWhenTheDocumentMoves) {
  JsonDocument first = parse("{\"a\": \"x\"}");
  const JsonValue a = first.root().get("a");
  const JsonDocument second = std::move(first);
  EXPECT_EQ(a.number(2), 2);
  EXPECT_EQ(lines_of(second).size(), 1u);
}

TEST(Json, ResolvesPathsAgainstItsOwnFolder) {
  JsonDocument document = parse(R"(["x/y.obj", "/abs.obj", "", 3, "a\u0000b"])");
  const auto e = document.root().elements();
  EXPECT_EQ(e[0].path(), "dir/x/y.obj");
  EXPECT_EQ(e[1].path(), "/abs.obj");
  for (std::size_t i = 2; i < 5; ++i) EXPECT_EQ(e[i].path(), "");
  EXPECT_EQ(document.diagnostics().size(), 3u);
}

TEST(Json, NamesTheFirstFaultOfABadText) {
  EXPECT_EQ(fault_of(""),
            "f:1:1: not valid JSON: while parsing value - unexpected end of input; expected '[', '{', or a "
            "literal");
  EXPECT_EQ(fault_of("[1,\n,2]").substr(0, 6), "f:2:1:");
  EXPECT_EQ(fault_of("{\"a\": 1,}").substr(0, 6), "f:1:9:");
  EXPECT_EQ(fault_of("[1 \"abc\"]").substr(0, 6), "f:1:4:");
  EXPECT_EQ(fault_of("{\"\xc3\xa9\": 1 23}").substr(0, 7), "f:1:9: ");
  EXPECT_EQ(fault_of("[truu]").substr(0, 6), "f:1:5:");
  EXPECT_EQ(fault_of("[NaN]").substr(0, 6), "f:1:2:");
  EXPECT_EQ(fault_of("{} x").substr(0, 6), "f:1:4:");
  EXPECT_EQ(fault_of("[\"open").substr(0, 6), "f:1:7:");
  EXPECT_EQ(fault_of("[1] /* open").substr(0, 7), "f:1:12:");
  EXPECT_EQ(fault_of("[1e400]"), "f:1:2: not valid JSON: number overflow parsing '1e400'");
}

TEST(Json, RefusesBytesThatAreNotText) {
  EXPECT_EQ(fault_of("[\"a\xff\"]"), "f:1:4: not valid JSON: byte 0xff is not UTF-8 text");
  EXPECT_EQ(fault_of("[] // \xc3("), "f:1:7: not valid JSON: byte 0xc3 is not UTF-8 text")
      << "in comments as well";
  for (const char* bad : {"\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80", "\xe0\x80\x80", "\xf0\x80\x80\x80",
                          "\x80", "\xe2\x82"}) {
    EXPECT_NE(fault_of(std::string("\"") + bad + "\"").find("is not UTF-8"), std::string::npos);
  }
  EXPECT_NE(fault_of(std::string("{}\0garbage", 10)), "parsed") << "NUL ends no text";
  EXPECT_EQ(fault_of("[\"\xc3\xa9\xe2\x82\xac\xf0\x9f\x99\x82\"]"), "parsed");
  EXPECT_EQ(fault_of("\xEF\xBB\xBF[1]"), "parsed") << "byte order mark";
}

TEST(Json, NamesDuplicateKeysAndWhereTheFirstIs) {
  EXPECT_EQ(fault_of("{\"a\": 1,\n \"b\": {\"a\": 2},\n \"a\": 3}"),
            "f:3:2: /a: duplicate key \"a\", first given at 1:2");
}

TEST(Json, BoundsNesting) {
  EXPECT_EQ(fault_of(std::string(200, '[') + std::string(200, ']')), "parsed");
  EXPECT_EQ(fault_of(std::string(1000000, '[')), "f:1:201: nested more than 200 levels deep");
  std::string objects;
  for (int i = 0; i < 300; ++i) objects += "{\"a\":";
  EXPECT_NE(fault_of(objects).find("nested more than 200"), std::string::npos);
}

TEST(Json, LoadsFilesAndNamesThem) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "f.json", "[x]");
  try {
    JsonDocument::load(folder / "f.json");
    FAIL() << "not JSON";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].file, (folder / "f.json").string());
  }
  EXPECT_THROW(JsonDocument::load(folder / "absent.json"), InputError);
}

TEST(NumberRange, ContainsItsClosedEndsOnlyAndNoNan) {
  constexpr NumberRange kHalfOpen{.min = 0, .max = 1, .min_open = true};
  EXPECT_FALSE(kHalfOpen.contains(0));
  EXPECT_TRUE(kHalfOpen.contains(1));
  EXPECT_FALSE(kHalfOpen.contains(std::nan("")));
  EXPECT_FALSE(kAnyNumber.contains(std::nan("")));
  EXPECT_EQ(kHalfOpen.text(), "in (0, 1]");
  EXPECT_EQ(kPositive.text(), "> 0");
  EXPECT_EQ(kUnitInterval.text(), "in [0, 1]");
}

TEST(JsonWriter, WritesWhatTheReaderReads) {
  JsonWriter writer;
  writer.begin_object();
  writer.member("text", "a \"quoted\" \xff byte");
  writer.member("number", 0.1);
  writer.member("flag", true);
  writer.member("count", std::size_t(42));
  writer.key("row");
  writer.begin_array();
  writer.value(1.5);
  writer.value(std::nan(""));
  writer.end_array();
  writer.key("objects");
  writer.begin_array();
  writer.begin_object();
  writer.end_object();
  writer.end_array();
  writer.end_object();
  EXPECT_EQ(writer.text(),
            "{\n  \"text\": \"a \\\"quoted\\\" \xef\xbf\xbd byte\",\n  \"number\": 0.1,\n  \"flag\": true,\n "
            " \"count\": 42,\n"
            "  \"row\": [1.5, null],\n  \"objects\": [\n    {}\n  ]\n}\n");
  JsonDocument document = parse(writer.text());
  EXPECT_EQ(document.root().get("number").number(0), 0.1);
}

TEST(JsonWriter, WritesALine) {
  JsonWriter writer;
  writer.begin_object();
  writer.member("text", "two\nlines");
  writer.member("number", 0.1);
  writer.end_object();
  EXPECT_EQ(writer.line(), "{\"text\":\"two\\nlines\",\"number\":0.1}\n");
}

TEST(JsonWriter, ChecksItsUse) {
  JsonWriter writer;
  EXPECT_THROW(static_cast<void>(writer.text()), InternalError);
  writer.begin_object();
  EXPECT_THROW(writer.value(1.0), InternalError) << "a member needs a key";
  EXPECT_THROW(writer.end_array(), InternalError);
  EXPECT_THROW(static_cast<void>(writer.text()), InternalError);
  writer.member("a", 1);
  EXPECT_THROW(writer.member("a", 2), InternalError) << "duplicate";
}

}  // namespace
}  // namespace spectrace
