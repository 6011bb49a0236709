// SPDX-License-Identifier: MIT
#include "server/lan_addresses.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <deque>

namespace embody::server {
namespace {

/// A list as getifaddrs() gives it.
class Interfaces {
public:
    void add(const char* address, unsigned flags = IFF_UP) {
        const bool is_six = std::string(address).find(':') != std::string::npos;
        addresses_.emplace_back();
        sockaddr_storage& storage = addresses_.back();
        storage.ss_family = is_six ? AF_INET6 : AF_INET;
        void* const bytes = is_six ? static_cast<void*>(&reinterpret_cast<sockaddr_in6&>(storage).sin6_addr)
                                   : static_cast<void*>(&reinterpret_cast<sockaddr_in&>(storage).sin_addr);
        EXPECT_EQ(inet_pton(storage.ss_family, address, bytes), 1) << address;
        link(reinterpret_cast<sockaddr*>(&storage), flags);
    }
    void add_without_address() { link(nullptr, IFF_UP); }
    [[nodiscard]] std::vector<std::string> found(bool with_v6) const {
        return reachable_addresses(entries_.empty() ? nullptr : &entries_.front(), with_v6);
    }

private:
    void link(sockaddr* address, unsigned flags) {
        entries_.push_back({});
        entries_.back().ifa_addr = address;
        entries_.back().ifa_flags = flags;
        if (entries_.size() > 1) entries_[entries_.size() - 2].ifa_next = &entries_.back();
    }
    std::deque<sockaddr_storage> addresses_;
    std::deque<ifaddrs> entries_;
};

TEST(LanAddresses, AreThoseThatOtherMachinesReach) {
    Interfaces list;
    list.add("127.0.0.1", IFF_UP | IFF_LOOPBACK);
    list.add("::1", IFF_UP | IFF_LOOPBACK);
    list.add_without_address();
    list.add("fd00::5");
    list.add("192.168.1.5");
    list.add("169.254.7.7");
    list.add("fe80::1");
    list.add("10.0.0.9", 0);
    list.add("10.1.2.3");
    list.add("192.168.1.5");
    list.add("224.0.0.1");
    list.add("::ffff:1.2.3.4");
    EXPECT_EQ(list.found(false), (std::vector<std::string>{"192.168.1.5", "10.1.2.3"}));
    EXPECT_EQ(list.found(true), (std::vector<std::string>{"192.168.1.5", "10.1.2.3", "fd00::5"}));
    EXPECT_TRUE(Interfaces().found(true).empty());
}

}  // namespace
}  // namespace embody::server
