// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/markup.h"

#include <gtest/gtest.h>

namespace exactvo::datasets::test {
namespace {

TEST(Markup, ShowsTextAsItStands) {
  EXPECT_EQ(escaped_markup("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(escaped_markup("&amp;"), "&amp;amp;");
  EXPECT_EQ(escaped_markup("Gr\xc3\xbc\xc3\x9f"
                           "e\ttab\n"),
            "Gr\xc3\xbc\xc3\x9f"
            "e\ttab\n");
}

TEST(Markup, HasNoControlCharactersButTabAndLineEnds) {
  EXPECT_EQ(escaped_markup(std::string("a\0b\x1b[0m\r", 8)), "a?b?[0m\r");
}

}  // namespace
}  // namespace exactvo::datasets::test
