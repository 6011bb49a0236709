// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "scene/session/rights.h"
#include "server/http.h"

namespace embody::server {

/// A secret at the end of an address, and what it allows who comes by it.
struct Invitation {
    std::string token;
    scene::Rights rights;
};

/// Who may talk to the server. On a loopback address: every program of this machine, but no page of another site,
/// recognised by its Origin or by a Host that is not ours. On other addresses: who knows a token.
struct AccessRules {
    bool loopback_only = true;
    unsigned short port = 0;
    std::vector<Invitation> invitations;  ///< never empty where loopback_only is false; the first is the host's own
    bool tls = false;                     ///< pages of this server come by https only
};

/// Whether the request may be answered; where not, the reason for the user.
struct Access {
    bool granted = false;
    std::string why;
    scene::Rights rights = {};  ///< of who came by this token
    std::string token = {};     ///< the one that it knows; empty where none is needed
};
/// `is_page`: the request is for the Studio's own page, to which pages of other sites may link; everything else is only
/// for that page and for programs that are no browser.
Access check_access(const AccessRules& rules, const HttpRequest& request, bool is_page);

/// What a server with TLS answers to plain HTTP: the way to the same page by https.
HttpResponse answer_without_tls(const HttpRequest& request);

/// Three random tokens: for everything, to look and to run, to look.
std::vector<Invitation> new_invitations();

/// Name of the cookie that keeps the token after the first page load.
inline constexpr const char* token_cookie = "embody_token";

}  // namespace embody::server
