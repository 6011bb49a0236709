// SPDX-License-Identifier: MIT
#include "server/access.h"

#include <gtest/gtest.h>

namespace embody::server {
namespace {

HttpRequest request(const std::string& host, const std::string& origin = "") {
    HttpRequest made;
    made.method = "GET";
    made.target = "/ws";
    made.host = host;
    made.origin = origin;
    return made;
}

const AccessRules loopback{true, 8420, {}};
const AccessRules open_network{false, 8420, {{"0123456789abcdef", {}}}};

HttpRequest from_site(const std::string& site, const std::string& mode, const std::string& dest) {
    HttpRequest made = request("127.0.0.1:8420");
    made.fetch_site = site;
    made.fetch_mode = mode;
    made.fetch_dest = dest;
    return made;
}

TEST(AccessOnLoopback, ForeignPagesReachNothing) {
    for (const bool is_page : {false, true}) {
        EXPECT_FALSE(check_access(loopback, request("127.0.0.1:8420", "http://evil.example"), is_page).granted);
        EXPECT_FALSE(check_access(loopback, request("127.0.0.1:8420", "null"), is_page).granted);
        // Another port of this machine is another site.
        EXPECT_FALSE(check_access(loopback, request("127.0.0.1:8420", "http://127.0.0.1:9999"), is_page).granted);
        // Pictures, scripts and frames come without Origin.
        for (const char* site : {"cross-site", "same-site"}) {
            EXPECT_FALSE(check_access(loopback, from_site(site, "no-cors", "image"), is_page).granted);
            EXPECT_FALSE(check_access(loopback, from_site(site, "no-cors", "script"), is_page).granted);
            EXPECT_FALSE(check_access(loopback, from_site(site, "navigate", "iframe"), is_page).granted);
        }
    }
    EXPECT_FALSE(check_access(loopback, from_site("cross-site", "navigate", "document"), false).granted);
}

TEST(AccessOnLoopback, WithTlsOnlyPagesThatCameByHttpsAreItsOwn) {
    const AccessRules secured{true, 8420, {}, true};
    EXPECT_TRUE(check_access(secured, request("localhost:8420", "https://localhost:8420"), false).granted);
    EXPECT_FALSE(check_access(secured, request("localhost:8420", "http://localhost:8420"), false).granted);
    EXPECT_FALSE(check_access(secured, request("evil.example", "https://evil.example"), false).granted);
}

TEST(AccessWithoutTls, IsSentToTheSamePageByHttps) {
    HttpRequest asked = request("studio.local:8420");
    asked.target = "/?scene=x&token=y";
    const HttpResponse sent = answer_without_tls(asked);
    EXPECT_EQ(sent.status, 307u);
    EXPECT_EQ(sent.headers.at("Location"), "https://studio.local:8420/?scene=x&token=y");
    asked.method = "POST";
    EXPECT_EQ(answer_without_tls(asked).status, 403u);
    EXPECT_EQ(answer_without_tls(request("")).status, 403u);
}

TEST(AccessOnLoopback, ALinkOfAnotherPageOpensTheStudio) {
    EXPECT_TRUE(check_access(loopback, from_site("cross-site", "navigate", "document"), true).granted);
    EXPECT_TRUE(check_access(loopback, from_site("none", "navigate", "document"), false).granted);
    EXPECT_TRUE(check_access(loopback, from_site("same-origin", "cors", "empty"), false).granted);
}

TEST(AccessOnLoopback, NamesThatWereReboundToThisMachineAreRefused) {
    EXPECT_FALSE(check_access(loopback, request("evil.example:8420"), false).granted);
    EXPECT_FALSE(check_access(loopback, request("127.0.0.1.evil.example"), false).granted);
}

TEST(AccessOnLoopback, OwnPagesAndScriptsAreServed) {
    EXPECT_TRUE(check_access(loopback, request("127.0.0.1:8420", "http://127.0.0.1:8420"), false).granted);
    EXPECT_TRUE(check_access(loopback, request("localhost:8420", "http://localhost:8420"), false).granted);
    EXPECT_TRUE(check_access(loopback, request("[::1]:8420", "http://[::1]:8420"), false).granted);
    EXPECT_TRUE(check_access(loopback, request("127.0.0.1:8420"), false).granted);
}

TEST(AccessFromTheNetwork, NeedsTheToken) {
    EXPECT_FALSE(check_access(open_network, request("192.0.2.1:8420"), false).granted);
    HttpRequest wrong = request("192.0.2.1:8420");
    wrong.target = "/?token=0123456789abcdee";
    EXPECT_FALSE(check_access(open_network, wrong, false).granted);
    wrong.target = "/?token=";
    EXPECT_FALSE(check_access(open_network, wrong, false).granted);
    wrong.target = "/?token=0123456789abcdef0";
    EXPECT_FALSE(check_access(open_network, wrong, false).granted);
}

TEST(AccessFromTheNetwork, TakesTheTokenFromAddressOrCookie) {
    HttpRequest by_address = request("192.0.2.1:8420");
    by_address.target = "/?token=0123456789abcdef";
    EXPECT_TRUE(check_access(open_network, by_address, false).granted);
    HttpRequest by_cookie = request("192.0.2.1:8420");
    by_cookie.cookie = "theme=dark; embody_token=0123456789abcdef";
    EXPECT_TRUE(check_access(open_network, by_cookie, false).granted);
    by_cookie.cookie = "not_embody_token=0123456789abcdef";
    EXPECT_FALSE(check_access(open_network, by_cookie, false).granted);
}

TEST(AccessFromTheNetwork, TheTokenSaysWhatIsAllowed) {
    const AccessRules rules{false, 8420, new_invitations()};
    ASSERT_EQ(rules.invitations.size(), 3u);
    const scene::Rights expected[] = {{true, true, true}, {false, true, false}, {false, false, false}};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string& token = rules.invitations[i].token;
        EXPECT_EQ(token.size(), 32u);
        HttpRequest asked = request("192.0.2.1:8420");
        asked.target = "/?token=" + token;
        const Access access = check_access(rules, asked, false);
        EXPECT_TRUE(access.granted);
        EXPECT_EQ(access.rights, expected[i]);
        EXPECT_EQ(access.token, token);
        // A browser that was here before by another address: the new one counts.
        for (const Invitation& earlier : rules.invitations) {
            asked.cookie = "embody_token=" + earlier.token;
            EXPECT_EQ(check_access(rules, asked, false).rights, expected[i]);
        }
        EXPECT_NE(token, new_invitations()[i].token);
    }
    EXPECT_EQ(check_access(loopback, request("localhost:8420"), false).rights, expected[0]);
}

}  // namespace
}  // namespace embody::server
