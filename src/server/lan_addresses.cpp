// SPDX-License-Identifier: MIT
#include "server/lan_addresses.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace embody::server {
namespace {

bool is_reachable(const in_addr& address) {
    const std::uint32_t bits = ntohl(address.s_addr);
    const bool is_loopback = bits >> 24 == 127, is_link_local = bits >> 16 == 0xA9FE, is_multicast = bits >> 28 >= 0xE;
    return bits != 0 && !is_loopback && !is_link_local && !is_multicast;
}

bool is_reachable(const in6_addr& address) {
    return !IN6_IS_ADDR_UNSPECIFIED(&address) && !IN6_IS_ADDR_LOOPBACK(&address) && !IN6_IS_ADDR_LINKLOCAL(&address) &&
           !IN6_IS_ADDR_MULTICAST(&address) && !IN6_IS_ADDR_V4MAPPED(&address);
}

std::string text_of(int family, const void* address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    return inet_ntop(family, address, text.data(), text.size()) != nullptr ? text.data() : "";
}

}  // namespace

std::vector<std::string> reachable_addresses(const ifaddrs* list, bool with_v6) {
    std::vector<std::string> four, six;
    for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
        if (one->ifa_addr == nullptr || (one->ifa_flags & IFF_UP) == 0 || (one->ifa_flags & IFF_LOOPBACK) != 0)
            continue;
        if (one->ifa_addr->sa_family == AF_INET) {
            const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
            if (is_reachable(address->sin_addr)) four.push_back(text_of(AF_INET, &address->sin_addr));
        } else if (with_v6 && one->ifa_addr->sa_family == AF_INET6) {
            const auto* address = reinterpret_cast<const sockaddr_in6*>(one->ifa_addr);
            if (is_reachable(address->sin6_addr)) six.push_back(text_of(AF_INET6, &address->sin6_addr));
        }
    }
    four.insert(four.end(), six.begin(), six.end());
    std::vector<std::string> once;
    for (const std::string& address : four)
        if (std::find(once.begin(), once.end(), address) == once.end()) once.push_back(address);
    return once;
}

std::vector<std::string> lan_addresses(bool with_v6) {
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return {};
    std::vector<std::string> addresses = reachable_addresses(list, with_v6);
    freeifaddrs(list);
    return addresses;
}

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace embody::server
