// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "server/http.h"

namespace embody::server {

/// Who may talk to the server. On a loopback address: anyone on this machine, but no foreign web page (its Origin, or a
/// Host that is not ours, gives it away). On other addresses: who knows the token.
struct AccessRules {
    bool loopback_only = true;
    unsigned short port = 0;
    std::string token;  ///< never empty where loopback_only is false
};

/// Whether the request may be answered; the reason of a refusal is for the user.
struct Access {
    bool granted = false;
    std::string why;
};
/// `is_page`: the Studio itself, to which pages of other sites may link; all else is for its own page and for programs
/// that are no browser.
Access check_access(const AccessRules& rules, const HttpRequest& request, bool is_page);

/// Name of the cookie that keeps the token after the first page load.
inline constexpr const char* token_cookie = "embody_token";

}  // namespace embody::server
