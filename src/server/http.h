// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace embody::server {

/// A request as the routes need it, free of any transport library.
struct HttpRequest {
    std::string method;                               ///< "GET", "HEAD", "POST"
    std::string target;                               ///< path and query as sent
    std::string host, origin, cookie, if_none_match;  ///< header values; empty where missing
    /// Sec-Fetch-Site, -Mode and -Dest: the page and the purpose of a browser's request; empty: the sender is no
    /// browser.
    std::string fetch_site, fetch_mode, fetch_dest;
};

struct HttpResponse {
    unsigned status = 200;
    std::string content_type = "application/json";
    std::map<std::string, std::string> headers;
    std::string body;
};

/// {"error": {"where", "why", "remedy"}} with the status.
HttpResponse error_response(unsigned status, std::string_view where, std::string_view why,
                            std::string_view remedy = {});

/// Headers of every answer: a browser runs nothing but the Studio's own files, shows the page inside no other page, and
/// passes no data on to another page.
const std::map<std::string, std::string>& protective_headers();

/// Path of a target, percent-decoded; empty where the encoding is broken or holds a NUL.
std::string decoded_path(std::string_view target);
/// Value of a query parameter, percent-decoded; empty where missing.
std::string query_parameter(std::string_view target, std::string_view name);

}  // namespace embody::server
