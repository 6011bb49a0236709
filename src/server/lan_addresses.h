// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

struct ifaddrs;

namespace embody::server {

/// Addresses of a list of getifaddrs() at which other machines may reach this one, each once, IPv4 first: of networks
/// that are up, without loopback, link-local and multicast addresses.
std::vector<std::string> reachable_addresses(const ifaddrs* list, bool with_v6);
/// Those of this machine now.
std::vector<std::string> lan_addresses(bool with_v6);

/// This machine's name; empty where it has none.
std::string host_name();

}  // namespace embody::server
