// SPDX-License-Identifier: MIT
#include "server/http.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace embody::server {
namespace {

TEST(HttpTarget, BrokenPercentEncodingIsNoPath) {
    EXPECT_EQ(decoded_path("/a%2"), "");
    EXPECT_EQ(decoded_path("/a%zz"), "");
    EXPECT_EQ(decoded_path("/a%00b"), "");
}

TEST(HttpTarget, PathIsDecodedWithoutQuery) {
    EXPECT_EQ(decoded_path("/a%20b?x=1"), "/a b");
    EXPECT_EQ(decoded_path("/plus+stays"), "/plus+stays");
}

TEST(HttpTarget, QueryParametersAreFoundByWholeName) {
    EXPECT_EQ(query_parameter("/import?surname=x&name=chair%20two.glb", "name"), "chair two.glb");
    EXPECT_EQ(query_parameter("/import?name=a+b", "name"), "a b");
    EXPECT_EQ(query_parameter("/import?name", "name"), "");
    EXPECT_EQ(query_parameter("/import", "name"), "");
    EXPECT_EQ(query_parameter("/import?&&name=z", "name"), "z");
}

TEST(HttpError, CarriesWhereWhyAndRemedyEvenForBrokenText) {
    const HttpResponse response = error_response(404, "bad\xFFname", "why", "remedy");
    EXPECT_EQ(response.status, 404u);
    const auto body = nlohmann::json::parse(response.body);
    EXPECT_EQ(body["error"]["why"], "why");
    EXPECT_EQ(body["error"]["remedy"], "remedy");
}

}  // namespace
}  // namespace embody::server
