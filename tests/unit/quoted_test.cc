// Text of others in messages: one line, valid, short.

#include "base/quoted.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace feldspar::tests
{
namespace
{
using namespace std::string_view_literals;

TEST(Quoted, OrdinaryTextStaysAsItIs)
{
  for (const auto text :
       {""sv, "Flat joint"sv, "σ₁ – 5 °C, \U0001F600"sv, "back\\slash, 'quote', {brace} %d $x @y `z`"sv})
    {
      EXPECT_EQ(printable(text), text);
      EXPECT_EQ(excerpt(text), text);
    }
  EXPECT_EQ(in_quotes("22 MPa"), "\"22 MPa\"");
}

TEST(Quoted, ControlCharactersAndBrokenBytesAreShownEscaped)
{
  EXPECT_EQ(printable("a\nb\r\tc"sv), "a\\nb\\r\\tc");
  EXPECT_EQ(printable("\0\x1b[31m\x7f"sv), "\\x00\\x1b[31m\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "1m"sv),
            "\\xc2\\x9b1m"); // U+009B begins a terminal's command as escape [ does
  EXPECT_EQ(printable("gr\xfc"
                      "n"sv),
            "gr\\xfcn"); // Latin 1
  // Bytes that continue nothing, an overlong slash, half of a surrogate, one beyond U+10FFFF, ends cut off.
  EXPECT_EQ(printable("\x80"sv), "\\x80");
  EXPECT_EQ(printable("\xc0\xaf"sv), "\\xc0\\xaf");
  EXPECT_EQ(printable("\xe0\x80\xaf"sv), "\\xe0\\x80\\xaf");
  EXPECT_EQ(printable("\xed\xa0\x80"sv), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"sv), "\\xf4\\x90\\x80\\x80");
  for (const auto cut : {"\xc3"sv, "\xe2\x82"sv, "\xf0\x9f\x98"sv})
    EXPECT_EQ(printable(cut).size(), 4 * cut.size()) << printable(cut);
}

TEST(Quoted, LongTextIsCutAtWholeCharacters)
{
  EXPECT_EQ(excerpt("12345678", 8), "12345678");
  EXPECT_EQ(excerpt("123456789", 8), "1234567…");
  EXPECT_EQ(excerpt("σσσσσ", 5), "σσσσσ");
  EXPECT_EQ(excerpt("σσσσσσ", 5), "σσσσ…");
  // An escape is cut off whole: five characters hold one of \x1b and an ellipsis.
  EXPECT_EQ(excerpt("\x1b\x1b", 5), "\\x1b…");
  EXPECT_EQ(excerpt("ab\x1b", 5), "ab…");
  const std::string long_text(6000, '\n');
  EXPECT_EQ(in_quotes(long_text).size(), 2 + 2 * 35 + std::string("…").size());
}

TEST(Quoted, CodesThatXmlForbidsAreNoCharacters)
{
  EXPECT_EQ(printable("\xef\xbf\xbd"sv), "\xef\xbf\xbd"); // U+FFFD is one
  EXPECT_EQ(printable("\xef\xbf\xbe"sv), "\\xef\\xbf\\xbe");
  EXPECT_EQ(printable("\xef\xbf\xbf"sv), "\\xef\\xbf\\xbf");
}

TEST(PlainName, IsOneThatNeedsNoQuotingAnywhere)
{
  for (const auto name : {"a"sv, "triaxial_compression_2.5_MPa_seed_1"sv, "pressed_at_1e+02"sv, "7"sv})
    EXPECT_TRUE(is_plain_name(name)) << name;
  for (const auto name : {""sv, "."sv, ".."sv, ".hidden"sv, "-option"sv, "|pipe"sv, "a/b"sv, "a b"sv, "a\nb"sv, "a'b"sv,
                          "gr\xc3\xbcn"sv, "a\0b"sv})
    EXPECT_FALSE(is_plain_name(name)) << printable(name);
  EXPECT_TRUE(is_plain_name(std::string(235, 'a')));
  EXPECT_FALSE(is_plain_name(std::string(236, 'a')));
}
} // namespace
} // namespace feldspar::tests
