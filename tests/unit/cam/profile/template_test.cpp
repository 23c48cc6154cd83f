// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/profile/template.h"

#include <gtest/gtest.h>

namespace {

using cam::profile::expand;
using cam::profile::TemplateValues;

const TemplateValues& values() {
    static const TemplateValues table = {
        {"bed_celsius", 60.0}, {"z_mm", 12.5}, {"title", std::string("P01")}};
    return table;
}

TEST(Template, ReplacesNamesAndLeavesTheRest) {
    EXPECT_EQ(expand("M140 S{bed_celsius} T0\n;{title}", values()).value(), "M140 S60 T0\n;P01");
    EXPECT_EQ(expand("no placeholder", values()).value(), "no placeholder");
    EXPECT_EQ(expand("{{ brace", values()).value(), "{ brace");
}

TEST(Template, ComputesWithTheUsualPrecedence) {
    EXPECT_EQ(expand("{1 + 2 * 3}", values()).value(), "7");
    EXPECT_EQ(expand("{(1+2)*3/4}", values()).value(), "2.25");
    EXPECT_EQ(expand("{ -z_mm - 0.5 }", values()).value(), "-13");
    EXPECT_EQ(expand("{min(z_mm + 20, 30)}|{max(z_mm, 1)}", values()).value(), "30|12.5");
}

TEST(Template, ReportsUnknownNamesWithTheNearest) {
    const auto result = expand("{bed_celcius}", values());
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "profile.template_name");
    EXPECT_EQ(result.error().hint, "did you mean 'bed_celsius'?");
}

TEST(Template, RefusesEverythingElse) {
    for (const char* text : {"{", "{}", "{1 +}", "{1 2}", "{(1}", "{1/0}", "{title + 1}",
                             "{system(1)}", "{min(1)}", "{1e999}", "{99999*99999}"}) {
        const auto result = expand(text, values());
        EXPECT_FALSE(result) << text;
    }
    EXPECT_FALSE(expand("{" + std::string(10000, '(') + "1}", values()));
    EXPECT_FALSE(expand("{" + std::string(10000, '-') + "1}", values()));
}

TEST(Template, FindsForbiddenWordsInCodeButNotInComments) {
    cam::profile::Dialect dialect;
    dialect.forbidden = {"M109"};
    EXPECT_FALSE(cam::profile::first_forbidden_word(
        "G1 X1 ; M109\nM104 S1 (M109 waits)\nM1090\nG1 X109", dialect));
    const auto found = cam::profile::first_forbidden_word("G28\nm0109S60\n", dialect);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->word, "M109");
    EXPECT_EQ(found->line, 2);
}

TEST(Template, KnowsWhichNamesBelongToWhichTemplate) {
    using cam::profile::Scope;
    EXPECT_FALSE(cam::profile::template_fault("M104 S{celsius}", {Scope::Heater}));
    EXPECT_TRUE(cam::profile::template_fault("M104 S{celsius}", {Scope::Program}));
    EXPECT_TRUE(cam::profile::template_fault(";{layer}", {Scope::Program}));
    EXPECT_FALSE(
        cam::profile::template_fault(";{layer} of {layer_count}", {Scope::Program, Scope::Layer}));
}

}  // namespace
