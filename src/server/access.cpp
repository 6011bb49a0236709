// SPDX-License-Identifier: MIT
#include "server/access.h"

#include <random>
#include <string_view>

namespace embody::server {
namespace {

/// "localhost:8080" → "localhost"; "[::1]:8080" → "[::1]".
std::string_view without_port(std::string_view host) {
    const std::size_t bracket = host.rfind(']');
    const std::size_t colon = host.rfind(':');
    if (colon == std::string_view::npos || (bracket != std::string_view::npos && colon < bracket)) return host;
    return host.substr(0, colon);
}

bool names_loopback(std::string_view host) {
    const std::string_view name = without_port(host);
    return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

/// Compares in a time that does not depend on the number of equal characters.
bool equal_secrets(std::string_view a, std::string_view b) {
    unsigned difference = a.size() == b.size() ? 0 : 1;
    for (std::size_t i = 0; i < a.size(); ++i) {
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(i < b.size() ? b[i] : 0);
    }
    return difference == 0;
}

std::string random_token() {
    std::random_device device;
    std::string token;
    for (int i = 0; i < 32; ++i) token.push_back("0123456789abcdef"[device() % 16]);
    return token;
}

std::string cookie_value(std::string_view cookies, std::string_view name) {
    while (!cookies.empty()) {
        std::string_view pair = cookies.substr(0, cookies.find(';'));
        cookies.remove_prefix(pair.size() < cookies.size() ? pair.size() + 1 : pair.size());
        while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
        const std::size_t equals = pair.find('=');
        if (equals != std::string_view::npos && pair.substr(0, equals) == name)
            return std::string(pair.substr(equals + 1));
    }
    return {};
}

/// Whether a page of another site made the browser ask. Origin tells it for WebSocket upgrades, POSTs and requests of
/// scripts; Sec-Fetch-Site for pictures, too. Programs that are no browser send neither.
bool is_foreign(const AccessRules& rules, const HttpRequest& request) {
    // Without TLS of its own the server may stand behind another that has it.
    const bool is_plain_page = !rules.tls && request.origin == "http://" + request.host;
    if (!request.origin.empty() && !is_plain_page && request.origin != "https://" + request.host) return true;
    return !request.fetch_site.empty() && request.fetch_site != "same-origin" && request.fetch_site != "none";
}

/// Whether the user clicked on a link: the answer replaces the other page.
bool follows_link(const HttpRequest& request) {
    return request.origin.empty() && request.fetch_mode == "navigate" && request.fetch_dest == "document";
}

}  // namespace

Access check_access(const AccessRules& rules, const HttpRequest& request, bool is_page) {
    // A page of another site that resolves its own name to 127.0.0.1 still sends that name as Host.
    if (rules.loopback_only && !request.host.empty() && !names_loopback(request.host))
        return {false, "this server answers only to localhost and 127.0.0.1, not to \"" + request.host + "\""};
    if (is_foreign(rules, request) && !(is_page && follows_link(request))) {
        const std::string site = request.origin.empty() ? request.fetch_site : request.origin;
        return {false, "pages of another site (" + site + ") may not use this server"};
    }
    if (rules.invitations.empty()) return {true, {}};
    // The address goes before what an earlier visit left.
    for (const std::string& known :
         {query_parameter(request.target, "token"), cookie_value(request.cookie, token_cookie)})
        for (const Invitation& invitation : rules.invitations)
            if (equal_secrets(invitation.token, known)) return {true, {}, invitation.rights, invitation.token};
    return {false, "the address must end with ?token=… as printed when the server started"};
}

std::vector<Invitation> new_invitations() {
    return {{random_token(), {}}, {random_token(), {false, true, false}}, {random_token(), {false, false, false}}};
}

HttpResponse answer_without_tls(const HttpRequest& request) {
    const bool is_read = request.method == "GET" || request.method == "HEAD";
    if (!is_read || request.host.empty())
        return error_response(403, request.target, "this server answers only by https", "ask at https://…");
    // Not for ever: the next server at this address may be one without TLS.
    HttpResponse answer = error_response(307, request.target, "this server answers only by https");
    answer.headers["Location"] = "https://" + request.host + request.target;
    return answer;
}

}  // namespace embody::server
